// Subpixel reconstruction: shade each pixel once, know normal and depth at more places, and give every place the
// colours of shaded pixels nearby whose surface looks alike.
//
// With the likeness of normals and depths, as published; `idsraa` knows the triangles themselves. Weak where surfaces
// are smaller than a pixel, where two of them are alike, and on the depths of a surface that is seen edge-on.
//
// Source: Chajdas, McGuire, Luebke, Subpixel Reconstruction Antialiasing for Deferred Shading, I3D 2011: weights
// exp(-scale max(1 - N·N', depth scale |z - z'|)). Here depths are compared relative to the nearer one, so that one
// scale serves scenes of any size. The renderer keeps normals of pixels, not of samples: each place takes a round of
// its own, whose shading is thrown away.
#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/codes.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

/// What is known of one place of every pixel.
struct Geometry {
  Plane<float> depth;  ///< infinite where nothing is
  Plane<float3> normal;
};

struct Scales {
  float all, depth;
};

/// How much the colour of one place says of another.
float likeness(const Geometry& a, int x, int y, const Geometry& b, int i, int j, const Scales& scales) {
  const float z = a.depth(x, y), w = b.depth(i, j);
  const bool is_empty = std::isinf(z), is_other_empty = std::isinf(w);
  if (is_empty || is_other_empty) return is_empty == is_other_empty ? 1.0f : 0.0f;
  const float far = std::abs(z - w) / std::min(z, w), turned = 1 - dot(a.normal(x, y), b.normal(i, j));
  const float unlike = scales.all * std::max(turned, scales.depth * far);
  return unlike < 80 ? exp(-unlike) : 0.0f;
}

class Sraa : public Resolver {
 public:
  Sraa(int samples, Scales scales) : pattern_(standard_pattern(samples)), scales_(scales) {}

  Request ask(int) override {
    places_.clear();
    return round({SamplePosition{}});
  }
  std::optional<Request> ask_again(Frame& frame) override {
    if (places_.empty()) color_ = std::move(frame.color);
    places_.push_back({std::move(frame.depth), std::move(frame.normal)});
    if (places_.size() > pattern_.size()) return std::nullopt;
    return round({pattern_[places_.size() - 1]});
  }
  LinearImage resolve(Frame& frame) override {
    if (places_.size() <= pattern_.size()) return std::move(frame.color);
    LinearImage out(color_.width(), color_.height());
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x) out(x, y) = pixel(x, y);
    });
    return out;
  }

 private:
  static Request round(SamplePattern place) {
    Request request{.samples = std::move(place), .rate = Rate::Surface, .weights = {}, .planes = {}, .where = {}};
    request.planes.depth = request.planes.normal = true;
    request.halo = 1;
    return request;
  }

  Linear pixel(int x, int y) const {
    Linear sum{0, 0, 0, 0};
    for (std::size_t s = 1; s < places_.size(); ++s) sum = sum + sample(places_[s], x, y);
    return sum * (1 / static_cast<float>(pattern_.size()));
  }

  /// A place that looks like nothing around takes its own pixel's colour.
  Linear sample(const Geometry& place, int x, int y) const {
    Linear sum{0, 0, 0, 0};
    float weight = 0;
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, color_.height() - 1); ++j)
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, color_.width() - 1); ++i) {
        const float w = likeness(place, x, y, places_[0], i, j, scales_);
        sum = sum + color_(i, j) * w;
        weight += w;
      }
    return weight > 1e-20f ? sum * (1 / weight) : color_(x, y);
  }

  SamplePattern pattern_;
  Scales scales_;
  LinearImage color_;
  std::vector<Geometry> places_;  ///< the pixels' centres, then the pattern
};

constexpr int counts[] = {2, 4, 8, 16};
constexpr Param params[] = {
    {.name = "n", .meaning = "places of the standard pattern where surfaces are known", .value = 4, .choices = counts},
    {.name = "scale", .meaning = "how little unlike surfaces give", .value = 40, .low = 1, .high = 10000},
    {.name = "depth", .meaning = "weight of depths against normals", .value = 10, .low = 0, .high = 10000}};

constexpr std::string_view variants[] = {"n=8"};

}  // namespace

Method sraa();

Method sraa() {
  return {.name = "sraa",
          .summary = "one shaded sample a pixel, given to places of like normal and depth",
          .source = "Chajdas 2011",
          .params = params,
          .make = [](const Settings& s) -> std::unique_ptr<Resolver> {
            return std::make_unique<Sraa>(
                s.integer("n"), Scales{static_cast<float>(s.integer("scale")), static_cast<float>(s.integer("depth"))});
          },
          .variants = variants,
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
