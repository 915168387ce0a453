// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/tables.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/shade/texture/shrinking.h"

namespace zoneplate {

std::size_t texel_count(const TextureView& view) {
  const int last = view.levels - 1;
  return static_cast<std::size_t>(view.offset[last] + view.pitch(last) * (view.height[last] + 2) + 2);
}

RipmapTable make_ripmap(const TextureView& view) {
  RipmapTable table;
  RipmapView& ripmap = table.view;
  ripmap.texels = view;
  const auto halves = [](std::int32_t size, std::int32_t(&sizes)[TextureView::max_levels]) {
    std::int32_t levels = 0;
    for (; levels == 0 || sizes[levels - 1] > 1; ++levels) sizes[levels] = levels == 0 ? size : sizes[levels - 1] / 2;
    return levels;
  };
  ripmap.columns = halves(view.width[0], ripmap.width), ripmap.rows = halves(view.height[0], ripmap.height);
  std::int64_t texels = 0;
  for (std::int32_t l = 0; l < ripmap.rows; ++l)
    for (std::int32_t k = 0; k < ripmap.columns; ++k) {
      ripmap.offset[TextureView::max_levels * l + k] = static_cast<std::int32_t>(texels);
      texels += std::int64_t{RowPitch::of(ripmap.width[k])} * (ripmap.height[l] + 2);
    }
  texels += 2;
  if (texels >= std::int64_t{1} << 31) throw std::bad_alloc();
  const auto make = [&](auto TextureView::*texel_pointer) {
    using Code = std::remove_cvref_t<decltype(*(view.*texel_pointer))>;
    const Code* const source = view.*texel_pointer;
    if (source == nullptr) return;
    const std::size_t bytes = static_cast<std::size_t>(texels) * 4 * sizeof(Code);
    table.memory = GrowingMemory(bytes);
    table.memory.grow(bytes);
    auto* const codes = reinterpret_cast<Code*>(table.memory.data());
    ripmap.texels.*texel_pointer = codes;
    const auto row = [&](std::int32_t k, std::int32_t l, std::int32_t y) {
      return codes + std::ptrdiff_t{4} *
                         (ripmap.offset[TextureView::max_levels * l + k] + (y + 1) * RowPitch::of(ripmap.width[k]) + 1);
    };
    for (std::int32_t l = 0; l < ripmap.rows; ++l)
      for (std::int32_t k = 0; k < ripmap.columns; ++k) {
        const LevelSize to{ripmap.width[k], ripmap.height[l]};
        // From the level before it along u; those of column 0, from the level before it along v.
        const std::int32_t from_k = std::max(k - 1, 0), from_l = k > 0 ? l : std::max(l - 1, 0);
        const LevelSize from{ripmap.width[from_k], ripmap.height[from_l]};
        const bool is_first = k == 0 && l == 0;
        parallel_ranges(
            static_cast<std::size_t>(to.height), texel_rows_per_range, [&](std::size_t begin, std::size_t end) {
              for (auto y = static_cast<std::int32_t>(begin); y < static_cast<std::int32_t>(end); ++y) {
                Code* const out = row(k, l, y);
                if (is_first) {
                  std::copy_n(source + std::ptrdiff_t{4} * view.texel(0, 0, y), std::ptrdiff_t{4} * to.width, out);
                } else {
                  const TexelCover rows = cover(from.height, to.height, y);
                  shrink_row(
                      covered_rows<Code>(rows, [&](std::int32_t at, std::int32_t) { return row(from_k, from_l, at); }),
                      rows, from, to, out);
                }
                close_row(out, to.width);
              }
            });
        const std::ptrdiff_t pitch = std::ptrdiff_t{4} * RowPitch::of(to.width);
        std::copy_n(row(k, l, to.height - 1) - 4, pitch, row(k, l, -1) - 4);
        std::copy_n(row(k, l, 0) - 4, pitch, row(k, l, to.height) - 4);
      }
  };
  make(&TextureView::unorm8), make(&TextureView::unorm15), make(&TextureView::halves), make(&TextureView::values);
  return table;
}

SumsTable make_sums(const TextureView& view) {
  SumsTable made;
  SumsView& sums = made.view;
  const std::int32_t w = sums.width = view.width[0], h = sums.height = view.height[0];
  const std::size_t bytes = (static_cast<std::size_t>(w) + 1) * (static_cast<std::size_t>(h) + 1) * 4 * 8;
  made.memory = GrowingMemory(bytes);
  made.memory.grow(bytes);
  const auto make = [&](const auto* source, auto* table) {
    const std::ptrdiff_t pitch = std::ptrdiff_t{4} * (w + 1);
    for (std::int32_t y = 0; y < h; ++y) {
      const auto* from = source + std::ptrdiff_t{4} * view.texel(0, 0, y);
      auto* const out = table + pitch * (y + 1);
      std::remove_cvref_t<decltype(*table)> sum[4] = {};
      for (std::int32_t x = 0; x < w; ++x)
        for (int c = 0; c < 4; ++c) {
          sum[c] += term(from[std::ptrdiff_t{4} * x + c]);
          const std::ptrdiff_t at = std::ptrdiff_t{4} * (x + 1) + c;
          out[at] = out[at - pitch] + sum[c];
        }
    }
  };
  auto* const codes = reinterpret_cast<std::uint64_t*>(made.memory.data());
  auto* const values = reinterpret_cast<double*>(made.memory.data());
  if (view.unorm8 != nullptr) make(view.unorm8, codes);
  if (view.unorm15 != nullptr) make(view.unorm15, codes);
  if (view.halves != nullptr) make(view.halves, values);
  if (view.values != nullptr) make(view.values, values);
  if (view.unorm8 != nullptr || view.unorm15 != nullptr)
    sums.codes = codes;
  else
    sums.values = values;
  sums.unit = view.unorm8 != nullptr ? 1.0f / 255.0f : view.unorm15 != nullptr ? 1.0f / 32767.0f : 1.0f;
  return made;
}

NormalSpread make_normal_spread(const TextureView& view) {
  NormalSpread made;
  TextureView& normal_spread = made.view;
  struct Moments {
    double x = 0, y = 0, z = 0;                   ///< of unit normals
    double p = 0, q = 0, pp = 0, qq = 0, pq = 0;  ///< of slopes x / z and y / z, and of their products
  };
  constexpr double min_z = 1.0 / 64;  // steeper slopes count as 64
  const auto value = [&](std::int32_t x, std::int32_t y, int c) {
    const std::ptrdiff_t at = std::ptrdiff_t{4} * view.texel(0, x, y) + c;
    if (view.unorm8 != nullptr) return static_cast<double>(view.unorm8[at]) / 255;
    if (view.unorm15 != nullptr) return static_cast<double>(view.unorm15[at]) / 32767;
    return static_cast<double>(view.halves != nullptr ? term(view.halves[at]) : view.values[at]);
  };
  normal_spread = view;
  normal_spread.unorm8 = nullptr, normal_spread.unorm15 = nullptr, normal_spread.halves = nullptr;
  made.memory = GrowingMemory(texel_count(view) * 4 * sizeof(float));
  made.memory.grow(texel_count(view) * 4 * sizeof(float));
  auto* const out = reinterpret_cast<float*>(made.memory.data());
  normal_spread.values = out;

  LevelSize size{view.width[0], view.height[0]};
  std::vector<Moments> moments(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  for (std::int32_t y = 0; y < size.height; ++y)
    for (std::int32_t x = 0; x < size.width; ++x) {
      double n[3] = {2 * value(x, y, 0) - 1, 2 * value(x, y, 1) - 1, 2 * value(x, y, 2) - 1};
      const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2], unit = square > 1e-12 ? 1 / std::sqrt(square) : 0;
      for (double& v : n) v *= unit;
      const double z = std::max(n[2], min_z), p = n[0] / z, q = n[1] / z;
      moments[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)] = {
          n[0], n[1], unit > 0 ? n[2] : 1, p, q, p * p, q * q, p * q};
    }
  for (std::int32_t l = 0;; ++l) {
    for (std::int32_t y = 0; y < size.height; ++y) {
      float* const row = row_of(out, view, l, y);
      for (std::int32_t x = 0; x < size.width; ++x) {
        const Moments& m =
            moments[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)];
        const double length = l == 0 ? 1 : std::min(std::sqrt(m.x * m.x + m.y * m.y + m.z * m.z), 1.0);
        const auto moment = [&](double central) { return static_cast<float>(l == 0 ? 0 : central); };
        row[4 * x] = static_cast<float>(length), row[4 * x + 1] = moment(std::max(m.pp - m.p * m.p, 0.0));
        row[4 * x + 2] = moment(std::max(m.qq - m.q * m.q, 0.0)), row[4 * x + 3] = moment(m.pq - m.p * m.q);
      }
      close_row(row, size.width);
    }
    close_level(out, view, l);
    if (l + 1 == view.levels) return made;
    const LevelSize to{view.width[l + 1], view.height[l + 1]};
    const double total = static_cast<double>(total_weight(size.width, to.width)) *
                         static_cast<double>(total_weight(size.height, to.height));
    std::vector<Moments> next;
    next.reserve(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height));
    for (std::int32_t y = 0; y < to.height; ++y)
      for (std::int32_t x = 0; x < to.width; ++x) {
        const TexelCover rows = cover(size.height, to.height, y), columns = cover(size.width, to.width, x);
        Moments sum;
        for (std::int32_t j = 0; j < rows.count; ++j)
          for (std::int32_t i = 0; i < columns.count; ++i) {
            const double weight = static_cast<double>(rows.weight[j] * columns.weight[i]) / total;
            const Moments& m = moments[static_cast<std::size_t>(rows.first + j) * static_cast<std::size_t>(size.width) +
                                       static_cast<std::size_t>(columns.first + i)];
            sum.x += weight * m.x, sum.y += weight * m.y, sum.z += weight * m.z;
            sum.p += weight * m.p, sum.q += weight * m.q, sum.pp += weight * m.pp, sum.qq += weight * m.qq;
            sum.pq += weight * m.pq;
          }
        next.push_back(sum);
      }
    moments = std::move(next), size = to;
  }
}

}  // namespace zoneplate
