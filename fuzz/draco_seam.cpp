// SPDX-License-Identifier: Apache-2.0
// Stands in for the Draco child in fuzz targets: what comes back through the pipe has the right sizes, and that is all
// that can be said of it.
#include <algorithm>

#include "zoneplate/formats/gltf/draco.h"

namespace zoneplate {
namespace {

std::vector<std::uint8_t> repeated(std::span<const std::uint8_t> bytes, std::uint64_t size, ImportBudget& budget) {
  budget.take(size);
  std::vector<std::uint8_t> out(static_cast<std::size_t>(size));
  for (std::size_t i = 0; i < out.size() && !bytes.empty(); ++i) out[i] = bytes[i % bytes.size()];
  return out;
}

}  // namespace

DracoMesh decode_draco(std::span<const std::uint8_t> packed, std::uint64_t index_count,
                       std::span<const DracoWish> wishes, const std::string&, ImportBudget& budget) {
  DracoMesh mesh{.indices = repeated(packed, index_count * 4, budget), .attributes = {}};
  for (const DracoWish& wish : wishes) {
    const std::uint64_t each = wish.component_type < 5122 ? 1 : wish.component_type < 5124 ? 2 : 4;
    mesh.attributes.push_back(repeated(packed, wish.count * wish.components * each, budget));
  }
  return mesh;
}

}  // namespace zoneplate
