// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/backdrop/backdrop.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstring>

#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

constexpr int rows_per_range = 16;
constexpr int channels = 4;

/// Row y of the smaller level, filtered along y only: four floats a pixel of the larger one.
void filter_rows(const float* from, int width, int height, int y, std::vector<float>& out) {
  const auto row = [&](int i) {
    return from + static_cast<std::size_t>(std::clamp(i, 0, height - 1)) * static_cast<std::size_t>(width) * channels;
  };
  const float *const a = row(2 * y - 1), *const b = row(2 * y), *const c = row(2 * y + 1), *const d = row(2 * y + 2);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = (a[i] + d[i]) * 0.125f + (b[i] + c[i]) * 0.375f;
}

void filter_columns(const std::vector<float>& row, int width, float* to, int count) {
  const auto pixel = [&](int i) { return row.data() + std::clamp(i, 0, width - 1) * channels; };
  for (int x = 0; x < count; ++x) {
    const float *const a = pixel(2 * x - 1), *const b = pixel(2 * x), *const c = pixel(2 * x + 1),
                       *const d = pixel(2 * x + 2);
    for (int k = 0; k < channels; ++k) to[x * channels + k] = (a[k] + d[k]) * 0.125f + (b[k] + c[k]) * 0.375f;
  }
}

}  // namespace

Backdrop::Backdrop(const LinearImage& image, const float4x4& clip_from_world) {
  std::int32_t total = 0;
  for (int w = image.width(), h = image.height(); view_.levels < BackdropView::max_levels;
       w = (w + 1) / 2, h = (h + 1) / 2) {
    view_.width[view_.levels] = w, view_.height[view_.levels] = h, view_.offset[view_.levels] = total;
    total += w * h;
    ++view_.levels;
    if (w == 1 && h == 1) break;
  }
  texels_per_image_ = total;
  for (std::size_t c = 0; c < 4; ++c) {
    const float4 column = clip_from_world.column[c];
    const float values[4] = {column.x, column.y, column.z, column.w};
    std::copy_n(values, 4, view_.clip_from_world + 4 * c);
  }
  append(image);
}

void Backdrop::add(const LinearImage& image, std::span<const std::uint32_t> instances, std::size_t instances_of_scene) {
  assert(image.width() == view_.width[0] && image.height() == view_.height[0]);
  assert(static_cast<std::int64_t>(texels_.size() / channels) + texels_per_image_ <= INT32_MAX);
  const auto first = static_cast<std::int32_t>(texels_.size() / channels);
  append(image);
  growing("instances before transmissive surfaces", [&] { first_texel_.resize(instances_of_scene, 0); });
  for (const std::uint32_t i : instances) first_texel_[i] = first;
}

void Backdrop::append(const LinearImage& image) {
  const std::size_t first = texels_.size();
  growing("image behind transmissive surfaces",
          [&] { texels_.resize(first + static_cast<std::size_t>(texels_per_image_) * channels); });
  static_assert(sizeof(Linear) == channels * sizeof(float));
  std::memcpy(texels_.data() + first, image.values().data(), image.values().size_bytes());
  for (int k = 1; k < view_.levels; ++k) {
    const auto at = [&](int level) {
      return texels_.data() + first + static_cast<std::size_t>(view_.offset[level]) * channels;
    };
    const int width = view_.width[k - 1], height = view_.height[k - 1];
    parallel_ranges(static_cast<std::size_t>(view_.height[k]), rows_per_range, [&](std::size_t begin, std::size_t end) {
      std::vector<float> row(static_cast<std::size_t>(width) * channels);
      for (std::size_t y = begin; y < end; ++y) {
        filter_rows(at(k - 1), width, height, static_cast<int>(y), row);
        filter_columns(row, width, at(k) + y * static_cast<std::size_t>(view_.width[k]) * channels, view_.width[k]);
      }
    });
  }
}

BackdropView Backdrop::view() const {
  BackdropView view = view_;
  view.texels = texels_.data();
  if (!first_texel_.empty()) view.first_texel = first_texel_.data();
  return view;
}

}  // namespace zoneplate
