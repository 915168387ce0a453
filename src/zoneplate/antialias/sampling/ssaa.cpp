// SPDX-License-Identifier: Apache-2.0
// Supersampling: shades every sample of a pattern and averages them in linear light.
//
// It converges to the box-filtered image as the number of samples grows, at proportional cost. Weakness: edges along
// the grid: a nearly vertical edge has n levels of coverage on an n × n grid, not n². The mean of Halton points differs
// from the pixel's centre, and shifts the image by that offset.
//
// Source: Crow, The Aliasing Problem in Computer-Generated Shaded Images, CACM 20(11), 1977. The patterns are those of
// signal/samples.h, the filters those of signal/filter/kernel.h.
#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/sampling/sample_accumulator.h"
#include "zoneplate/base/error.h"

namespace zoneplate::antialias {
namespace ssaa_method {
namespace {

constexpr std::size_t samples_a_round = 16;  // limits the number of stored samples

class Ssaa : public Resolver {
 public:
  Ssaa(SamplePattern pattern, ResolveFilter filter)
      : pattern_(std::move(pattern)), filter_(std::move(filter)), accumulator_(filter_) {}

  Request request(const FrameContext&) override {
    if (filter_.is_plain())
      return {.samples = pattern_,
              .rate = Rate::Sample,
              .weights = {},
              .planes = {},
              .pixel_mask = {},
              .resolves_per_pixel = true};
    accumulator_ = SampleAccumulator(filter_);
    taken_ = 0;
    return next_round();
  }
  std::optional<Request> refine(Frame& frame) override {
    if (filter_.is_plain()) return std::nullopt;
    take(frame);
    if (taken_ == pattern_.size()) return std::nullopt;
    return next_round();
  }
  LinearImage resolve(Frame& frame) override {
    if (filter_.is_plain()) return std::move(frame.color);
    if (accumulator_.is_empty()) take(frame);
    return accumulator_.light();
  }
  DisplayImage post_process(DisplayImage image, const Frame& frame) override {
    return filter_.is_plain() ? image : accumulator_.display_referred(std::move(image), frame.display);
  }

 private:
  SamplePattern round() const {
    const auto first = pattern_.begin() + static_cast<std::ptrdiff_t>(taken_);
    return {first, first + static_cast<std::ptrdiff_t>(std::min(samples_a_round, pattern_.size() - taken_))};
  }
  Request next_round() const {
    Request request{.samples = round(), .rate = Rate::Sample, .weights = {}, .planes = {}, .pixel_mask = {}};
    request.planes.sample_colors = true;
    request.footprint = 1 / std::sqrt(static_cast<float>(pattern_.size()));
    request.halo = filter_.radius();
    request.is_display_referred = filter_.is_display_referred();
    request.ends_in_light = !request.is_display_referred;
    return request;
  }
  void take(const Frame& frame) {
    const SamplePattern own = round();
    accumulator_.add(frame, own);
    taken_ += own.size();
  }

  SamplePattern pattern_;
  ResolveFilter filter_;
  SampleAccumulator accumulator_;
  std::size_t taken_ = 0;  // samples of the pattern that are already in the sums
};

constexpr std::string_view patterns[] = {"grid", "rotated", "halton", "sobol", "nrooks"};
constexpr Param params[] = {
    {.name = "n", .meaning = "an n × n grid of samples", .value = 2, .low = 1, .high = 16},
    {.name = "pattern", .meaning = "sample pattern", .value = 0, .names = patterns},
    {.name = "samples", .meaning = "shaded samples per pixel, instead of n", .value = 4, .low = 1, .high = 1024},
    resolve_param,
    mix_param,
    filter_param,
    radius_param,
};

std::unique_ptr<Resolver> make(const Settings& s) {
  if (s.is_given("n") && s.is_given("samples"))
    throw Error(ErrorKind::Usage, "ssaa: n and samples exclude each other: n=4 is samples=16");
  const int samples = s.is_given("samples") ? s.integer("samples") : s.integer("n") * s.integer("n");
  return std::make_unique<Ssaa>(named_pattern(std::string(s.chosen("pattern")), samples), resolve_filter_of("ssaa", s));
}

constexpr std::string_view variants[] = {"n=4",
                                         "pattern=rotated,samples=4",
                                         "pattern=halton,samples=16",
                                         "pattern=sobol,samples=16",
                                         "pattern=nrooks,samples=16",
                                         "n=4,resolve=display",
                                         "n=4,filter=tent",
                                         "n=4,filter=mitchell"};

}  // namespace
}  // namespace ssaa_method

Method ssaa() {
  return {.name = "ssaa",
          .summary = "every sample of a pattern is shaded, and the samples averaged",
          .source = "Crow 1977",
          .params = ssaa_method::params,
          .make = ssaa_method::make,
          .variants = ssaa_method::variants};
}

}  // namespace zoneplate::antialias
