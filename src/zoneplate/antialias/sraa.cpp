// Subpixel reconstruction antialiasing: each pixel is shaded once, at its centre; normals and distances are known at
// more places, and each of these takes the mean of the shaded colours around it, weighted by the likeness of surfaces.
//
// Geometry is drawn at n samples a pixel and at its centre, without shading: normals are interpolated from the
// vertices, so that a normal map is not seen. Weak where surfaces are narrower than a pixel: of one that is shaded
// nowhere nearby the colour is another's; and inside a surface colours are blurred over about a pixel.
//
// Source: Chajdas, McGuire, Luebke, Subpixel Reconstruction Antialiasing for Deferred Shading, I3D 2011: weights
// exp(-scale max(1 - N·N', depth scale |z - z'|)) of their published kernel. It leaves both scales to the scene. Here
// depths are compared relative to the nearer one, so that one scale serves scenes of any size; the scales' defaults
// and the radius are ours. Blended surfaces are not in the geometry: their outlines stay as they were shaded.
#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/codes.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

struct Bilateral {
  float scale, depth;
  double radius;  ///< pixels, from a sample to the centres whose colours count
};

/// The weight of what is shaded at one place for another, both as in Frame::sample_geometry.
float likeness(const Linear& a, const Linear& b, const Bilateral& bilateral) {
  const float3 normal{a.r, a.g, a.b}, other{b.r, b.g, b.b};
  const bool is_empty = normal == float3{}, is_other_empty = other == float3{};
  if (is_empty || is_other_empty) return is_empty == is_other_empty ? 1.0f : 0.0f;
  const float far = std::abs(a.a - b.a) / std::min(a.a, b.a), turned = 1 - dot(normal, other);
  return exp(-bilateral.scale * std::max(turned, bilateral.depth * far));
}

/// A pixel near a sample, relative to the sample's own.
struct Offset {
  int x, y;
};

/// Those of the 3 × 3 pixels around whose centres lie within the radius, row by row.
std::vector<Offset> offsets_around(SamplePosition sample, double radius) {
  std::vector<Offset> out;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const double dx = x + 0.5 - sample.x / 256.0, dy = y + 0.5 - sample.y / 256.0;
      if (dx * dx + dy * dy <= radius * radius) out.push_back({x, y});
    }
  return out;
}

/// Colours of pixels and geometry of samples, the first of which are the pixels' centres.
class Reconstruction {
 public:
  Reconstruction(const LinearImage& color, const std::vector<LinearImage>& geometry, const SamplePattern& pattern,
                 const Bilateral& bilateral)
      : color_(color), geometry_(geometry), bilateral_(bilateral), all_around_(offsets_around({}, 1.5)) {
    for (const SamplePosition sample : pattern) around_.push_back(offsets_around(sample, bilateral.radius));
  }

  Linear pixel(int x, int y) const {
    Linear sum{0, 0, 0, 0};
    for (std::size_t s = 0; s < around_.size(); ++s) sum = sum + sample(s, x, y);
    return sum * (1 / static_cast<float>(around_.size()));
  }

 private:
  /// A sample that is like no centre within the radius is compared with all of the 3 × 3 pixels around; like none of
  /// them, it takes its own pixel's colour.
  Linear sample(std::size_t s, int x, int y) const {
    const Linear& geometry = geometry_[s + 1](x, y);
    if (const std::optional<Linear> mean = mean_around(geometry, around_[s], x, y)) return *mean;
    return mean_around(geometry, all_around_, x, y).value_or(color_(x, y));
  }

  std::optional<Linear> mean_around(const Linear& geometry, const std::vector<Offset>& around, int x, int y) const {
    constexpr float least_weight = 1e-20f;
    Linear sum{0, 0, 0, 0};
    float weight = 0;
    for (const Offset o : around) {
      const int i = x + o.x, j = y + o.y;
      if (i < 0 || j < 0 || i >= color_.width() || j >= color_.height()) continue;
      const float w = likeness(geometry, geometry_[0](i, j), bilateral_);
      sum = sum + color_(i, j) * w;
      weight += w;
    }
    return weight > least_weight ? std::optional(sum * (1 / weight)) : std::nullopt;
  }

  const LinearImage& color_;
  const std::vector<LinearImage>& geometry_;
  Bilateral bilateral_;
  std::vector<Offset> all_around_;
  std::vector<std::vector<Offset>> around_;  ///< by sample of the pattern
};

class Sraa : public Resolver {
 public:
  Sraa(int samples, Bilateral bilateral) : pattern_(standard_pattern(samples)), bilateral_(bilateral) {}

  Request ask(int) override {
    color_ = {};
    Request request;
    request.halo = 1;
    return request;
  }
  /// The picture first, then the geometry.
  std::optional<Request> ask_again(Frame& frame) override {
    if (!color_.empty()) return std::nullopt;
    color_ = std::move(frame.color);
    Request request;
    request.content = Content::Geometry;
    request.samples.insert(request.samples.end(), pattern_.begin(), pattern_.end());
    request.halo = 1;
    return request;
  }
  LinearImage resolve(Frame& frame) override {
    if (color_.empty()) return std::move(frame.color);
    const Reconstruction reconstruction(color_, frame.sample_geometry, pattern_, bilateral_);
    LinearImage out(color_.width(), color_.height());
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x) out(x, y) = reconstruction.pixel(x, y);
    });
    return out;
  }

 private:
  SamplePattern pattern_;
  Bilateral bilateral_;
  LinearImage color_;
};

constexpr int counts[] = {2, 4, 8, 16};
constexpr Param params[] = {
    {.name = "n", .meaning = "geometric samples a pixel, in the standard pattern", .value = 4, .choices = counts},
    {.name = "scale", .meaning = "falloff of the bilateral weight", .value = 40, .low = 1, .high = 10000},
    {.name = "depth", .meaning = "weight of depths against normals", .value = 10, .low = 0, .high = 10000},
    {.name = "radius",
     .meaning = "pixels from a sample to the shaded centres that count",
     .value = 100,
     .low = 75,
     .high = 150,
     .decimals = 2}};

constexpr std::string_view variants[] = {"n=8"};

}  // namespace

Method sraa();

Method sraa() {
  return {.name = "sraa",
          .summary = "one shaded sample a pixel, given to geometric samples of like normal and depth",
          .source = "Chajdas 2011",
          .params = params,
          .make = [](const Settings& s) -> std::unique_ptr<Resolver> {
            const Bilateral bilateral{static_cast<float>(s.integer("scale")), static_cast<float>(s.integer("depth")),
                                      s.number("radius")};
            return std::make_unique<Sraa>(s.integer("n"), bilateral);
          },
          .variants = variants,
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
