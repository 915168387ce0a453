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
constexpr int rows_a_block = 16;

}  // namespace

FilterTable::FilterTable(std::span<const std::uint8_t> bytes, Form form, std::string_view name) : form_(form) {
  const auto count = static_cast<std::size_t>(form.groups) * classes, taps = static_cast<std::size_t>(form.taps()),
             bytes_a_class = 4 + taps;
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
    for (std::size_t tap = 0; tap < taps; ++tap)
      weights_.push_back(scale * static_cast<float>(static_cast<std::int8_t>(at[4 + tap])));
  }
}

TableInput::TableInput(int width, int rows)
    : luma_(width + 2 * margin, rows + 2 * margin),
      gradients_(static_cast<std::size_t>(FilterTable::window * 3 * (width + 2 * border))),
      classes_(width, rows) {
  for (Plane<float>& roots : roots_) roots = Plane<float>(width + 2 * margin, rows + 2 * margin);
}

/// Rows beyond the image are those of its border.
void TableInput::take_roots(const LinearImage& image, int y) {
  const int width = image.width(), row = y - begin_ + margin;
  float* const rows[] = {roots_[0].row(row).data(), roots_[1].row(row).data(), roots_[2].row(row).data(),
                         luma_.row(row).data()};
  float* const inner[] = {rows[0] + margin, rows[1] + margin, rows[2] + margin};
  TableKernels::of().take_roots(&image.row(std::clamp(y, 0, image.height() - 1)).data()->r, inner, rows[3] + margin,
                                static_cast<std::size_t>(width));
  for (float* const begin : rows) {
    std::fill_n(begin, margin, begin[margin]);
    std::fill_n(begin + margin + width, margin, begin[margin + width - 1]);
  }
}

void TableInput::read(const LinearImage& image, int begin, int end) {
  begin_ = begin;
  for (int y = begin - margin; y < end + margin; ++y) take_roots(image, y);
  // Five rows of gradients, of which each row of classes makes one anew.
  const std::size_t width = gradients_.size() / (FilterTable::window * 3);
  GradientRow ring[FilterTable::window];
  for (std::size_t k = 0; k < FilterTable::window; ++k) {
    float* const at = gradients_.data() + 3 * k * width;
    ring[k] = {at, at + width, at + 2 * width};
  }
  const auto make_row = [&](int y, const GradientRow& out) {
    const auto luma = [&](int of) { return luma_.row(of - begin_ + margin).data(); };
    const float* const lumas[] = {luma(y - 1), luma(y), luma(y + 1)};
    TableKernels::of().take_gradients(lumas, out, width);
  };
  for (int k = 0; k < FilterTable::window - 1; ++k) make_row(begin + k - border, ring[k + 1]);
  for (int y = begin; y < end; ++y) {
    std::rotate(ring, ring + 1, ring + FilterTable::window);
    make_row(y + border, ring[FilterTable::window - 1]);
    TableKernels::of().classify(ring, classes_.row(y - begin).data(), static_cast<std::size_t>(image.width()));
  }
}

LinearImage filtered(const LinearImage& image, const FilterTable& table, const Plane<std::uint8_t>& group,
                     LinearImage memory) {
  const auto filter = table.side() == 3 ? TableKernels::of().filter3 : TableKernels::of().filter5;
  LinearImage out = std::move(memory);
  out.fit(image.width(), image.height());
  struct Memory {
    TableInput input;
    std::vector<std::int32_t> classes;
    explicit Memory(int width) : input(width, rows_a_block), classes(static_cast<std::size_t>(width)) {}
  };
  PerThread<Memory> buffers;
  parallel_ranges(static_cast<std::size_t>(image.height()), rows_a_block, [&](std::size_t begin, std::size_t end) {
    auto& [input, classes] = buffers.local(image.width());
    input.read(image, static_cast<int>(begin), static_cast<int>(end));
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const std::int32_t* const of = input.classes(y);
      for (std::size_t x = 0; x < classes.size(); ++x) classes[x] = group.row(y)[x] * FilterTable::classes + of[x];
      TableRow row{.classes = classes.data(),
                   .weights = table.weights().data(),
                   .image = &image.row(y).data()->r,
                   .out = &out.row(y).data()->r};
      for (int c = 0; c < 3; ++c)
        for (int k = 0; k < FilterTable::window; ++k) row.roots[c][k] = input.roots(c, y + k - TableInput::border);
      filter(row, classes.size());
    }
  });
  return out;
}

TableFit::TableFit(FilterTable::Form form)
    : form_(form), sums_(static_cast<std::size_t>(form.groups) * FilterTable::classes) {}

void TableFit::add(const LinearImage& image, const Plane<std::uint8_t>& group, const LinearImage& truth) {
  const int side = form_.side, middle = side / 2, taps = form_.taps(), margin = TableInput::border;
  TableInput input(image.width(), image.height());
  input.read(image, 0, image.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      Sums& sums = sums_[static_cast<std::size_t>(group(x, y)) * FilterTable::classes +
                         static_cast<std::size_t>(input.classes(y)[x])];
      const Linear& to = truth(x, y);
      const float wanted[] = {to.r, to.g, to.b};
      for (int c = 0; c < 3; ++c) {
        const float is = input.roots(c, y)[x + margin];
        const double change = static_cast<double>(std::sqrt(std::max(wanted[c], 0.0f))) - static_cast<double>(is);
        double tap[max_taps], *next = tap;
        for (int k = 0; k < side * side; ++k)
          if (k != side * side / 2)
            *next++ = static_cast<double>(input.roots(c, y + k / side - middle)[x + k % side - middle + margin] - is);
        error_ += change * change, ++values_;
        double* square = sums.squares.data();
        for (int i = 0; i < taps; ++i) {
          for (int j = 0; j <= i; ++j) *square++ += tap[i] * tap[j];
          sums.changes[static_cast<std::size_t>(i)] += tap[i] * change;
        }
      }
    }
}

void TableFit::add(const TableFit& other, double weight) {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Sums& from = other.sums_[i];
    for (std::size_t k = 0; k < from.squares.size(); ++k) sums_[i].squares[k] += weight * from.squares[k];
    for (std::size_t k = 0; k < from.changes.size(); ++k) sums_[i].changes[k] += weight * from.changes[k];
  }
  error_ += other.error_, values_ += other.values_;
}

std::vector<std::uint8_t> TableFit::bytes() const {
  const int taps = form_.taps();
  std::vector<std::uint8_t> out(signature.begin(), signature.end());
  for (const Sums& sums : sums_) {
    // Cholesky's decomposition of the squares, to whose diagonal a part of its mean is added.
    const auto at = [](int i, int j) { return static_cast<std::size_t>(i * (i + 1) / 2 + j); };
    double trace = 0;
    for (int i = 0; i < taps; ++i) trace += sums.squares[at(i, i)];
    // As much as a hundred pixels add whose neighbours differ by a tenth.
    constexpr double few = 1;
    const double ridge = 2e-3 * trace / taps + few;
    std::array<double, max_taps*(max_taps + 1) / 2> lower{};
    std::array<double, max_taps> solved{};
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
    const std::span<const double> weights(solved.data(), static_cast<std::size_t>(taps));
    double greatest = 0;
    for (const double w : weights) greatest = std::max(greatest, std::abs(w));
    const auto scale = static_cast<float>(greatest / 127);
    const auto bits = std::bit_cast<std::uint32_t>(scale);
    for (int k = 0; k < 4; ++k) out.push_back(static_cast<std::uint8_t>(bits >> 8 * k));
    for (const double w : weights)
      out.push_back(static_cast<std::uint8_t>(
          static_cast<std::int8_t>(greatest > 0 ? std::lround(w / static_cast<double>(scale)) : 0)));
  }
  return out;
}

}  // namespace zoneplate::upscale
