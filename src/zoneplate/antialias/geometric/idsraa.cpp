// SPDX-License-Identifier: Apache-2.0
// Subpixel reconstruction by triangle id: each pixel is shaded once, at its centre. Triangle ids are rendered at more
// samples, and each sample takes the colour of nearby shaded pixels with the same triangle.
//
// A variant of subpixel reconstruction antialiasing that compares triangle ids instead of normals and depths. A sample
// whose triangle is shaded in no pixel nearby takes the colour of the pixel with the most similar depth. With one
// colour per triangle the result is the same as multisampling. Weaknesses: surfaces smaller than a pixel; and, as in
// multisampling, aliasing of shading is not reduced. Blended surfaces are sampled at the pixel's centre.
//
// Source: after Chajdas, McGuire, Luebke, Subpixel Reconstruction Antialiasing for Deferred Shading, I3D 2011.
#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/geometric/color_then_data.h"
#include "zoneplate/antialias/post/encoded.h"

namespace zoneplate::antialias {
namespace idsraa_method {
namespace {

/// Offsets of the neighbouring pixels, nearest first; of equal differences of depth the first is used.
struct Offset {
  int x, y;
};
constexpr Offset around[] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};

/// The colours of pixels, and the triangles of samples, the first of which are the pixels' centres.
class Reconstruction {
 public:
  Reconstruction(const LinearImage& color, const Frame& frame) : color_(color), frame_(frame) {}

  Linear pixel(int x, int y) const {
    const std::uint32_t own = triangle(0, x, y);
    const std::size_t samples = frame_.sample_triangle.size() - 1;
    Linear sum{0, 0, 0, 0};
    std::size_t own_count = 0;
    for (std::size_t s = 1; s <= samples; ++s) {
      if (triangle(s, x, y) == own)
        ++own_count;
      else
        sum = sum + sample(s, x, y);
    }
    const Linear& color = color_(x, y);
    if (own_count == samples) return color;
    return (sum + color * static_cast<float>(own_count)) * (1 / static_cast<float>(samples));
  }

 private:
  std::uint32_t triangle(std::size_t s, int x, int y) const { return frame_.sample_triangle[s](x, y); }
  float depth(std::size_t s, int x, int y) const { return frame_.sample_depth[s](x, y); }
  bool is_inside(int x, int y) const { return x >= 0 && y >= 0 && x < color_.width() && y < color_.height(); }

  /// The mean of the neighbouring pixels that have the sample's triangle, or else the one of most similar depth.
  Linear sample(std::size_t s, int x, int y) const {
    const std::uint32_t sample_id = triangle(s, x, y);
    const float z = depth(s, x, y);
    Linear sum{0, 0, 0, 0}, nearest = color_(x, y);
    int count = 0;
    float least = 2;
    for (const Offset o : around) {
      const int i = x + o.x, j = y + o.y;
      if (!is_inside(i, j)) continue;
      const Linear& color = color_(i, j);
      if (triangle(0, i, j) == sample_id) sum = sum + color, ++count;
      // Reversed depth is proportional to 1 / distance, so that relative differences are those of distances.
      const float other = depth(0, i, j), greater = std::max(z, other);
      const float unlike = greater > 0 ? std::abs(z - other) / greater : 0;
      if (unlike < least) least = unlike, nearest = color;
    }
    return count > 0 ? sum * (1 / static_cast<float>(count)) : nearest;
  }

  const LinearImage& color_;
  const Frame& frame_;
};

class IdSraa : public ColorThenData {
 public:
  explicit IdSraa(int samples) {
    pattern_ = {SamplePosition{}};
    for (const SamplePosition p : standard_pattern(samples)) pattern_.push_back(p);
  }

 private:
  Request data_request() const override {
    Request request;
    request.samples = pattern_;
    request.content = Content::Visibility;
    request.planes.samples = true;
    request.centroid = Centroid::First;  // the alpha test is evaluated at the pixel's centre if the triangle covers it
    return request;
  }
  LinearImage combined(const LinearImage& color, const Frame& data) const override {
    const Reconstruction reconstruction(color, data);
    LinearImage out(color.width(), color.height());
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x) out(x, y) = reconstruction.pixel(x, y);
    });
    return out;
  }

  SamplePattern pattern_;
};

constexpr int counts[] = {2, 4, 8, 16};
constexpr Param params[] = {
    {.name = "n", .meaning = "triangle-id samples per pixel, in the standard pattern", .value = 8, .choices = counts}};

constexpr std::string_view variants[] = {"n=4"};

}  // namespace
}  // namespace idsraa_method

Method idsraa() {
  return {.name = "idsraa",
          .summary = "one shaded sample per pixel, distributed to the samples with its triangle id",
          .source = "after Chajdas 2011",
          .params = idsraa_method::params,
          .make = [](const Settings& s) -> std::unique_ptr<Resolver> {
            return std::make_unique<idsraa_method::IdSraa>(s.integer("n"));
          },
          .variants = idsraa_method::variants,
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
