// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/alpha_tested.h"

#include <algorithm>
#include <bit>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

/// `count` samples of the pass, cyclically from one that a hash of the pixel chooses, so that no sample always comes
/// first.
std::uint64_t rotated_samples(const TileJob& job, std::uint32_t pixel, int count) {
  const auto x = static_cast<std::uint32_t>(job.x) + pixel % tile_size;
  const auto y = static_cast<std::uint32_t>(job.y) + pixel / tile_size;
  const int first = static_cast<int>(hash(x, y) % static_cast<std::uint32_t>(job.pass.count));
  std::uint64_t samples = 0;
  for (int i = 0; i < count; ++i) samples |= std::uint64_t{1} << (first + i) % job.pass.count;
  return samples;
}

void copy_samples(const TileVisibility& from, VisibilityBuffer& to) {
  const std::size_t values = static_cast<std::size_t>(from.sample_count) * sample_stride;
  to.sample_count = from.sample_count;
  to.dirty = from.dirty;
  std::copy_n(from.depth, values, to.depth);
  std::copy_n(from.id, values, to.id);
  std::copy_n(from.block_min_depth, TileVisibility::blocks, to.block_min_depth);
  std::copy_n(from.block_primitive, TileVisibility::blocks, to.block_primitive);
}

}  // namespace

AlphaTester::AlphaTester(const TileSetup& setup)
    : digits_(setup.shader, setup.samples(), setup.target.alpha == AlphaTest::Sharp),
      digit_batcher_(setup.projected, digits_, setup.target) {}

void AlphaTester::rasterize(const TileJob& job, FragmentBatcher& batcher, TileVisibility& visibility) {
  const std::size_t triangles = job.triangles_of(AlphaMode::Mask).size();
  if (triangles == 0) return;
  visibility.materialize_all();
  std::size_t next = collect_layers(job, AlphaMode::Mask, 0, job.drawn, nullptr, visibility, list_);
  if (next == triangles) return draw_layers(job, batcher, visibility);
  if (!before_) before_ = std::make_unique<VisibilityBuffer>(job.setup.max_pass_samples());
  copy_samples(visibility, *before_);
  draw_layers(job, batcher, visibility);
  while (next < triangles) {
    next = collect_layers(job, AlphaMode::Mask, next, job.drawn, nullptr, *before_, list_);
    draw_layers(job, batcher, visibility);
  }
}

/// passing_samples_: of list_.fragments.
void AlphaTester::collect_passing_samples(const TileJob& job, FragmentBatcher& batcher) {
  const Target& target = job.setup.target;
  const std::vector<Fragment>& fragments = list_.fragments;
  passing_samples_.assign(fragments.size(), 0);
  if (target.is_per_sample || target.alpha == AlphaTest::Pixel || target.alpha == AlphaTest::Samples) {
    batcher.test_alpha(fragments, passes_);
    for (std::size_t i = 0; i < fragments.size(); ++i) passing_samples_[i] = passes_[i] ? job.pass.all : 0;
    return;
  }
  for (int digit = 0; digit < digits_.digits(); ++digit) {
    digits_.choose(digit);
    digit_batcher_.test_alpha(fragments, passes_);
    for (std::size_t i = 0; i < fragments.size(); ++i)
      passing_samples_[i] += static_cast<std::uint64_t>(passes_[i]) << digit;
  }
  for (std::size_t i = 0; i < fragments.size(); ++i)
    passing_samples_[i] = rotated_samples(job, fragments[i].pixel, static_cast<int>(passing_samples_[i]));
}

void AlphaTester::draw_layers(const TileJob& job, FragmentBatcher& batcher, TileVisibility& visibility) {
  const bool is_per_sample = job.setup.target.is_per_sample || job.setup.target.alpha == AlphaTest::Samples;
  collect_layer_fragments(job, is_per_sample, list_);
  collect_passing_samples(job, batcher);
  for (std::size_t i = 0; i < list_.layers.size(); ++i) {
    const Layer& layer = list_.layers[i];
    std::uint32_t d = layer.first_depth;
    for (std::uint64_t left = layer.samples; left; left &= left - 1, ++d) {
      const int s = std::countr_zero(left);
      const std::size_t at = static_cast<std::size_t>(s) * sample_stride + layer.pixel;
      const float z = list_.depths[d];
      if (!(passing_samples_[list_.fragment_at(i, s, is_per_sample)] >> s & 1)) continue;
      if (z > visibility.depth[at] || (z == visibility.depth[at] && layer.id < visibility.id[at])) {
        visibility.materialize_block(static_cast<int>(layer.pixel / (8 * tile_size) * 8 + layer.pixel % tile_size / 8));
        visibility.depth[at] = z;
        visibility.id[at] = layer.id;
      }
    }
  }
}

}  // namespace zoneplate
