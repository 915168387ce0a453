// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/output.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace zoneplate {
namespace {

/// Calls make(first, count, out) for whole spans of a line, and for the spans at its ends, of which a part is written;
/// not for the spans whose bits are set in `written`.
template <class Pixel, class Make>
void write_line(const TileJob& job, Plane<Pixel>& plane, int y, std::uint32_t written, Make make) {
  const int left = job.drawn.left, right = job.drawn.right;
  Pixel* const out = &plane(job.x + left - job.setup.target.x, job.y + y - job.setup.target.y);  // pixel `left`
  const int end = right / 8;
  for (int first = (left + 7) / 8, last = 0; first < end; first = last) {
    first += std::countr_one(written >> first);
    last = std::min(first + std::countr_zero(written >> first), end);
    if (first < last) make(first, last - first, out + (first * 8 - left));
  }
  const auto write_part = [&](int span) {
    Pixel part[8];
    make(span, 1, part);
    const int from = std::max(left, span * 8), to = std::min(right, span * 8 + 8);
    std::copy(part + (from - span * 8), part + (to - span * 8), out + (from - left));
  };
  if (left % 8 != 0) write_part(left / 8);
  if (right % 8 != 0 && (right / 8 != left / 8 || left % 8 == 0)) write_part(right / 8);
}

}  // namespace

void write_colors(const TileJob& job, const TileColors& colors) {
  const Target& target = job.setup.target;
  for (int y = job.drawn.top; y < job.drawn.bottom; ++y) {
    const Linear8* const line = &colors.color[static_cast<std::size_t>(y * 8)];
    const std::uint32_t written = colors.written_spans[static_cast<std::size_t>(y)];
    if (target.color)
      write_line<Linear>(job, *target.color, y, written, [&](int first, int count, Linear* out) {
        for (int i = 0; i < count; ++i) job.setup.resolve.store(line[first + i], out + i * 8);
      });
    if (target.display8)
      write_line<Rgba8>(job, *target.display8, y, written, [&](int first, int count, Rgba8* out) {
        target.display_transform->present({line + first, static_cast<std::size_t>(count)}, out);
      });
  }
}

void write_coverage(const TileJob& job, const std::vector<float>& coverage) {
  const auto samples = static_cast<float>(job.setup.samples());
  for (int y = job.drawn.top; y < job.drawn.bottom; ++y)
    for (int x = job.drawn.left; x < job.drawn.right; ++x) {
      const auto pixel = static_cast<std::uint32_t>(y * tile_size + x);
      (*job.setup.target.coverage)(job.target_x(pixel), job.target_y(pixel)) = coverage[pixel] / samples;
    }
}

void write_background(const TileSetup& setup, std::size_t tile) {
  const Target& target = setup.target;
  const Bins& bins = setup.bins;
  if (!target.display8) return;
  const auto columns = static_cast<std::size_t>(bins.columns);
  if (tile % columns != 0 && bins.is_empty(tile - 1)) return;
  std::size_t end = tile + 1;
  while (end % columns != 0 && bins.is_empty(end)) ++end;

  const auto pixels = [](int first, std::size_t tiles) { return (first + static_cast<int>(tiles)) * tile_size; };
  const int left = std::max(pixels(bins.first_column, tile % columns), target.x);
  const int right = std::min(pixels(bins.first_column, tile % columns + (end - tile)), target.x + target.width);
  const int y = pixels(bins.first_row, tile / columns);
  const int top = std::max(y, target.y), bottom = std::min(y + tile_size, target.y + target.height);
  const auto line = [&](int of) { return &(*target.display8)(left - target.x, of - target.y); };
  const auto count = static_cast<std::size_t>(right - left);
  std::fill_n(line(top), count, target.display_transform->background());
  for (int of = top + 1; of < bottom; ++of) std::memcpy(line(of), line(top), count * sizeof(Rgba8));
}

void store_sample(const TileJob& job, const TileVisibility& visibility, std::uint32_t pixel, int sample, Linear color) {
  const Target& target = job.setup.target;
  const int x = job.target_x(pixel), y = job.target_y(pixel);
  const auto s = static_cast<std::size_t>(job.pass.first + sample);
  const std::size_t at = static_cast<std::size_t>(sample) * sample_stride + pixel;
  if (target.sample_color) (*target.sample_color)[s](x, y) = color;
  if (target.sample_depth) (*target.sample_depth)[s](x, y) = visibility.depth[at];
  if (target.sample_triangle)
    (*target.sample_triangle)[s](x, y) =
        visibility.id[at] == no_primitive ? Target::no_id : static_cast<std::uint32_t>(visibility.id[at]);
}

void store_color(const TileJob& job, std::uint32_t pixel, std::uint64_t samples, Linear color) {
  const int x = job.target_x(pixel), y = job.target_y(pixel);
  std::vector<LinearImage>& planes = *job.setup.target.sample_color;
  for (; samples; samples &= samples - 1)
    planes[static_cast<std::size_t>(job.pass.first + std::countr_zero(samples))](x, y) = color;
}

void store_span(const TileJob& job, std::uint32_t pixel, int sample, const FragmentOutputs& color, int first) {
  Linear8 same;
  Linear8* const out = &same;
  job.setup.resolve.resolve(color, first, 1, 1, &out);
  LinearImage& plane = (*job.setup.target.sample_color)[static_cast<std::size_t>(job.pass.first + sample)];
  job.setup.resolve.store(same, &plane(job.target_x(pixel), job.target_y(pixel)));
}

}  // namespace zoneplate
