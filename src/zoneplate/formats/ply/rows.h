// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/formats/ply/header.h"

namespace zoneplate {

/// The address of a property's value in a row; for a list, the address of its items and their number.
struct PlyPlace {
  const std::uint8_t* at = nullptr;
  std::uint32_t count = 1;
};

/// The rows of one element, all of which are within the file.
///
/// If all rows have the same size, that is `stride`. Otherwise `stride` is 0, and `starts` has the offset of the first
/// row of each block.
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

/// Whether a character separates the numbers of an ASCII file.
constexpr bool is_ply_space(char c) { return static_cast<unsigned char>(c) <= ' '; }

/// A 32-bit integer that a file of this byte order stores so.
inline std::uint32_t native_word(std::uint32_t stored, PlyOrder order) {
  return order == PlyOrder::Big ? __builtin_bswap32(stored) : stored;
}

/// Reads one value; 32-bit integers are exact.
double read_ply_value(const std::uint8_t* at, PlyType type, PlyOrder order);

/// Finds the rows of the element that starts at the front of `body`.
///
/// Errors    ErrorKind::Input: rows that end after the body, an invalid list count.
PlyRows find_ply_rows(const PlyElement& element, PlyOrder order, std::span<const std::uint8_t> body,
                      ImportBudget& budget);

/// Finds the properties of one row; returns the address of the next row.
///
/// Requires  `places` has one element per property of the element.
const std::uint8_t* place_ply_row(const PlyRows& rows, const std::uint8_t* row, std::span<PlyPlace> places);

/// The properties of the first row. Those of each following row are `stride` bytes further on.
///
/// Requires  at least one row, and a stride that is not 0.
std::vector<PlyPlace> first_ply_row(const PlyRows& rows);

/// Calls `body(i, places)` for the rows [begin, end) of a block, as parallel_ranges passes them.
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

/// The address of the first of these properties in the first row, if they are adjacent native floats and all rows have
/// the same size, so that they can be copied; else null, as where there are none.
///
/// Requires  the properties are not lists.
const std::uint8_t* floats_in_a_row(const PlyRows& rows, std::span<const std::size_t> properties);

/// Converts the values of a property in the rows [begin, end) to floats and writes them to out[0], out[stride], ...
///
/// Requires  the property is not a list; the rows are one block, as parallel_ranges passes them.
void read_ply_column(const PlyRows& rows, std::size_t begin, std::size_t end, std::size_t property, float* out,
                     std::size_t stride);

/// Changes the types of all properties to double, as parse_ply_text stores their values.
void state_doubles(PlyHeader& header);

/// Parses the numbers in a part of an ASCII file's text, from the byte `begin` to `end`.
///
/// Errors    ErrorKind::Input naming `file` and the line of a word that is not a number.
std::vector<double> parse_ply_numbers(std::string_view text, std::size_t begin, std::size_t end,
                                      const std::string& file);

/// Parses the body of an ASCII file into doubles, and changes the types of the elements to double. Values of a row's
/// line that the header does not state are ignored, with a warning in the header.
///
/// Errors    ErrorKind::Input naming the line of a word that is not a number.
std::vector<double> parse_ply_text(std::string_view body, std::size_t lines_before, PlyHeader& header,
                                   ImportBudget& budget);

}  // namespace zoneplate
