// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/formats/import/part_cache.h"
#include "zoneplate/formats/ply/rows.h"

namespace zoneplate {

/// The numbers of consecutive rows.
struct PlyNumbers {
  std::vector<double> values;

  std::uint64_t bytes() const { return values.size() * sizeof(double); }
};

/// The first two elements of an ASCII file whose rows are as long as its first ones: parts of their text, which are
/// parsed again whenever they are read. Several threads may use it.
class PlyTextRows {
 public:
  static constexpr std::size_t block = 256;  ///< rows in a part

  /// The number of values in a row of each of the two elements.
  struct Shape {
    std::uint64_t rows[2], values[2];
  };
  /// What the parts of a text are: the byte at which each begins, and the end of the text.
  using Layout = std::vector<std::uint64_t>;

  /// Finds the rows in the text, whose body begins at the byte `body`; nothing if it has another number of words.
  /// `done` is called with each part of the text that is not needed for the time being.
  static std::optional<Layout> lay_out(std::string_view text, std::size_t body, const Shape& shape,
                                       const ImportBudget& budget, const std::function<void(std::string_view)>& done);

  /// `file`: the name of the file. Parts are kept up to `capacity` bytes.
  PlyTextRows(std::string_view text, const Shape& shape, Layout layout, std::string file, std::uint64_t capacity);

  bool is_scattered() const { return parts_.is_scattered(); }

  /// Reads single rows, for one thread: as many doubles as a row has values.
  ///
  /// Errors    ErrorKind::Input naming the file: a word that is not a number, or a text that has changed.
  class Reader {
   public:
    explicit Reader(const PlyTextRows& rows) : rows_(rows), held_(rows.parts_) {}
    const double* row(int element, std::size_t i) {
      const std::size_t part = rows_.first_part(element) + i / block;
      return &held_[part].values[i % block * rows_.shape_.values[element]];
    }

   private:
    const PlyTextRows& rows_;
    HeldParts<PlyNumbers> held_;
  };

 private:
  std::size_t first_part(int element) const {
    return element == 0 ? 0 : static_cast<std::size_t>((shape_.rows[0] + block - 1) / block);
  }
  PlyNumbers read(std::size_t part) const;

  std::string_view text_;
  Shape shape_;
  Layout layout_;
  std::string file_;
  PartCache<PlyNumbers> parts_;
};

}  // namespace zoneplate
