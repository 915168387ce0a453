// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstring>
#include <vector>

#include "zoneplate/antialias/reference/analytic/draw.h"
#include "zoneplate/antialias/reference/converged/draw.h"
#include "zoneplate/math/random.h"

namespace zoneplate::antialias {

/// A corner of a flat triangle: pixels from the image's top-left corner, and reversed depth.
struct FlatCorner {
  double x, y;
  float z = 0.5f;
};

/// Triangles of one colour each, whose vertices are exact in images whose sides are powers of two.
class FlatTriangles : public FragmentShader {
 public:
  FlatTriangles(int width, int height) : width_(width), height_(height) {}

  void add(FlatCorner p, FlatCorner q, FlatCorner r, Linear color, AlphaMode alpha_mode = AlphaMode::Opaque) {
    auto& list = lists_[static_cast<std::size_t>(alpha_mode)];
    for (const FlatCorner c : {p, q, r})
      list.clip.push_back(
          {static_cast<float>(2 * c.x / width_ - 1), static_cast<float>(1 - 2 * c.y / height_), c.z, 1});
    list.color.push_back(color);
  }
  void add_quad(FlatCorner p, FlatCorner q, FlatCorner r, FlatCorner s, Linear color,
                AlphaMode alpha_mode = AlphaMode::Opaque) {
    add(p, q, r, color, alpha_mode);
    add(p, r, s, color, alpha_mode);
  }
  /// The same triangles of each surface in the opposite order.
  FlatTriangles reversed() const {
    FlatTriangles out(width_, height_);
    for (std::size_t s = 0; s < 3; ++s)
      for (std::size_t i = lists_[s].color.size(); i-- > 0;) {
        out.lists_[s].color.push_back(lists_[s].color[i]);
        for (std::size_t k = 0; k < 3; ++k) out.lists_[s].clip.push_back(lists_[s].clip[3 * i + k]);
      }
    return out;
  }
  /// The alpha of masked triangles as a function of the position in 1/256 pixel, the change of the first barycentric
  /// weight over the fragment's footprint, and the index among the masked triangles. The cutoff is 1/2.
  std::function<float(std::int32_t x, std::int32_t y, float dbdx, std::uint32_t number)> alpha_at;

  LinearImage analytic(const AnalyticOptions& options = {}, std::optional<Crop> crop = {},
                       Plane<float>* coverage = nullptr, Plane<float>* error = nullptr) const {
    return with_target(crop, coverage, error, [&](const CustomDraw& d) { draw_analytic(d, options); });
  }
  LinearImage converged(const ConvergedOptions& options, Plane<float>* error = nullptr,
                        std::optional<Crop> crop = {}) const {
    return with_target(crop, nullptr, error, [&](const CustomDraw& d) { draw_converged(d, options); });
  }
  LinearImage sampled(const SamplePattern& pattern) const {
    return with_target({}, nullptr, nullptr, [&](const CustomDraw& d) {
      Target target = d.target;
      target.samples = pattern;
      target.is_per_sample = true;
      rasterize(d.draws, *this, {}, target);
    });
  }
  RenderOptions render_options;
  mutable RasterCounts counts;  ///< counts of the last image that `analytic` or `converged` drew

  void shade(const FragmentBatch& batch, OutputMask, FragmentOutputs& out) const override {
    for (int i = 0; i < batch.padded(); ++i) {
      const std::size_t leader = batch.leader(static_cast<std::size_t>(i));
      const Linear c = lists_[batch.instance[leader]].color[number_of(batch, leader)];
      out.r[i] = c.r, out.g[i] = c.g, out.b[i] = c.b, out.a[i] = c.a;
    }
  }
  float alpha(const FragmentBatch& batch, float* out) const override {
    for (int i = 0; i < batch.padded(); ++i)
      out[i] = alpha_at
                   ? alpha_at(batch.x[i], batch.y[i], batch.dbdx[0][i],
                              static_cast<std::uint32_t>(number_of(batch, batch.leader(static_cast<std::size_t>(i)))))
                   : 1.0f;
    return 0.5f;
  }

 private:
  struct List {
    std::vector<float4> clip;
    std::vector<Linear> color;
  };

  /// Triangles have consecutive numbers across the lists, and three vertices each.
  std::size_t number_of(const FragmentBatch& batch, std::size_t leader) const {
    std::size_t number = batch.triangle[leader];
    for (std::size_t s = 0; s < batch.instance[leader]; ++s) number -= lists_[s].clip.size() / 3;
    return number;
  }

  template <class Use>
  LinearImage with_target(std::optional<Crop> crop, Plane<float>* coverage, Plane<float>* error, Use use) const {
    std::vector<Draw> draws;
    std::vector<std::uint32_t> index[3];
    for (std::size_t s = 0; s < 3; ++s) {
      for (std::uint32_t i = 0; i < lists_[s].clip.size(); ++i) index[s].push_back(i);
      Draw d;
      d.clip = lists_[s].clip;
      d.index = index[s];
      d.alpha_mode = static_cast<AlphaMode>(s);
      d.material = static_cast<int>(s);
      d.instance = static_cast<std::uint32_t>(s);
      if (!d.clip.empty()) draws.push_back(d);
    }
    const Crop c = crop.value_or(Crop{0, 0, width_, height_});
    LinearImage image(c.width, c.height, Linear{0, 0, 0, 0});
    Target target;
    target.viewport = {width_, height_};
    target.x = c.x, target.y = c.y, target.width = c.width, target.height = c.height;
    target.color = &image;
    if (coverage) *coverage = Plane<float>(c.width, c.height), target.coverage = coverage;
    if (error) *error = Plane<float>(c.width, c.height);
    const RasterRules rules;
    counts = {};
    RasterMemory memory;
    use(CustomDraw{draws, *this, rules, target, render_options, error, counts, memory});
    return image;
  }

  int width_, height_;
  List lists_[3];  ///< by Surface
};

/// Pseudorandom numbers in [low, high).
class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : seed_(seed) {}
  double operator()(double low, double high) { return low + (high - low) * unit_float(hash(seed_, count_++)); }

 private:
  std::uint32_t seed_, count_ = 0;
};

inline bool same_bits(const LinearImage& p, const LinearImage& q) {
  return p.values().size() == q.values().size() &&
         std::memcmp(p.values().data(), q.values().data(), p.values().size_bytes()) == 0;
}

}  // namespace zoneplate::antialias
