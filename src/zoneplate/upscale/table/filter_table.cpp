// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/table/filter_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/upscale/table/table_rows.h"

namespace zoneplate::upscale {
namespace {

constexpr std::string_view signature = "ZPTABLE1";
constexpr std::size_t rows_a_block = 16;
constexpr int bytes_a_class = 4 + FilterTable::taps;

}  // namespace

FilterTable::FilterTable(std::span<const std::uint8_t> bytes, int groups, std::string_view name) {
  const auto count = static_cast<std::size_t>(groups) * classes;
  const auto fail = [&](std::string_view what) {
    throw Error(ErrorKind::Input, fmt::format("{}: table of filters: {}", name, what));
  };
  if (bytes.size() != signature.size() + count * bytes_a_class)
    fail(fmt::format("has {} bytes, expected {}", bytes.size(), signature.size() + count * bytes_a_class));
  if (!std::equal(signature.begin(), signature.end(), bytes.begin())) fail("does not begin with ZPTABLE1");
  const std::uint8_t* at = bytes.data() + signature.size();
  for (std::size_t k = 0; k < count; ++k, at += bytes_a_class) {
    const std::uint32_t bits =
        at[0] | std::uint32_t{at[1]} << 8 | std::uint32_t{at[2]} << 16 | std::uint32_t{at[3]} << 24;
    const float scale = std::bit_cast<float>(bits);
    if (!(scale >= 0 && scale < 1)) fail("a scale is not in [0, 1)");
    for (int tap = 0; tap < taps; ++tap)
      weights_.push_back(scale * static_cast<float>(static_cast<std::int8_t>(at[4 + tap])));
  }
}

TableInput::TableInput(const LinearImage& image)
    : roots_{Plane<float>(image.width() + 2 * margin, image.height() + 2 * border),
             Plane<float>(image.width() + 2 * margin, image.height() + 2 * border),
             Plane<float>(image.width() + 2 * margin, image.height() + 2 * border)},
      classes_(image.width(), image.height()) {
  const int width = image.width(), height = image.height(), wide = width + 2 * margin;
  const auto inside = [&](int y) { return std::clamp(y, 0, height - 1); };
  const TableKernels& kernels = TableKernels::of();
  Plane<float> luma(wide, height);
  const auto extend = [&](float* row) {
    std::fill_n(row, margin, row[margin]);
    std::fill_n(row + margin + width, margin, row[margin + width - 1]);
  };
  parallel_ranges(static_cast<std::size_t>(height + 2 * border), rows_a_block, [&](std::size_t begin, std::size_t end) {
    std::vector<float> unused(static_cast<std::size_t>(width));
    for (int y = static_cast<int>(begin) - border; y < static_cast<int>(end) - border; ++y) {
      float* rows[3];
      for (int c = 0; c < 3; ++c) rows[c] = roots_[c].row(y + border).data() + margin;
      const bool is_inside = y == inside(y);
      kernels.take_roots(&image.row(inside(y)).data()->r, rows, is_inside ? luma.row(y).data() + margin : unused.data(),
                         static_cast<std::size_t>(width));
      for (float* const row : rows) extend(row - margin);
      if (is_inside) extend(luma.row(y).data());
    }
  });
  const auto gradients = static_cast<std::size_t>(width + 2 * border);
  parallel_ranges(static_cast<std::size_t>(height), rows_a_block, [&](std::size_t begin, std::size_t end) {
    // Five rows of gradients, of which each row of classes makes one anew.
    std::vector<float> memory(FilterTable::side * 3 * gradients);
    GradientRow ring[FilterTable::side];
    for (std::size_t k = 0; k < FilterTable::side; ++k) {
      float* const at = memory.data() + 3 * k * gradients;
      ring[k] = {at, at + gradients, at + 2 * gradients};
    }
    const auto make_row = [&](int y, const GradientRow& out) {
      const float* const lumas[] = {luma.row(inside(y - 1)).data(), luma.row(inside(y)).data(),
                                    luma.row(inside(y + 1)).data()};
      kernels.take_gradients(lumas, out, gradients);
    };
    for (int k = 0; k < FilterTable::side - 1; ++k) make_row(static_cast<int>(begin) + k - border, ring[k + 1]);
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      std::rotate(ring, ring + 1, ring + FilterTable::side);
      make_row(y + border, ring[FilterTable::side - 1]);
      kernels.classify(ring, classes_.row(y).data(), static_cast<std::size_t>(width));
    }
  });
}

LinearImage filtered(const LinearImage& image, const FilterTable& table, const Plane<std::uint8_t>& group) {
  const TableInput input(image);
  LinearImage out(image.width(), image.height());
  parallel_ranges(static_cast<std::size_t>(image.height()), rows_a_block, [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> classes(static_cast<std::size_t>(image.width()));
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const std::int32_t* const of = input.classes(y);
      for (std::size_t x = 0; x < classes.size(); ++x) classes[x] = group.row(y)[x] * FilterTable::classes + of[x];
      TableRow row{.classes = classes.data(),
                   .weights = table.weights(),
                   .image = &image.row(y).data()->r,
                   .out = &out.row(y).data()->r};
      for (int c = 0; c < 3; ++c)
        for (int k = 0; k < FilterTable::side; ++k) row.roots[c][k] = input.roots(c, y + k - TableInput::border);
      TableKernels::of().filter(row, classes.size());
    }
  });
  return out;
}

TableFit::TableFit(int groups) : sums_(static_cast<std::size_t>(groups) * FilterTable::classes) {}

void TableFit::add(const LinearImage& image, const Plane<std::uint8_t>& group, const LinearImage& truth) {
  constexpr int side = FilterTable::side, middle = side / 2;
  const TableInput input(image);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      Sums& sums = sums_[static_cast<std::size_t>(group(x, y)) * FilterTable::classes +
                         static_cast<std::size_t>(input.classes(y)[x])];
      const Linear& to = truth(x, y);
      const float wanted[] = {to.r, to.g, to.b};
      for (int c = 0; c < 3; ++c) {
        const float is = input.roots(c, y)[x + middle];
        const double change = static_cast<double>(std::sqrt(std::max(wanted[c], 0.0f))) - static_cast<double>(is);
        double tap[taps], *next = tap;
        for (int k = 0; k < side * side; ++k)
          if (k != side * side / 2)
            *next++ = static_cast<double>(input.roots(c, y + k / side - middle)[x + k % side] - is);
        double* square = sums.squares.data();
        for (int i = 0; i < taps; ++i) {
          for (int j = 0; j <= i; ++j) *square++ += tap[i] * tap[j];
          sums.changes[static_cast<std::size_t>(i)] += tap[i] * change;
        }
      }
    }
}

std::vector<std::uint8_t> TableFit::bytes() const {
  std::vector<std::uint8_t> out(signature.begin(), signature.end());
  for (const Sums& sums : sums_) {
    // Cholesky's decomposition of the squares, to whose diagonal a part of its mean is added.
    const auto at = [](int i, int j) { return static_cast<std::size_t>(i * (i + 1) / 2 + j); };
    double trace = 0;
    for (int i = 0; i < taps; ++i) trace += sums.squares[at(i, i)];
    // As much as a hundred pixels add whose neighbours differ by a tenth.
    constexpr double few = 1;
    const double ridge = 2e-3 * trace / taps + few;
    std::array<double, products> lower{};
    std::array<double, taps> solved{};
    for (int i = 0; i < taps; ++i)
      for (int j = 0; j <= i; ++j) {
        double sum = sums.squares[at(i, j)] + (i == j ? ridge : 0);
        for (int k = 0; k < j; ++k) sum -= lower[at(i, k)] * lower[at(j, k)];
        lower[at(i, j)] = i == j ? std::sqrt(sum) : sum / lower[at(j, j)];
      }
    for (int i = 0; i < taps; ++i) {
      double sum = sums.changes[static_cast<std::size_t>(i)];
      for (int k = 0; k < i; ++k) sum -= lower[at(i, k)] * solved[static_cast<std::size_t>(k)];
      solved[static_cast<std::size_t>(i)] = sum / lower[at(i, i)];
    }
    for (int i = taps - 1; i >= 0; --i) {
      double sum = solved[static_cast<std::size_t>(i)];
      for (int k = i + 1; k < taps; ++k) sum -= lower[at(k, i)] * solved[static_cast<std::size_t>(k)];
      solved[static_cast<std::size_t>(i)] = sum / lower[at(i, i)];
    }
    double greatest = 0;
    for (const double w : solved) greatest = std::max(greatest, std::abs(w));
    const auto scale = static_cast<float>(greatest / 127);
    const auto bits = std::bit_cast<std::uint32_t>(scale);
    for (int k = 0; k < 4; ++k) out.push_back(static_cast<std::uint8_t>(bits >> 8 * k));
    for (const double w : solved)
      out.push_back(static_cast<std::uint8_t>(
          static_cast<std::int8_t>(greatest > 0 ? std::lround(w / static_cast<double>(scale)) : 0)));
  }
  return out;
}

}  // namespace zoneplate::upscale
