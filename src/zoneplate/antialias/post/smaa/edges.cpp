// SPDX-License-Identifier: Apache-2.0
// SMAA's first pass, edge detection: a border is an edge if its difference reaches the threshold and half of the
// greatest difference around it (local contrast adaptation). With predication a border's threshold depends on whether a
// second buffer changes across it, which is determined first and stored in the edges themselves.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "zoneplate/antialias/post/edge_rows.h"
#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/rows.h"
#include "zoneplate/antialias/post/smaa/edge_detection.h"
#include "zoneplate/antialias/post/smaa/smaa.h"

namespace zoneplate::antialias {
namespace {

/// Detects edges in depth or in the predication buffer, without adaptation.
void detect_plain_edges(const Plane<float>& values, float threshold, EdgePlane& edges) {
  for_rows(edges.height(), [&](int y) {
    for (int x = 0; x < edges.width(); ++x) {
      const float v = values(x, y);
      const bool is_left = std::abs(v - values(std::max(x - 1, 0), y)) >= threshold;
      const bool is_top = std::abs(v - values(x, std::max(y - 1, 0))) >= threshold;
      *edges.at(x, y) = static_cast<std::uint8_t>(is_left | is_top << 1);
    }
  });
}

/// The thresholds of both kinds of borders, each converted by `rounded` to the number that the kernels compare with.
template <class T, class Rounded>
PredicatedThreshold<T> predicated(const SmaaOptions& options, Rounded rounded) {
  const double plain = options.predication_scale * options.threshold;
  return {rounded(plain), rounded(plain * (1 - options.predication_strength))};
}

void detect_luma_edges(const Rgba8Image& image, const SmaaOptions& options, EdgePlane& edges) {
  const SmaaKernels& kernels = SmaaKernels::of();
  const auto width = static_cast<std::size_t>(image.width());
  const auto fill = [&, luma = RowKernels::of().luma](int y, float* row) { luma(&image.row(y)[0].r, row, width); };
  const auto rounded = [](double threshold) {
    constexpr double white = 255 * 10000;
    return static_cast<float>(std::round(threshold * white));
  };
  if (options.is_predicated) {
    const auto thresholds = predicated<float>(options, rounded);
    detect_edges<float>(edges, fill, [&](const EdgeRows<float>& rows, std::uint8_t* out) {
      kernels.predicated_luma_edges(rows, thresholds, out, width);
    });
    return;
  }
  const float threshold = rounded(options.threshold);
  detect_edges<float>(edges, fill, [&](const EdgeRows<float>& rows, std::uint8_t* out) {
    kernels.luma_edges(rows, threshold, out, width);
  });
}

void detect_color_edges(const Rgba8Image& image, const SmaaOptions& options, EdgePlane& edges) {
  const SmaaKernels& kernels = SmaaKernels::of();
  const auto width = static_cast<std::size_t>(image.width());
  const auto fill = [&](int y, std::uint32_t* row) { std::memcpy(row, image.row(y).data(), width * sizeof(Rgba8)); };
  const auto rounded = [](double threshold) { return static_cast<std::uint32_t>(std::ceil(threshold * 255)); };
  if (options.is_predicated) {
    const auto thresholds = predicated<std::uint32_t>(options, rounded);
    detect_edges<std::uint32_t>(edges, fill, [&](const EdgeRows<std::uint32_t>& rows, std::uint8_t* out) {
      kernels.predicated_color_edges(rows, thresholds, out, width);
    });
    return;
  }
  const std::uint32_t threshold = rounded(options.threshold);
  detect_edges<std::uint32_t>(edges, fill, [&](const EdgeRows<std::uint32_t>& rows, std::uint8_t* out) {
    kernels.color_edges(rows, threshold, out, width);
  });
}

}  // namespace

EdgePlane smaa_edge_detection(const Rgba8Image& image, const Plane<float>* depth, const SmaaOptions& options) {
  EdgePlane edges(image.width(), image.height(), smaa_radius(options));
  const bool is_depth = options.edges == SmaaOptions::Edges::Depth;
  assert(!(is_depth && options.is_predicated));
  if (is_depth || options.is_predicated) {
    assert(depth != nullptr && depth->width() == image.width() && depth->height() == image.height());
    const double least = is_depth ? options.threshold * 0.1 : options.predication_threshold;
    detect_plain_edges(*depth, static_cast<float>(least), edges);
  }
  if (options.edges == SmaaOptions::Edges::Luma) detect_luma_edges(image, options, edges);
  if (options.edges == SmaaOptions::Edges::Color) detect_color_edges(image, options, edges);
  edges.extend();
  return edges;
}

}  // namespace zoneplate::antialias
