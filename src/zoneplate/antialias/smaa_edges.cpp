// SMAA's first pass: a border is an edge where its difference reaches the threshold and half of the greatest difference
// around it (local contrast adaptation).
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "zoneplate/antialias/codes.h"
#include "zoneplate/antialias/edge_rows.h"
#include "zoneplate/antialias/smaa.h"
#include "zoneplate/antialias/smaa_kernels.h"

namespace zoneplate {
namespace scalar {
namespace {

void luma_row(const std::uint8_t* rgba, float* luma, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float r = rgba[4 * i], g = rgba[4 * i + 1], b = rgba[4 * i + 2];
    luma[i] = 2126 * r + 7152 * g + 722 * b;
  }
}

template <class T>
std::uint8_t edges_of(T to_left, T to_top, T greatest, T threshold) {
  const bool is_left = to_left >= threshold && to_left + to_left >= greatest;
  const bool is_top = to_top >= threshold && to_top + to_top >= greatest;
  return static_cast<std::uint8_t>(is_left | is_top << 1);
}

void luma_edges(const EdgeRows<float>& rows, float threshold, std::uint8_t* edges, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float *above2 = rows.row[0] + i, *above = rows.row[1] + i, *here = rows.row[2] + i, *below = rows.row[3] + i;
    const float to_left = std::abs(here[0] - here[-1]), to_top = std::abs(here[0] - above[0]);
    const float greatest = std::max({to_left, to_top, std::abs(here[0] - here[1]), std::abs(here[0] - below[0]),
                                     std::abs(here[-1] - here[-2]), std::abs(above[0] - above2[0])});
    edges[i] = edges_of(to_left, to_top, greatest, threshold);
  }
}

std::uint32_t difference(std::uint32_t a, std::uint32_t b) {
  const auto channel = [&](int shift) {
    return static_cast<std::uint32_t>(
        std::abs(static_cast<int>(a >> shift & 255) - static_cast<int>(b >> shift & 255)));
  };
  return std::max({channel(0), channel(8), channel(16)});
}

// The original compares the pixel itself, not its neighbour, with the one after that.
void color_edges(const EdgeRows<std::uint32_t>& rows, std::uint32_t threshold, std::uint8_t* edges, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t* here = rows.row[2] + i;
    const auto to = [&](std::uint32_t other) { return difference(*here, other); };
    const std::uint32_t to_left = to(here[-1]), to_top = to(rows.row[1][i]);
    const std::uint32_t greatest =
        std::max({to_left, to_top, to(here[1]), to(rows.row[3][i]), to(here[-2]), to(rows.row[0][i])});
    edges[i] = edges_of(to_left, to_top, greatest, threshold);
  }
}

}  // namespace

const SmaaKernels smaa_kernels = {.luma_row = luma_row, .luma_edges = luma_edges, .color_edges = color_edges};

}  // namespace scalar

namespace antialias {
namespace {

/// Differences of depth, without adaptation.
void detect_depth_edges(const Plane<float>& depth, float threshold, EdgePlane& edges) {
  for_rows(edges.height(), [&](int y) {
    for (int x = 0; x < edges.width(); ++x) {
      const float d = depth(x, y);
      const bool is_left = std::abs(d - depth(std::max(x - 1, 0), y)) >= threshold;
      const bool is_top = std::abs(d - depth(x, std::max(y - 1, 0))) >= threshold;
      *edges.at(x, y) = static_cast<std::uint8_t>(is_left | is_top << 1);
    }
  });
}

}  // namespace

EdgePlane smaa_edges(const Rgba8Image& image, const Plane<float>* depth, const SmaaOptions& options) {
  const SmaaKernels& kernels = pick(options.isa, scalar::smaa_kernels);
  const auto width = static_cast<std::size_t>(image.width());
  EdgePlane edges(image.width(), image.height(), smaa_reach(options));
  if (options.edges == SmaaOptions::Edges::Depth) {
    assert(depth != nullptr && depth->width() == image.width() && depth->height() == image.height());
    detect_depth_edges(*depth, static_cast<float>(options.threshold * 0.1), edges);
  } else if (options.edges == SmaaOptions::Edges::Luma) {
    constexpr double white = 255 * 10000;
    const float threshold = static_cast<float>(std::round(options.threshold * white));
    detect_edges<float>(
        edges, [&](int y, float* row) { kernels.luma_row(&image.row(y)[0].r, row, width); },
        [&](const EdgeRows<float>& rows, std::uint8_t* out) { kernels.luma_edges(rows, threshold, out, width); });
  } else {
    const auto threshold = static_cast<std::uint32_t>(std::ceil(options.threshold * 255));
    detect_edges<std::uint32_t>(
        edges, [&](int y, std::uint32_t* row) { std::memcpy(row, image.row(y).data(), width * sizeof(Rgba8)); },
        [&](const EdgeRows<std::uint32_t>& rows, std::uint8_t* out) {
          kernels.color_edges(rows, threshold, out, width);
        });
  }
  edges.extend();
  return edges;
}

}  // namespace antialias
}  // namespace zoneplate
