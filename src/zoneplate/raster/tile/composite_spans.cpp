// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include "zoneplate/base/deadline.h"
#include "zoneplate/raster/tile/composite.h"

namespace zoneplate {
namespace {

/// first_fragment: by pixel; past the last fragment where a pixel has none.
void index_fragments(OpaqueFragments& opaque) {
  const std::vector<Fragment>& fragments = opaque.fragments;
  opaque.first_fragment.assign(tile_pixels + 1, static_cast<std::uint32_t>(fragments.size()));
  for (std::size_t f = fragments.size(); f-- > 0;)
    opaque.first_fragment[fragments[f].pixel] = static_cast<std::uint32_t>(f);
}

}  // namespace

void SpanCompositor::composite(const TileJob& job, TileVisibility& visibility, FragmentBatcher& batcher,
                               std::uint64_t blocks, OpaqueFragments& opaque, PixelCompositor& pixels,
                               TileColors& colors) {
  if (blocks == 0) return;
  index_fragments(opaque);
  visibility.materialize_all();
  const Strip strip{job, visibility, batcher, blocks, opaque, pixels, colors};
  for (int y = 0; y < tile_size; y += 8)
    composite_strip(strip, std::max(y, job.drawn.top), std::min(y + 8, job.drawn.bottom));
}

/// The blocks of at most eight lines. A strip with more layers than may be stored is halved; if a single line has more,
/// all of its spans are slow.
void SpanCompositor::composite_strip(const Strip& strip, int top, int bottom) {
  constexpr std::size_t enough = 256;  // spans that are shaded together
  if (top >= bottom || (strip.blocks >> (top & ~7) & 0xff) == 0) return;
  if (!collect(strip, top, bottom)) {
    if (bottom - top > 1) {
      composite_strip(strip, top, (top + bottom) / 2);
      return composite_strip(strip, (top + bottom) / 2, bottom);
    }
    layers_.clear();
    for (int i = 0; i < 8; ++i) is_slow_[top * 8 + i] = strip.blocks >> ((top & ~7) + i) & 1;
  }
  spans_.clear();
  composited_.clear();
  bool has_slow = false;
  std::size_t first = 0;
  for (auto span = static_cast<std::uint32_t>(top * 8); span < static_cast<std::uint32_t>(bottom * 8); ++span) {
    std::size_t last = first;
    while (last < layers_.size() && layers_[last].row == span) ++last;
    if (!is_slow_[span] && !sort_span(first, last)) is_slow_[span] = 1;
    has_slow = has_slow || is_slow_[span];
    if (!is_slow_[span] && last > first) {
      for (; first < last; ++first) {
        const Fragment centre = strip.job.fragment_at(span * 8, layers_[first].id, strip.job.pass.all);
        spans_.push_back({centre.x, centre.y, layers_[first].id, span * 8});
      }
      composited_.push_back({span, static_cast<std::uint32_t>(spans_.size())});
      if (spans_.size() >= enough) shade_spans(strip);
    }
    first = last;
  }
  shade_spans(strip);
  if (has_slow)
    strip.pixels.for_pixels(strip.job, {0, top, tile_size, bottom}, is_slow_, strip.visibility, strip.batcher,
                            [&](const PixelLayers& layers) { composite_slow_pixel(strip, layers); });
}

/// layers_: those of triangles that cover spans of the strip wholly; is_slow_: whether a span has others too, or pixels
/// that are not drawn or show different opaque surfaces. False if there are more layers than may be stored.
bool SpanCompositor::collect(const Strip& strip, int top, int bottom) {
  const TileJob& job = strip.job;
  SpanLayer found[64];
  std::uint32_t begin[tile_pixels / 8 + 1] = {};
  layers_.clear();
  std::fill_n(is_slow_ + top * 8, (bottom - top) * 8, std::uint8_t{0});
  std::size_t number = 0;
  TileTriangle triangle;
  for (const Triangle* t : job.triangles_of(AlphaMode::Blend)) {
    if (++number % deadline_stride == 0) check_deadline();
    if (t->max_y - job.y < top || t->min_y - job.y >= bottom) continue;
    job.make_triangle(*t, triangle);
    triangle.first_y = std::max(triangle.first_y, top);
    triangle.last_y = std::min(triangle.last_y, bottom - 1);
    const int n = job.setup.coverage.collect_rows(triangle, strip.visibility, strip.blocks, found, is_slow_);
    for (int i = 0; i < n; ++i) ++begin[found[i].row + 1];
    layers_.insert(layers_.end(), found, found + n);
    if (layers_.size() > job.setup.rules.capacity.layer_samples) return false;
  }
  for (int span = top * 8; span < bottom * 8; ++span)
    if (begin[span + 1] > 0 && (strip.opaque.span_primitive[span] == mixed_primitives || !job.is_whole_column(span)))
      is_slow_[span] = 1;

  for (std::size_t span = 0; span < tile_pixels / 8; ++span) begin[span + 1] += begin[span];
  sorted_.resize(layers_.size());
  for (const SpanLayer& layer : layers_) sorted_[begin[layer.row]++] = layer;
  layers_.swap(sorted_);
  return true;
}

/// Sorts nearest first; false if two of the layers may change places within the span, or are pieces of one triangle.
bool SpanCompositor::sort_span(std::size_t first, std::size_t last) {
  const auto at = [&](std::size_t i) { return layers_.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto is_nearer = [](const SpanLayer& p, const SpanLayer& q) { return p.least > q.least; };
  if (!std::is_sorted(at(first), at(last), is_nearer)) std::sort(at(first), at(last), is_nearer);
  for (std::size_t i = first + 1; i < last; ++i)
    if (!(layers_[i - 1].least > layers_[i].greatest) || layers_[i - 1].id == layers_[i].id) return false;
  return true;
}

/// Shades spans_ and composites each span's layers.
void SpanCompositor::shade_spans(const Strip& strip) {
  const TileSetup& setup = strip.job.setup;
  TransparentStack8 stack;
  std::size_t layer = 0, first_layer = 0, number = 0;
  strip.batcher.shade_in_order(spans_, [&](const FragmentOutputs& color, std::size_t, std::size_t shaded) {
    for (int i = 0; i < static_cast<int>(shaded); ++i) {
      const CompositedSpan& done = composited_[number];
      if (layer == first_layer) stack.clear();
      setup.resolve.composite_under(color, i * FragmentBatch::group, setup.min_transmittance, stack);
      if (++layer < done.end) continue;
      Linear8 all = strip.opaque.span_primitive[done.span] == no_primitive ? Linear8{} : strip.colors.base[done.span];
      setup.resolve.over(stack, all);
      setup.resolve.resolve_samples(all, setup.weights.data(), strip.job.pass.count, setup.weight_sum,
                                    strip.colors.color[done.span]);
      first_layer = layer;
      ++number;
    }
  });
  spans_.clear();
  composited_.clear();
}

/// A pixel of a slow span: its layers over the surfaces that own its samples, and the weighted mean of these.
void SpanCompositor::composite_slow_pixel(const Strip& strip, const PixelLayers& layers) {
  if (layers.is_empty()) return;
  const TileJob& job = strip.job;
  const OpaqueFragments& opaque = strip.opaque;
  const std::uint32_t pixel = layers.pixel;
  Linear behind[TileTriangle::max_samples];
  const std::int32_t owner = opaque.span_primitive[pixel / 8];
  const bool has_fragments = owner == mixed_primitives || !job.is_whole_column(static_cast<int>(pixel / 8));
  const bool has_base = !has_fragments && owner != no_primitive;
  std::fill_n(behind, job.pass.count, has_base ? strip.colors.base[pixel / 8].get(pixel % 8) : Linear{0, 0, 0, 0});
  const std::vector<Fragment>& fragments = opaque.fragments;
  for (std::size_t f = opaque.first_fragment[pixel]; f < fragments.size() && fragments[f].pixel == pixel; ++f)
    for (std::uint64_t left = fragments[f].samples; left; left &= left - 1)
      behind[std::countr_zero(left)] = opaque.colors[f];
  strip.pixels.composite(job, layers, strip.visibility, strip.batcher, behind);
  Linear sum{0, 0, 0, 0};
  for (int s = 0; s < job.pass.count; ++s) sum = sum + behind[s] * job.setup.weights[static_cast<std::size_t>(s)];
  const float weight_sum = job.setup.weight_sum;
  strip.colors.color[pixel / 8].set(pixel % 8,
                                    {sum.r / weight_sum, sum.g / weight_sum, sum.b / weight_sum, sum.a / weight_sum});
}

}  // namespace zoneplate
