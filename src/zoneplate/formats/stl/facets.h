// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Whether an STL file is ASCII. It is binary if its size agrees with the count of triangles, because many binary files
/// begin with "solid" too.
bool is_stl_text(std::span<const std::uint8_t> bytes);

/// The facets of a binary STL file, one after the other.
struct StlFacets {
  static constexpr std::size_t header_bytes = 84, facet_bytes = 50;
  static constexpr std::size_t corners_at = 12, attribute_at = 48;  ///< in a facet

  const std::uint8_t* header = nullptr;
  const std::uint8_t* first = nullptr;
  std::size_t count = 0;

  const std::uint8_t* facet(std::size_t f) const { return first + f * facet_bytes; }
  /// The bits that any attribute of the facets [begin, end) has.
  std::uint32_t attributes(std::size_t begin, std::size_t end) const;
  /// Whether facets have colours, by the bits that any attribute of the file has.
  bool are_colored(std::uint32_t any_attribute) const;
};

/// Finds the facets of a binary file; warnings about their number go to `scene`.
///
/// Errors    ErrorKind::Input: no STL file, or one that is cut off.
StlFacets find_stl_facets(std::span<const std::uint8_t> bytes, Scene& scene, const ImportBudget& budget);

/// The mesh of facets, with colours if any facet has one. `any_attribute`: the bits that any attribute of the file has,
/// if these are some of its facets.
Mesh read_stl_facets(const StlFacets& facets, ImportBudget& budget, std::optional<std::uint32_t> any_attribute = {});

}  // namespace zoneplate
