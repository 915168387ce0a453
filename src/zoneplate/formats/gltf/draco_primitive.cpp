// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/draco_primitive.h"

#include <cstring>

#include "zoneplate/formats/gltf/accessor.h"
#include "zoneplate/formats/gltf/draco.h"

namespace zoneplate {
namespace {

/// Converts 32-bit indices to the accessor's component size.
std::vector<std::uint8_t> narrowed(const std::vector<std::uint8_t>& wide, std::size_t size) {
  if (size == 4) return wide;
  std::vector<std::uint8_t> out(wide.size() / 4 * size);
  for (std::size_t i = 0; i < wide.size() / 4; ++i) std::memcpy(&out[i * size], &wide[4 * i], size);
  return out;
}

}  // namespace

void decode_draco_primitive(GltfFile& file, const JsonView& primitive) {
  const auto extension = primitive.extension("KHR_draco_mesh_compression");
  if (!extension) return;
  const JsonView ids = extension->object("attributes"), attributes = primitive.object("attributes");
  const std::size_t indices = primitive.index("indices", file.count("accessors"));
  if (file.has_decoded(indices)) return;

  std::vector<DracoWish> wishes;
  std::vector<std::size_t> accessors;
  for (const std::string& name : ids.keys()) {
    if (!attributes.has(name.c_str())) continue;
    const ElementShape shape = read_shape(file, attributes, name.c_str());
    wishes.push_back({static_cast<std::uint32_t>(ids.whole(name.c_str(), std::nullopt, 0xffffffffu)), shape.type,
                      static_cast<std::uint32_t>(shape.components), shape.count});
    accessors.push_back(attributes.index(name.c_str(), file.count("accessors")));
  }
  const ElementShape order = read_shape(file, primitive, "indices");
  if (order.components != 1 || order.type == 5126) primitive.fail("its indices are not whole numbers");
  const std::size_t view = extension->index("bufferView", file.count("bufferViews"));
  DracoMesh mesh = decode_draco(file.view(view), order.count, wishes, primitive.place(), file.budget());
  const std::size_t size = order.type < 5122 ? 1 : order.type < 5124 ? 2 : 4;
  file.set_decoded(indices, narrowed(mesh.indices, size));
  for (std::size_t i = 0; i < wishes.size(); ++i) file.set_decoded(accessors[i], std::move(mesh.attributes[i]));
}

}  // namespace zoneplate
