// SPDX-License-Identifier: MIT
// Draco: the lattice integers as they are, one attribute, no quantisation.
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>

#include "encoder/base/error.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/peers/peers.hpp"

namespace microtin::bench {
namespace {

using Components = std::array<int32_t, 3>;

void add_vertices(const Surface& surface, draco::PointCloud& cloud) {
  const int8_t components = surface.has_heights ? 3 : 2;
  const auto count = static_cast<uint32_t>(surface.vertices.size());
  cloud.set_num_points(count);
  draco::GeometryAttribute layout;
  layout.Init(draco::GeometryAttribute::POSITION, nullptr, static_cast<uint8_t>(components),
              draco::DT_INT32, false, components * 4, 0);
  const int id = cloud.AddAttribute(layout, true, count);
  for (uint32_t i = 0; i < count; ++i) {
    const Vertex& v = surface.vertices[i];
    const Components position{v.x, v.y, v.z};
    cloud.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), position.data());
  }
}

void add_triangles(const Surface& surface, draco::Mesh& mesh) {
  for (const auto& t : surface.triangles) {
    mesh.AddFace({{draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])}});
  }
}

Surface surface_of(const draco::PointCloud& cloud) {
  const draco::PointAttribute& attribute = *cloud.attribute(0);
  Surface surface;
  surface.has_heights = attribute.num_components() == 3;
  surface.vertices.resize(cloud.num_points());
  for (uint32_t i = 0; i < cloud.num_points(); ++i) {
    Components position{};
    attribute.GetMappedValue(draco::PointIndex(i), position.data());
    surface.vertices[i] = {static_cast<uint16_t>(position[0]), static_cast<uint16_t>(position[1]),
                           static_cast<int16_t>(position[2])};
  }
  return surface;
}

Surface surface_of(const draco::Mesh& mesh) {
  Surface surface = surface_of(static_cast<const draco::PointCloud&>(mesh));
  surface.triangles.resize(mesh.num_faces());
  for (uint32_t i = 0; i < mesh.num_faces(); ++i) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(i));
    surface.triangles[i] = {face[0].value(), face[1].value(), face[2].value()};
  }
  return surface;
}

void expect_ok(const draco::Status& status) {
  if (!status.ok()) throw Error("Draco: " + status.error_msg_string());
}

draco::Encoder make_encoder(int level, int method) {
  const int speed = 10 - level;
  draco::Encoder encoder;
  encoder.SetSpeedOptions(speed, speed);
  encoder.SetEncodingMethod(method);
  return encoder;
}

std::string name_of(const char* kind, int level) {
  return std::string("Draco ") + kind + " (level " + std::to_string(level) + ")";
}

Bytes bytes_of(const draco::EncoderBuffer& buffer) {
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

draco::DecoderBuffer buffer_of(const Bytes& bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return buffer;
}

std::unique_ptr<draco::PointCloud> decode_points(const Bytes& bytes) {
  draco::DecoderBuffer buffer = buffer_of(bytes);
  auto cloud = draco::Decoder().DecodePointCloudFromBuffer(&buffer);
  expect_ok(cloud.status());
  return std::move(cloud).value();
}

std::unique_ptr<draco::Mesh> decode_mesh(const Bytes& bytes) {
  draco::DecoderBuffer buffer = buffer_of(bytes);
  auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  expect_ok(mesh.status());
  return std::move(mesh).value();
}

}  // namespace

Codec draco_points(int level) {
  const auto encode = [level](const Surface& surface) {
    draco::PointCloud cloud;
    add_vertices(surface, cloud);
    draco::EncoderBuffer buffer;
    expect_ok(make_encoder(level, draco::POINT_CLOUD_KD_TREE_ENCODING)
                  .EncodePointCloudToBuffer(cloud, &buffer));
    return bytes_of(buffer);
  };
  return {name_of("points", level), false, encode,
          [](const Bytes& bytes) { return surface_of(*decode_points(bytes)); }, decode_points};
}

Codec draco_mesh(int level) {
  const auto encode = [level](const Surface& surface) {
    draco::Mesh mesh;
    add_vertices(surface, mesh);
    add_triangles(surface, mesh);
    draco::EncoderBuffer buffer;
    expect_ok(
        make_encoder(level, draco::MESH_EDGEBREAKER_ENCODING).EncodeMeshToBuffer(mesh, &buffer));
    return bytes_of(buffer);
  };
  return {name_of("mesh", level), true, encode,
          [](const Bytes& bytes) { return surface_of(*decode_mesh(bytes)); }, decode_mesh};
}

}  // namespace microtin::bench
