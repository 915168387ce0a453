// SPDX-License-Identifier: Apache-2.0
// Subpixel reconstruction antialiasing: each pixel is shaded once, at its centre. Normals and distances are rendered at
// more samples, and each sample takes a mean of the shaded colours around it, weighted by the similarity of surfaces.
//
// Geometry is rendered at n samples per pixel and at its centre, without shading: normals are interpolated from the
// vertices, without normal maps. Weaknesses: surfaces narrower than a pixel: a surface that is shaded in no pixel
// nearby gets the colour of another one; and inside a surface, colours are blurred over about a pixel.
//
// Source: Chajdas, McGuire, Luebke, Subpixel Reconstruction Antialiasing for Deferred Shading, I3D 2011: weights
// exp(-scale max(1 - N·N', depth scale |z - z'|)) of their published kernel, which leaves both scales to the scene.
// Here depths are compared relative to the nearer one, so that one scale is valid for scenes of any size; the default
// scales and the radius are ours. Blended surfaces are not in the geometry: their outlines are not antialiased.
#include "zoneplate/antialias/geometric/bilateral.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "zoneplate/antialias/geometric/color_then_data.h"
#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/math/elementary.h"

namespace zoneplate {
namespace antialias {
namespace sraa_method {
namespace {

struct Bilateral {
  BilateralScales scales;
  double radius;  ///< maximum distance in pixels from a sample to the centres that contribute
};

/// A neighbouring pixel, relative to the sample's own.
struct Offset {
  int x, y;
};

/// The pixels of the 3 × 3 neighbourhood whose centres are within the radius, row by row.
std::vector<Offset> offsets_around(SamplePosition sample, double radius) {
  std::vector<Offset> out;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const double dx = x + 0.5 - sample.x / 256.0, dy = y + 0.5 - sample.y / 256.0;
      if (dx * dx + dy * dy <= radius * radius) out.push_back({x, y});
    }
  return out;
}

/// The colours of pixels, and the geometry of samples, the first of which are the pixels' centres.
class Reconstruction {
 public:
  Reconstruction(const LinearImage& color, const std::vector<LinearImage>& geometry, const SamplePattern& pattern,
                 const Bilateral& bilateral)
      : color_(color),
        geometry_(geometry),
        scales_(bilateral.scales),
        kernels_(SraaKernels::of()),
        all_around_(offsets_around({}, 1.5)) {
    for (const SamplePosition sample : pattern) around_.push_back(offsets_around(sample, bilateral.radius));
  }

  /// Stores the means of the pixels' samples in row y, which is initially 0.
  void row(int y, std::span<Linear> out) const {
    const std::size_t width = out.size();
    std::vector<Linear> sum(width);
    std::vector<float> weight(width);
    const float share = 1 / static_cast<float>(around_.size());
    for (std::size_t s = 0; s < around_.size(); ++s) {
      std::ranges::fill(sum, Linear{0, 0, 0, 0});
      std::ranges::fill(weight, 0.0f);
      for (const Offset o : around_[s]) add(s, o, 0, color_.width(), y, sum.data(), weight.data());
      for (std::size_t x = 0; x < width; ++x)
        out[x] = out[x] + (weight[x] > min_weight ? sum[x] * (1 / weight[x]) : other_mean(s, static_cast<int>(x), y));
    }
    for (Linear& c : out) c = c * share;
  }

 private:
  static constexpr float min_weight = 1e-20f;

  /// Adds the contributions of the pixels at an offset to sample s of pixels [first, last) of row y; pixels outside the
  /// image contribute nothing.
  void add(std::size_t s, Offset o, int first, int last, int y, Linear* sum, float* weight) const {
    const int begin = std::max(first, -o.x), end = std::min(last, color_.width() - o.x);
    if (y + o.y < 0 || y + o.y >= color_.height() || begin >= end) return;
    const int i = begin + o.x, j = y + o.y;
    kernels_.add(&geometry_[s + 1](begin, y).r, &geometry_[0](i, j).r, &color_(i, j).r, scales_, &sum[begin - first].r,
                 weight + (begin - first), static_cast<std::size_t>(end - begin));
  }

  /// A sample that is dissimilar to all centres within the radius is compared with all 3 × 3 pixels around it; if it is
  /// dissimilar to all of those, it takes its own pixel's colour.
  Linear other_mean(std::size_t s, int x, int y) const {
    Linear sum{0, 0, 0, 0};
    float weight = 0;
    for (const Offset o : all_around_) add(s, o, x, x + 1, y, &sum, &weight);
    return weight > min_weight ? sum * (1 / weight) : color_(x, y);
  }

  const LinearImage& color_;
  const std::vector<LinearImage>& geometry_;
  BilateralScales scales_;
  const SraaKernels& kernels_;
  std::vector<Offset> all_around_;
  std::vector<std::vector<Offset>> around_;  ///< by sample of the pattern
};

class Sraa : public ColorThenData {
 public:
  Sraa(int samples, Bilateral bilateral) : pattern_(standard_pattern(samples)), bilateral_(bilateral) {}

 private:
  Request data_request() const override {
    Request request;
    request.content = Content::Geometry;
    request.samples.insert(request.samples.end(), pattern_.begin(), pattern_.end());
    return request;
  }
  LinearImage combined(const LinearImage& color, const Frame& data) const override {
    const Reconstruction reconstruction(color, data.sample_geometry, pattern_, bilateral_);
    LinearImage out(color.width(), color.height(), Linear{0, 0, 0, 0});
    for_rows(out.height(), [&](int y) { reconstruction.row(y, out.row(y)); });
    return out;
  }

  SamplePattern pattern_;
  Bilateral bilateral_;
};

constexpr int counts[] = {2, 4, 8, 16};
constexpr Param params[] = {
    {.name = "n", .meaning = "geometry samples per pixel, in the standard pattern", .value = 4, .choices = counts},
    {.name = "scale", .meaning = "falloff of the bilateral weight", .value = 40, .low = 1, .high = 10000},
    {.name = "depth",
     .meaning = "weight of depth differences relative to normals",
     .value = 10,
     .low = 0,
     .high = 10000},
    {.name = "radius",
     .meaning = "radius, in pixels, in which shaded pixel centres contribute to a sample",
     .value = 1,
     .low = 0.75,
     .high = 1.5,
     .decimals = 2}};

constexpr std::string_view variants[] = {"n=8"};

}  // namespace
}  // namespace sraa_method

Method sraa() {
  return {.name = "sraa",
          .summary = "one shaded sample per pixel, distributed to geometry samples of similar normal and depth",
          .source = "Chajdas 2011",
          .params = sraa_method::params,
          .make = [](const Settings& s) -> std::unique_ptr<Resolver> {
            const sraa_method::Bilateral bilateral{
                {static_cast<float>(s.integer("scale")), static_cast<float>(s.integer("depth"))}, s.number("radius")};
            return std::make_unique<sraa_method::Sraa>(s.integer("n"), bilateral);
          },
          .variants = sraa_method::variants,
          .is_specification_only = true};
}

}  // namespace antialias
}  // namespace zoneplate
