// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/draco.h"

#include <draco/compression/decode.h>

#include <cstring>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/import/import_child.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::uint64_t size_of_type(int type) { return type < 5122 ? 1 : type < 5124 ? 2 : 4; }

[[noreturn]] void fail(const std::string& place, const std::string& cause) {
  throw Error(ErrorKind::Input, place + ": the Draco mesh " + cause);
}

/// The arguments of decode_draco for one mesh.
struct Request {
  std::span<const std::uint8_t> packed;
  std::uint64_t index_count;
  std::span<const DracoWish> wishes;
  const std::string& place;
};

template <class T>
Bytes values_of(const draco::Mesh& mesh, const draco::PointAttribute& attribute, const DracoWish& wish,
                const std::string& place) {
  Bytes out(mesh.num_points() * std::size_t{wish.components} * sizeof(T));
  std::vector<T> value(wish.components);
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    const draco::AttributeValueIndex at = attribute.mapped_index(draco::PointIndex(i));
    if (at.value() >= attribute.size() ||
        !attribute.ConvertValue<T>(at, static_cast<std::int8_t>(wish.components), value.data()))
      fail(place, "has an attribute that cannot be read");
    std::memcpy(&out[i * value.size() * sizeof(T)], value.data(), value.size() * sizeof(T));
  }
  return out;
}

Bytes attribute_of(const draco::Mesh& mesh, const DracoWish& wish, const std::string& place) {
  const draco::PointAttribute* const attribute = mesh.GetAttributeByUniqueId(wish.attribute);
  if (attribute == nullptr) fail(place, "has no attribute " + std::to_string(wish.attribute));
  if (mesh.num_points() != wish.count)
    fail(place,
         "has " + std::to_string(mesh.num_points()) + " vertices, its accessors have " + std::to_string(wish.count));
  switch (wish.component_type) {
    case 5120:
      return values_of<std::int8_t>(mesh, *attribute, wish, place);
    case 5121:
      return values_of<std::uint8_t>(mesh, *attribute, wish, place);
    case 5122:
      return values_of<std::int16_t>(mesh, *attribute, wish, place);
    case 5123:
      return values_of<std::uint16_t>(mesh, *attribute, wish, place);
    case 5125:
      return values_of<std::uint32_t>(mesh, *attribute, wish, place);
    default:
      return values_of<float>(mesh, *attribute, wish, place);
  }
}

DracoMesh decode(const Request& r) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(r.packed.data()), r.packed.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) fail(r.place, std::string("cannot be decoded: ") + decoded.status().error_msg());
  const draco::Mesh& mesh = *decoded.value();
  if (std::uint64_t{mesh.num_faces()} * 3 != r.index_count)
    fail(r.place, "has " + std::to_string(mesh.num_faces()) + " faces, its accessor has " +
                      std::to_string(r.index_count) + " indices");
  DracoMesh out;
  out.indices.resize(static_cast<std::size_t>(r.index_count) * sizeof(std::uint32_t));
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
    std::memcpy(&out.indices[f * 3 * sizeof(std::uint32_t)], mesh.face(draco::FaceIndex(f)).data(),
                3 * sizeof(std::uint32_t));
  for (const DracoWish& wish : r.wishes) out.attributes.push_back(attribute_of(mesh, wish, r.place));
  return out;
}

}  // namespace

DracoMesh decode_draco(std::span<const std::uint8_t> packed, std::uint64_t index_count,
                       std::span<const DracoWish> wishes, const std::string& place, ImportBudget& budget) {
  const Request request{packed, index_count, wishes, place};
  std::vector<std::uint64_t> sizes{index_count * sizeof(std::uint32_t)};
  for (const DracoWish& wish : wishes)
    sizes.push_back(wish.count * wish.components * size_of_type(wish.component_type));
  if (is_limited_child()) {
    for (const std::uint64_t size : sizes) budget.take(size);
    return decode(request);
  }

  LimitedChild child(place, child_limits(budget), [&](ChildAnswer& answer) {
    const DracoMesh mesh = decode(request);
    answer.write(mesh.indices.data(), mesh.indices.size());
    for (const Bytes& attribute : mesh.attributes) answer.write(attribute.data(), attribute.size());
  });
  DracoMesh mesh;
  mesh.attributes.resize(wishes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    Bytes& part = i == 0 ? mesh.indices : mesh.attributes[i - 1];
    budget.take(sizes[i]);
    part.resize(static_cast<std::size_t>(sizes[i]));
    child.read(part.data(), part.size());
  }
  return mesh;
}

}  // namespace zoneplate
