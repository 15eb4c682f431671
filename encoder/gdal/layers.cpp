// SPDX-License-Identifier: MIT
// Vertices and triangles as features, tile by tile.
#include <utility>

#include "encoder/gdal/dataset.hpp"

namespace microtin::gdal {
namespace {

using encoder::Box;
using encoder::Mesh;
using encoder::Surface;
using encoder::SurfaceInfo;

// Features of all tiles, of which one is decoded at a time. Of a pack they say which tile is
// theirs, as its column and row; vertices on borders come once for each.
class Layer : public OGRLayer {
 public:
  Layer(const Surface& surface, const OGRSpatialReference& system, const char* name,
        OGRwkbGeometryType type)
      : surface_(surface), info_(surface.info()), definition_(new OGRFeatureDefn(name)) {
    SetDescription(name);
    definition_->Reference();
    definition_->SetGeomType(type);
    if (!system.IsEmpty()) {
      system_ = system.Clone();
      definition_->GetGeomFieldDefn(0)->SetSpatialRef(system_);
    }
    if (info_.is_pack) {
      for (const char* field : {"tile_column", "tile_row"}) {
        OGRFieldDefn number(field, OFTInteger);
        definition_->AddFieldDefn(&number);
      }
    }
  }
  ~Layer() override {
    definition_->Release();
    if (system_ != nullptr) system_->Release();
  }
  Layer(const Layer&) = delete;
  Layer& operator=(const Layer&) = delete;

  OGRFeatureDefn* GetLayerDefn() override { return definition_; }
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

  OGRFeature* GetNextFeature() override {
    return guarded([this] { return next_feature(); }, static_cast<OGRFeature*>(nullptr));
  }

 protected:
  virtual size_t count(const Mesh& mesh) const = 0;
  virtual std::unique_ptr<OGRGeometry> geometry(const Mesh& mesh, size_t i) const = 0;

  static OGRPoint point(const std::array<double, 3>& place) {
    return {place[0], place[1], place[2]};
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

  OGRFeature* next_feature() {
    while (go_to_feature()) {
      std::unique_ptr<OGRFeature> feature = take_feature();
      const bool fits =
          (m_poFilterGeom == nullptr || FilterGeometry(feature->GetGeometryRef()) != 0) &&
          (m_poAttrQuery == nullptr || m_poAttrQuery->Evaluate(feature.get()) != 0);
      if (fits) return feature.release();
    }
    return nullptr;
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

  std::unique_ptr<OGRFeature> take_feature() {
    auto feature = std::make_unique<OGRFeature>(definition_);
    feature->SetFID(number_ + static_cast<GIntBig>(next_));
    if (info_.is_pack) {
      feature->SetField(0, static_cast<int>(column()));
      feature->SetField(1, static_cast<int>(row()));
    }
    std::unique_ptr<OGRGeometry> shape = geometry(mesh_, next_++);
    shape->assignSpatialReference(system_);
    feature->SetGeometryDirectly(shape.release());
    return feature;
  }

  uint32_t column() const { return static_cast<uint32_t>(tile_ % info_.tile_columns); }
  uint32_t row() const { return static_cast<uint32_t>(tile_ / info_.tile_columns); }

  const Surface& surface_;
  const SurfaceInfo& info_;
  OGRFeatureDefn* definition_;
  OGRSpatialReference* system_ = nullptr;
  Mesh mesh_;  // of the tile
  uint64_t tile_ = 0;
  size_t next_ = 0;     // feature of the tile
  GIntBig number_ = 0;  // of the tile's first feature
  bool is_read_ = false;
};

class Vertices : public Layer {
 public:
  Vertices(const Surface& surface, const OGRSpatialReference& system)
      : Layer(surface, system, "vertices", wkbPoint25D), all_(surface.info().vertices) {}

  GIntBig GetFeatureCount(int force) override {
    if (m_poFilterGeom != nullptr || m_poAttrQuery != nullptr) {
      return OGRLayer::GetFeatureCount(force);
    }
    return static_cast<GIntBig>(all_);
  }

 protected:
  size_t count(const Mesh& mesh) const override { return mesh.vertices.size(); }
  std::unique_ptr<OGRGeometry> geometry(const Mesh& mesh, size_t i) const override {
    return std::make_unique<OGRPoint>(point(mesh.vertices[i]));
  }

 private:
  uint64_t all_;
};

class Triangles : public Layer {
 public:
  Triangles(const Surface& surface, const OGRSpatialReference& system)
      : Layer(surface, system, "triangles", wkbPolygon25D) {}

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

}  // namespace

std::unique_ptr<OGRLayer> vertex_layer(const Surface& surface, const OGRSpatialReference& system) {
  return std::make_unique<Vertices>(surface, system);
}

std::unique_ptr<OGRLayer> triangle_layer(const Surface& surface,
                                         const OGRSpatialReference& system) {
  return std::make_unique<Triangles>(surface, system);
}

}  // namespace microtin::gdal
