// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "zoneplate/image/rgb.h"

namespace zoneplate::upscale {

/// Filters of 3 × 3 or 5 × 5 pixels by class of pixel, found by least squares: the class is the direction, strength and
/// coherence of the gradient around, and a group that the caller chooses.
///
/// Colour    square roots of light, about as it is seen
/// Source    Romano, Isidoro and Milanfar, RAISR: Rapid and Accurate Image Super Resolution, IEEE Trans. Computational
///           Imaging 3(1), 2017: hashed gradients and filters by least squares. What differs: fewer pixels, 8
///           directions, all channels, and results within the extremes of 3 × 3 pixels in place of a blend by census.
class FilterTable {
 public:
  static constexpr int directions = 8, strengths = 4, coherences = 3;
  static constexpr int classes = directions * strengths * coherences;
  static constexpr int window = 5;  ///< the side of the pixels whose gradients make the class

  /// The groups of a table, and the side of its filters: 3 or 5.
  struct Form {
    int groups, side;

    constexpr int taps() const { return side * side - 1; }  ///< without the middle
  };

  /// Reads a table; `name` is for messages.
  ///
  /// Errors    ErrorKind::Input if it is not one of this form.
  FilterTable(std::span<const std::uint8_t> bytes, Form form, std::string_view name);

  int side() const { return form_.side; }
  /// By tap, what the difference of a pixel to the middle one counts, for group after group the classes.
  std::span<const float> weights() const { return weights_; }

 private:
  Form form_;
  std::vector<float> weights_;
};

/// Rows of an image as filters of a table read them: square roots of light, continued by two pixels beyond each side of
/// the image, and the class of each pixel.
class TableInput {
 public:
  static constexpr int border = FilterTable::window / 2;

  /// Memory for at most `rows` rows of `width` pixels.
  TableInput(int width, int rows);
  /// Reads the rows [begin, end) of an image of that width.
  void read(const LinearImage& image, int begin, int end);

  /// The class within a group of each pixel of a row.
  const std::int32_t* classes(int y) const { return classes_.row(y - begin_).data(); }
  /// A row of a channel, from two pixels before the first one on; rows from begin - 2 on.
  const float* roots(int channel, int y) const {
    return roots_[channel].row(y - begin_ + margin).data() + margin - border;
  }

 private:
  static constexpr int margin = border + 1;  ///< of what is stored, on each side

  void take_roots(const LinearImage& image, int y);

  int begin_ = 0;
  Plane<float> roots_[3], luma_;
  std::vector<float> gradients_;  ///< of five rows
  Plane<std::int32_t> classes_;
};

/// The image that a table makes; `group` is the group of each pixel. Alpha stays. It takes `memory` if that has its
/// size.
///
/// Exact     the same bits for any number of threads and any instruction set; one colour stays that colour.
LinearImage filtered(const LinearImage& image, const FilterTable& table, const Plane<std::uint8_t>& group,
                     LinearImage memory = {});

/// The least squares by which a table is made, of square roots of light. Sums are of doubles, in the order of the calls
/// and of the pixels.
///
/// Exact     the same bytes on every machine.
class TableFit {
 public:
  explicit TableFit(FilterTable::Form form);
  /// Adds the pixels of an image that is to become `truth`.
  void add(const LinearImage& image, const Plane<std::uint8_t>& group, const LinearImage& truth);
  /// Adds the images of another fit of this form, whose sums are multiplied by `weight`.
  void add(const TableFit& other, double weight);
  /// The mean square error of the images before they are filtered.
  double error() const { return error_ / static_cast<double>(values_); }
  /// The table as FilterTable reads it: per class a float32 scale and int8 weights. A class that few pixels have had
  /// changes little: the squares of its weights count too.
  std::vector<std::uint8_t> bytes() const;

 private:
  static constexpr int max_taps = FilterTable::Form{1, FilterTable::window}.taps();
  struct Sums {
    std::array<double, max_taps*(max_taps + 1) / 2> squares{};  ///< the lower triangle, by row
    std::array<double, max_taps> changes{};
  };
  FilterTable::Form form_;
  std::vector<Sums> sums_;
  double error_ = 0;  ///< the sum of `values_` squared differences, without weights
  std::int64_t values_ = 0;
};

}  // namespace zoneplate::upscale
