// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include "zoneplate/base/deadline.h"
#include "zoneplate/raster/tile/composite.h"

namespace zoneplate {
namespace {

constexpr Linear8 transparent_black{};

/// Whether all of the block is drawn, and each of its spans shows one opaque surface or none.
bool consists_of_spans(const TileJob& job, const OpaqueFragments& opaque, std::uint32_t block) {
  const int y = static_cast<int>(block / 8 * 8), column = static_cast<int>(block % 8);
  bool is_whole = job.is_whole_column(column) && y >= job.drawn.top && y + 8 <= job.drawn.bottom;
  for (int i = 0; i < 8; ++i) is_whole = is_whole && opaque.span_primitive[(y + i) * 8 + column] != mixed_primitives;
  return is_whole;
}

/// Sorts nearest first; false if two of the layers may change places within the block, or are pieces of one triangle.
bool sort_block(std::span<BlockLayer> layers) {
  const auto is_nearer = [](const BlockLayer& p, const BlockLayer& q) { return p.least > q.least; };
  if (std::is_sorted(layers.rbegin(), layers.rend(), is_nearer)) {
    std::reverse(layers.begin(), layers.end());  // drawn back to front, as most transparent surfaces are
  } else if (!std::is_sorted(layers.begin(), layers.end(), is_nearer)) {
    std::sort(layers.begin(), layers.end(), is_nearer);
  }
  for (std::size_t i = 1; i < layers.size(); ++i)
    if (!(layers[i - 1].least > layers[i].greatest) || layers[i - 1].id == layers[i].id) return false;
  return true;
}

/// Whether the codes of a span's display-referred colours do not depend on the layers behind.
bool is_decided(const TileJob& job, const TransparentStack8& stack, std::size_t layers_behind) {
  Linear8 front;
  std::copy_n(stack.r, Linear8::size, front.r), std::copy_n(stack.g, Linear8::size, front.g);
  std::copy_n(stack.b, Linear8::size, front.b), std::copy_n(stack.transmittance, Linear8::size, front.a);
  // Each layer is added with an error of half a unit in the last place; a mean of equal samples has one of a unit for
  // each sample.
  const int samples = job.pass.count > 1 ? job.pass.count : 0;
  const float rounding = 0x1p-24f * (static_cast<float>(layers_behind + 1) + 2 * static_cast<float>(samples));
  return job.setup.target.display_transform->is_decided(front, job.setup.shader.brightest(), rounding);
}

}  // namespace

std::uint64_t BlockCompositor::composite(const TileJob& job, const TileVisibility& visibility, FragmentBatcher& batcher,
                                         const OpaqueFragments& opaque, TileColors& colors) {
  collect(job, visibility);
  std::size_t first = 0;
  for (std::uint32_t strip = 0; strip < TileVisibility::blocks; strip += 8) {
    std::span<const BlockLayer> layers[8];
    for (std::uint32_t column = 0; column < 8; ++column) {
      const std::uint32_t block = strip + column;
      std::size_t last = first;
      while (last < layers_.size() && layers_[last].block == block) ++last;
      const std::span<BlockLayer> all(layers_.data() + first, last - first);
      first = last;
      if (all.empty()) continue;
      const bool is_other = other_blocks_ >> block & 1;
      if (!is_other && consists_of_spans(job, opaque, block) && sort_block(all)) {
        layers[column] = all;
      } else {
        other_blocks_ |= std::uint64_t{1} << block;
      }
    }
    composite_strip(job, batcher, opaque, strip, layers, colors);
  }
  return other_blocks_;
}

/// layers_, and other_blocks_: those where a triangle covers or wins only a part, or all blocks where there are more
/// layers than may be stored.
void BlockCompositor::collect(const TileJob& job, const TileVisibility& visibility) {
  const CoverageKernels& coverage = job.setup.coverage;
  float nearest[TileVisibility::blocks];
  BlockLayer found[TileVisibility::blocks];
  std::uint32_t begin[TileVisibility::blocks + 1] = {};
  coverage.compute_nearest(visibility, nearest);
  other_blocks_ = 0;
  unsorted_.clear();
  layers_.clear();
  std::size_t number = 0;
  TileTriangle triangle;
  for (const Triangle* t : job.triangles_of(AlphaMode::Blend)) {
    if (++number % deadline_stride == 0) check_deadline();
    job.make_triangle(*t, triangle);
    const int n = coverage.collect_blocks(triangle, visibility, nearest, found, other_blocks_);
    for (int i = 0; i < n; ++i) ++begin[found[i].block + 1];
    unsorted_.insert(unsorted_.end(), found, found + n);
    if (unsorted_.size() > job.setup.rules.capacity.layer_samples) {
      other_blocks_ = ~std::uint64_t{0};
      return;
    }
  }
  for (std::size_t block = 0; block < TileVisibility::blocks; ++block) begin[block + 1] += begin[block];
  layers_.resize(unsorted_.size());
  for (const BlockLayer& layer : unsorted_) layers_[begin[layer.block]++] = layer;
}

/// Composites the eight blocks of a strip, whose first one is `strip`. `layers` are those of each block, none of blocks
/// that this route does not draw. A span through which nothing more is visible is not shaded any further.
void BlockCompositor::composite_strip(const TileJob& job, FragmentBatcher& batcher, const OpaqueFragments& opaque,
                                      std::uint32_t strip, std::span<const BlockLayer> (&layers)[8],
                                      TileColors& colors) {
  const ResolveKernels& kernels = job.setup.resolve;
  const float least = job.setup.min_transmittance;
  const std::uint32_t first_span = strip * 8;
  std::size_t deepest = 0;
  for (TransparentStack8& stack : stacks_) stack.clear();
  const bool may_be_decided = job.setup.target.display8 && !job.setup.target.color &&
                              std::ranges::all_of(job.setup.weights, [](float weight) { return weight >= 0; });
  float undecided[64];  // by span: once its first pixel's transmittance is this small, its codes may be decided
  std::fill_n(undecided, 64, 0x1p13f * least);
  for (const auto& of_block : layers) deepest = std::max(deepest, of_block.size());
  std::uint8_t open[8];  // by column: a bit for each span whose stack is open
  std::fill_n(open, 8, std::uint8_t{0xff});
  FragmentSpan spans[64];
  TransparentStack8* stack_of[64];
  std::uint8_t index_of[64];  // of the stacks
  for (std::size_t layer = 0; layer < deepest; ++layer) {
    std::size_t count = 0;
    for (std::uint32_t column = 0; column < 8; ++column) {
      if (layer >= layers[column].size() || open[column] == 0) continue;
      const Fragment centre = job.fragment_at((first_span + column) * 8, layers[column][layer].id, job.pass.all);
      for (std::uint32_t left = open[column]; left; left &= left - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
        spans[count] = {centre.x, centre.y + 256 * static_cast<std::int32_t>(i), centre.id,
                        centre.pixel + i * tile_size};
        index_of[count] = static_cast<std::uint8_t>(i * 8 + column);
        stack_of[count++] = &stacks_[i * 8 + column];
      }
    }
    if (count == 0) break;
    batcher.shade_in_order(std::span(spans).first(count),
                           [&](const FragmentOutputs& color, std::size_t first, std::size_t shaded) {
                             kernels.composite_spans_under(color, static_cast<int>(shaded), least, stack_of + first);
                             for (std::size_t i = first; i < first + shaded; ++i) {
                               TransparentStack8& stack = *stack_of[i];
                               float& limit = undecided[index_of[i]];
                               if (stack.is_open && may_be_decided && !(stack.transmittance[0] > limit)) {
                                 limit = stack.transmittance[0] / 2;
                                 stack.is_open = !is_decided(job, stack, deepest - layer);
                               }
                               if (!stack.is_open)
                                 open[index_of[i] % 8] &= static_cast<std::uint8_t>(~(1u << index_of[i] / 8));
                             }
                           });
  }
  for (std::uint32_t span = 0; span < 64; ++span) {
    if (layers[span % 8].empty()) continue;
    Linear8 color =
        opaque.span_primitive[first_span + span] == no_primitive ? transparent_black : colors.base[first_span + span];
    kernels.over(stacks_[span], color);
    kernels.resolve_samples(color, job.setup.weights.data(), job.pass.count, job.setup.weight_sum,
                            colors.color[first_span + span]);
  }
}

}  // namespace zoneplate
