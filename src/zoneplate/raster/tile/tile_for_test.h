// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "zoneplate/math/random.h"
#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {

/// Gives every instance a constant colour, premultiplied, and its alpha.
class InstanceColors : public FragmentShader {
 public:
  explicit InstanceColors(std::vector<Linear> colors) : colors_(std::move(colors)) {}
  void shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const override {
    for (int i = 0; i < batch.count; ++i) {
      const std::uint32_t instance = batch.instance[batch.leader(static_cast<std::size_t>(i))];
      const Linear& c = colors_[instance];
      if (outputs.color) out.r[i] = c.r * c.a, out.g[i] = c.g * c.a, out.b[i] = c.b * c.a, out.a[i] = c.a;
      if (outputs.uv) out.uv[0][i] = static_cast<float>(instance), out.uv[1][i] = static_cast<float>(batch.x[i] & 255);
    }
  }
  float alpha(const FragmentBatch& batch, float* out) const override {
    for (int i = 0; i < batch.count; ++i) out[i] = colors_[batch.instance[batch.leader(static_cast<std::size_t>(i))]].a;
    return 0.5f;
  }

 private:
  std::vector<Linear> colors_;
};

/// A triangle in normalized device coordinates (y up, reversed depth), an instance of its own.
struct TestTriangle {
  std::array<float4, 3> clip;
  Linear color;
  AlphaMode mode = AlphaMode::Opaque;
};

/// A triangle that covers the whole tile at one depth.
inline TestTriangle full_tile(float depth, Linear color, AlphaMode mode = AlphaMode::Opaque) {
  return {{{{-4, -4, depth, 1}, {4, -4, depth, 1}, {0, 8, depth, 1}}}, color, mode};
}

/// Triangles of any size, depth and orientation.
inline std::vector<TestTriangle> random_triangles(std::uint32_t seed, std::size_t count, AlphaMode mode) {
  std::vector<TestTriangle> out(count);
  std::uint32_t number = 0;
  const auto random = [&] { return unit_float(hash(seed, ++number)); };
  for (TestTriangle& t : out) {
    const float x = 2 * random() - 1, y = 2 * random() - 1, size = random() < 0.4f ? 4 : 0.5f;
    for (float4& v : t.clip) v = {x + size * (2 * random() - 1), y + size * (2 * random() - 1), random(), 1};
    t.color = {random(), random(), random(), 0.1f + 0.8f * random()};
    t.mode = mode;
  }
  return out;
}

/// One tile of 64 × 64 pixels with its triangles projected and binned, and a target. Bits of the planes are those of
/// `setup`; nothing is drawn yet.
class TileScene {
 public:
  TileScene(std::vector<TestTriangle> triangles, SamplePattern samples, const RasterRules& raster_rules = {},
            const Target& planes = {})
      : triangles_(std::move(triangles)), shader(colors_of(triangles_)), rules(raster_rules), target(planes) {
    target.viewport = {tile_size, tile_size};
    target.width = target.height = tile_size;
    target.samples = std::move(samples);
    for (const TestTriangle& t : triangles_) {
      Draw draw;
      draw.clip = t.clip;
      draw.index = index_;
      draw.alpha_mode = t.mode;
      draw.instance = static_cast<std::uint32_t>(draws_.size());
      draws_.push_back(draw);
    }
    projected = project_draws(draws_, target.viewport);
    bins = bin_triangles(projected, target, rules);
    setup.emplace(projected, bins, shader, rules, target);
  }
  TileScene(const TileScene&) = delete;

 private:
  static std::vector<Linear> colors_of(const std::vector<TestTriangle>& triangles) {
    std::vector<Linear> out;
    for (const TestTriangle& t : triangles) out.push_back(t.color);
    return out;
  }
  const std::vector<TestTriangle> triangles_;
  const std::array<std::uint32_t, 3> index_ = {0, 1, 2};
  std::vector<Draw> draws_;

 public:
  InstanceColors shader;
  RasterRules rules;
  Target target;
  ProjectedDraws projected;
  Bins bins;
  std::optional<TileSetup> setup;
};

/// Begins the tile of a scene and a pass over all samples.
inline void begin_whole_pass(TileBuffers& buffers) {
  begin_tile(0, buffers.job);
  begin_pass(0, buffers.job.setup.samples(), buffers.job);
}

/// Writes a visibility by hand: every sample of a tile belongs to the triangle that `owner(sample, x, y)` gives, or to
/// none, at a depth of ½.
template <class Owner>
void fill_visibility(const TileJob& job, TileVisibility& visibility, Owner owner) {
  visibility.sample_count = job.pass.count;
  visibility.clear();
  visibility.materialize_all();
  for (int s = 0; s < job.pass.count; ++s)
    for (int y = 0; y < tile_size; ++y)
      for (int x = 0; x < tile_size; ++x) {
        const auto at = static_cast<std::size_t>(s * sample_stride + y * tile_size + x);
        visibility.id[at] = owner(s, x, y);
        visibility.depth[at] = visibility.id[at] == no_primitive ? 0.0f : 0.5f;
      }
}

/// Begins the tile with a visibility written by hand.
template <class Owner>
void begin_with_visibility(TileBuffers& buffers, Owner owner) {
  begin_whole_pass(buffers);
  fill_visibility(buffers.job, buffers.visibility, owner);
}

}  // namespace zoneplate
