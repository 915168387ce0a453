// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"

namespace zoneplate {

/// A requested attribute of a Draco mesh, with glTF's component type: 5120 to 5126.
struct DracoWish {
  std::uint32_t attribute = 0;  ///< the attribute's unique id
  int component_type = 5126;
  std::uint32_t components = 3;
  std::uint64_t count = 0;
};

struct DracoMesh {
  std::vector<std::uint8_t> indices;                  ///< 32-bit, three per face
  std::vector<std::vector<std::uint8_t>> attributes;  ///< one per requested attribute, tightly packed
};

/// Decodes a Draco-compressed triangle mesh.
///
/// The library runs in a child process (import_child.h), so that a malicious file affects only the child.
/// Errors    ErrorKind::Input with `place` in front: corrupt data, other counts than requested, the limits.
DracoMesh decode_draco(std::span<const std::uint8_t> packed, std::uint64_t index_count,
                       std::span<const DracoWish> wishes, const std::string& place, ImportBudget& budget);

}  // namespace zoneplate
