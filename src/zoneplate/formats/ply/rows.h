// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/formats/ply/header.h"

namespace zoneplate {

/// Where a property stands in a row. Lists: where its items stand, and how many there are.
struct PlyPlace {
  const std::uint8_t* at = nullptr;
  std::uint32_t count = 1;
};

/// The rows of one element, all of them within the file.
///
/// Rows are either all alike (`stride` is the size of each), or each has to be walked over: then `starts` has the
/// beginning of every `block`th.
struct PlyRows {
  static constexpr std::size_t block = 4096;
  const PlyElement* element = nullptr;
  PlyOrder order = PlyOrder::Little;
  const std::uint8_t* data = nullptr;
  std::uint64_t size = 0;  ///< of all rows, in bytes
  std::uint64_t stride = 0;
  std::vector<std::uint64_t> starts;

  std::size_t count() const { return static_cast<std::size_t>(element->count); }
};

/// One value as a number; 32-bit integers are exact.
double read_ply_value(const std::uint8_t* at, PlyType type, PlyOrder order);

/// Finds the rows of the element that begin at the front of `body`.
///
/// Errors    ErrorKind::Input: rows that end after the body, a list with a negative count.
PlyRows find_ply_rows(const PlyElement& element, PlyOrder order, std::span<const std::uint8_t> body,
                      ImportBudget& budget);

/// The places of the properties in one row; answers where the next row begins.
///
/// Requires  `places` has room for every property of the element.
const std::uint8_t* place_ply_row(const PlyRows& rows, const std::uint8_t* row, std::span<PlyPlace> places);

/// The places in the first row, after which those of a row that is like it come `stride` bytes further on each.
///
/// Requires  a row, and a stride.
std::vector<PlyPlace> first_ply_row(const PlyRows& rows);

/// Calls `body(i, places)` for the rows [begin, end) of a block, as parallel_ranges gives them.
template <class Body>
void for_ply_rows(const PlyRows& rows, std::size_t begin, std::size_t end, const Body& body) {
  std::vector<PlyPlace> places(rows.element->properties.size());
  const std::uint8_t* row = rows.data + (rows.stride != 0 ? begin * rows.stride : rows.starts[begin / PlyRows::block]);
  for (std::size_t i = begin; i < end; ++i) {
    const std::uint8_t* const next = place_ply_row(rows, row, places);
    body(i, std::span<const PlyPlace>(places));
    row = next;
  }
}

/// Where the first row has these properties, if they are floats of this machine that follow each other in all rows, so
/// that they can be copied; else null.
///
/// Requires  properties that are no lists.
const std::uint8_t* floats_in_a_row(const PlyRows& rows, std::span<const std::size_t> properties);

/// The values of a property in the rows [begin, end) as floats, into out[0], out[stride], ...
///
/// Requires  a property that is no list; rows of one block, as parallel_ranges gives them.
void read_ply_column(const PlyRows& rows, std::size_t begin, std::size_t end, std::size_t property, float* out,
                     std::size_t stride);

/// The body of an ASCII file as numbers, each a double in this machine's order; the elements' types change
/// accordingly.
///
/// Errors    ErrorKind::Input naming the line of a word that is not a number.
std::vector<std::uint8_t> parse_ply_text(std::string_view body, std::size_t lines_before, PlyHeader& header,
                                         ImportBudget& budget);

}  // namespace zoneplate
