// SPDX-License-Identifier: MIT
// Vertices and triangles as features, tile by tile; marked lines as features.
#include <utility>

#include "encoder/gdal/dataset.hpp"

namespace microtin::gdal {
namespace {

using encoder::Box;
using encoder::Line;
using encoder::Mesh;
using encoder::Surface;
using encoder::SurfaceInfo;

OGRPoint point(const std::array<double, 3>& place) {
  return {place[0], place[1], place[2]};
}

// Features in the surface's coordinate system, one after the other.
class Layer : public OGRLayer {
 public:
  Layer(const OGRSpatialReference& system, const char* name, OGRwkbGeometryType type)
      : definition_(new OGRFeatureDefn(name)) {
    SetDescription(name);
    definition_->Reference();
    definition_->SetGeomType(type);
    if (!system.IsEmpty()) {
      system_ = system.Clone();
      definition_->GetGeomFieldDefn(0)->SetSpatialRef(system_);
    }
  }
  ~Layer() override {
    definition_->Release();
    if (system_ != nullptr) system_->Release();
  }
  Layer(const Layer&) = delete;
  Layer& operator=(const Layer&) = delete;

  OGRFeatureDefn* GetLayerDefn() override { return definition_; }
  OGRFeature* GetNextFeature() override {
    return guarded([this] { return next_feature(); }, static_cast<OGRFeature*>(nullptr));
  }

 protected:
  // Null behind the last one.
  virtual std::unique_ptr<OGRFeature> take_feature() = 0;

  bool has_filter() const { return m_poFilterGeom != nullptr || m_poAttrQuery != nullptr; }

  void add_field(const char* name, OGRFieldType type) {
    OGRFieldDefn field(name, type);
    definition_->AddFieldDefn(&field);
  }

  std::unique_ptr<OGRFeature> feature(GIntBig number, std::unique_ptr<OGRGeometry> shape) const {
    auto made = std::make_unique<OGRFeature>(definition_);
    made->SetFID(number);
    shape->assignSpatialReference(system_);
    made->SetGeometryDirectly(shape.release());
    return made;
  }

 private:
  OGRFeature* next_feature() {
    while (std::unique_ptr<OGRFeature> feature = take_feature()) {
      const bool fits =
          (m_poFilterGeom == nullptr || FilterGeometry(feature->GetGeometryRef()) != 0) &&
          (m_poAttrQuery == nullptr || m_poAttrQuery->Evaluate(feature.get()) != 0);
      if (fits) return feature.release();
    }
    return nullptr;
  }

  OGRFeatureDefn* definition_;
  OGRSpatialReference* system_ = nullptr;
};

// Features of all tiles, of which one is decoded at a time. Of a pack they say which tile is
// theirs, as its column and row; vertices on borders come once for each.
class MeshLayer : public Layer {
 public:
  MeshLayer(const Surface& surface, const OGRSpatialReference& system, const char* name,
            OGRwkbGeometryType type)
      : Layer(system, name, type), surface_(surface), info_(surface.info()) {
    if (!info_.is_pack) return;
    for (const char* field : {"tile_column", "tile_row"}) add_field(field, OFTInteger);
  }

  void ResetReading() override {
    tile_ = next_ = 0;
    number_ = 0;
    is_read_ = false;
  }
  int TestCapability(const char* capability) override {
    return EQUAL(capability, OLCFastGetExtent) || EQUAL(capability, OLCZGeometries) ? TRUE : FALSE;
  }

  // A pack's extent is that of its tiles, which may reach beyond the vertices.
  OGRErr GetExtent(OGREnvelope* extent, int /*force*/) override {
    *extent = envelope_of(info_.box);
    return OGRERR_NONE;
  }
  OGRErr GetExtent(int field, OGREnvelope* extent, int force) override {
    return field == 0 ? GetExtent(extent, force) : OGRERR_FAILURE;
  }

 protected:
  virtual size_t count(const Mesh& mesh) const = 0;
  virtual std::unique_ptr<OGRGeometry> geometry(const Mesh& mesh, size_t i) const = 0;

  std::unique_ptr<OGRFeature> take_feature() override {
    if (!go_to_feature()) return nullptr;
    const GIntBig fid = number_ + static_cast<GIntBig>(next_);
    std::unique_ptr<OGRFeature> taken = feature(fid, geometry(mesh_, next_++));
    if (info_.is_pack) {
      taken->SetField(0, static_cast<int>(column()));
      taken->SetField(1, static_cast<int>(row()));
    }
    return taken;
  }

 private:
  static OGREnvelope envelope_of(const Box& box) {
    OGREnvelope envelope;
    envelope.MinX = box.west;
    envelope.MinY = box.south;
    envelope.MaxX = box.east;
    envelope.MaxY = box.north;
    return envelope;
  }

  // Reads tiles up to one that has a feature left; false behind the last. A tile that cannot be
  // read ends the reading.
  bool go_to_feature() {
    const uint64_t tiles = uint64_t{info_.tile_columns} * info_.tile_rows;
    while (tile_ < tiles) {
      if (!is_read_) read_tile();
      if (next_ < count(mesh_)) return true;
      number_ += static_cast<GIntBig>(next_);
      ++tile_;
      next_ = 0;
      is_read_ = false;
    }
    return false;
  }

  void read_tile() {
    const uint32_t column = this->column(), row = this->row();
    mesh_ = {};
    is_read_ = true;
    const bool is_wanted =
        m_poFilterGeom == nullptr ||
        m_sFilterEnvelope.Intersects(envelope_of(surface_.tile_box(column, row))) != 0;
    if (!is_wanted) return;
    try {
      mesh_ = surface_.tile(column, row);
    } catch (const std::exception&) {
      tile_ = uint64_t{info_.tile_columns} * info_.tile_rows;
      throw;
    }
  }

  uint32_t column() const { return static_cast<uint32_t>(tile_ % info_.tile_columns); }
  uint32_t row() const { return static_cast<uint32_t>(tile_ / info_.tile_columns); }

  const Surface& surface_;
  const SurfaceInfo& info_;
  Mesh mesh_;  // of the tile
  uint64_t tile_ = 0;
  size_t next_ = 0;     // feature of the tile
  GIntBig number_ = 0;  // of the tile's first feature
  bool is_read_ = false;
};

class Vertices : public MeshLayer {
 public:
  Vertices(const Surface& surface, const OGRSpatialReference& system)
      : MeshLayer(surface, system, "vertices", wkbPoint25D), all_(surface.info().vertices) {}

  GIntBig GetFeatureCount(int force) override {
    return has_filter() ? OGRLayer::GetFeatureCount(force) : static_cast<GIntBig>(all_);
  }

 protected:
  size_t count(const Mesh& mesh) const override { return mesh.vertices.size(); }
  std::unique_ptr<OGRGeometry> geometry(const Mesh& mesh, size_t i) const override {
    return std::make_unique<OGRPoint>(point(mesh.vertices[i]));
  }

 private:
  uint64_t all_;
};

class Triangles : public MeshLayer {
 public:
  Triangles(const Surface& surface, const OGRSpatialReference& system)
      : MeshLayer(surface, system, "triangles", wkbPolygon25D) {}

 protected:
  size_t count(const Mesh& mesh) const override { return mesh.triangles.size(); }
  std::unique_ptr<OGRGeometry> geometry(const Mesh& mesh, size_t i) const override {
    OGRLinearRing ring;
    for (const uint32_t corner : mesh.triangles[i]) {
      const OGRPoint vertex = point(mesh.vertices[corner]);
      ring.addPoint(&vertex);
    }
    ring.closeRings();
    auto polygon = std::make_unique<OGRPolygon>();
    polygon->addRing(&ring);
    return polygon;
  }
};

class Lines : public Layer {
 public:
  Lines(std::vector<Line> lines, const OGRSpatialReference& system)
      : Layer(system, "lines", wkbLineString25D), lines_(std::move(lines)) {
    add_field("class", OFTString);
  }

  void ResetReading() override { next_ = 0; }
  int TestCapability(const char* capability) override {
    return EQUAL(capability, OLCZGeometries) ? TRUE : FALSE;
  }
  GIntBig GetFeatureCount(int force) override {
    return has_filter() ? OGRLayer::GetFeatureCount(force) : static_cast<GIntBig>(lines_.size());
  }

 protected:
  std::unique_ptr<OGRFeature> take_feature() override {
    if (next_ >= lines_.size()) return nullptr;
    const Line& line = lines_[next_];
    auto shape = std::make_unique<OGRLineString>();
    for (const auto& vertex : line.vertices) {
      const OGRPoint place = point(vertex);
      shape->addPoint(&place);
    }
    std::unique_ptr<OGRFeature> taken = feature(static_cast<GIntBig>(next_++), std::move(shape));
    taken->SetField(0, line.line_class.c_str());
    return taken;
  }

 private:
  std::vector<Line> lines_;
  size_t next_ = 0;
};

}  // namespace

std::unique_ptr<OGRLayer> vertex_layer(const Surface& surface, const OGRSpatialReference& system) {
  return std::make_unique<Vertices>(surface, system);
}

std::unique_ptr<OGRLayer> triangle_layer(const Surface& surface,
                                         const OGRSpatialReference& system) {
  return std::make_unique<Triangles>(surface, system);
}

std::unique_ptr<OGRLayer> line_layer(const Surface& surface, const OGRSpatialReference& system) {
  std::vector<Line> lines = surface.lines();
  return lines.empty() ? nullptr : std::make_unique<Lines>(std::move(lines), system);
}

}  // namespace microtin::gdal
