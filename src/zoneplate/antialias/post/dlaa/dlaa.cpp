// SPDX-License-Identifier: Apache-2.0
// DLAA: blurs every pixel slightly along the direction of smaller change; on long edges, interpolates it between its
// neighbours according to a blur of sixteen pixels along the edge.
//
// It has neither searches nor discrete decisions, so that the result changes continuously. Weakness: it softens all
// contrast, including text and texture.
//
// Source: Andreev, Anti-Aliasing from a Different Perspective, GDC 2011 (Star Wars: The Force Unleashed 2).
#include "zoneplate/antialias/post/dlaa/dlaa.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "zoneplate/antialias/post/bordered.h"
#include "zoneplate/antialias/post/dlaa/blur.h"
#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/post_process.h"
#include "zoneplate/antialias/post/result_row.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {
namespace antialias {
namespace {

using Constants = DlaaConstants;
constexpr int radius = Constants::half_blur + 1;

/// The image with its border, and the result of the first pass: four times the luma of the Laplacian, in 8 bits.
struct Source {
  Bordered<Rgba8> colors;
  Bordered<std::uint8_t> edges;

  Source(const Rgba8Image& image, const DlaaKernels& kernels)
      : colors(image.width(), image.height(), radius), edges(image.width(), image.height(), Constants::half_blur) {
    for_rows(image.height(),
             [&](int y) { std::memcpy(colors.at(0, y), image.row(y).data(), image.row(y).size_bytes()); });
    colors.extend();
    for_rows(image.height(), [&](int y) {
      kernels.edge_row(codes(y - 1), codes(y), codes(y + 1), edges.at(0, y), static_cast<std::size_t>(image.width()));
    });
    edges.extend();
  }
  const std::uint8_t* codes(int y) const { return &colors.at(0, y)->r; }
};

}  // namespace

Rgba8Image apply_dlaa(const Rgba8Image& image, Rgba8Image memory) {
  if (image.empty()) return image;
  const DlaaKernels& kernels = DlaaKernels::of();
  const Source source(image, kernels);
  Rgba8Image out = sized_like(image, std::move(memory));
  const auto width = static_cast<std::size_t>(image.width()), room = (width + 63) / 64 * 64;
  parallel_ranges(static_cast<std::size_t>(image.height()), rows_a_block, [&](std::size_t begin, std::size_t end) {
    // The sums of the edge values of eight rows above and below are updated incrementally from row to row.
    std::vector<std::int16_t> level(room), upright(room);
    std::vector<std::uint8_t> seen(room), nothing(room);
    ResultRow result(image, out);
    constexpr int half_blur = Constants::half_blur;
    const int first = static_cast<int>(begin);
    for (int y = first - half_blur; y < first + half_blur; ++y)
      kernels.slide_row(source.edges.at(0, y), nothing.data(), upright.data(), width);
    for (int y = first; y < static_cast<int>(end); ++y) {
      const std::uint8_t* before = y == first ? nothing.data() : source.edges.at(0, y - half_blur - 1);
      kernels.slide_row(source.edges.at(0, y + half_blur), before, upright.data(), width);
      kernels.sum_row(source.edges.at(0, y), level.data(), width);
      kernels.seen_row(source.codes(y - 1), source.codes(y), source.codes(y + 1), level.data(), upright.data(),
                       Constants::unseen_bend, Constants::whole / 2, seen.data(), width);
      const DlaaRows rows{source.codes(y), static_cast<std::ptrdiff_t>(sizeof(Rgba8)) * source.colors.stride(),
                          source.edges.at(0, y), level.data(), upright.data()};
      kernels.blur_row(rows, seen.data(), &result.begin(y)[0].r, width);
      result.end();
    }
  });
  return out;
}

Method dlaa() {
  return {.name = "dlaa",
          .summary = "short and long blurs along edges, without an edge search",
          .source = "Andreev 2011",
          .make = [](const Settings&) -> std::unique_ptr<Resolver> {
            return make_post_process(radius, Mixing::Encoded, [](const Rgba8Image& i) { return apply_dlaa(i); });
          },
          .is_specification_only = true};
}

}  // namespace antialias
}  // namespace zoneplate
