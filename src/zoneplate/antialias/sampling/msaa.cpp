// SPDX-License-Identifier: Apache-2.0
// Multisampling: coverage and depth at every sample, shading once per surface and pixel.
//
// It smooths the edges of geometry at little more than the cost of one sample; it has no effect on aliasing inside
// surfaces (textures, highlights). Visibility is stored per sample and shading is deferred: a pixel where two surfaces
// meet blends their two colours and never the background's (the black edge of renderers with one depth per pixel).
// Edges of alpha tests are not smoothed, unless alpha is converted to coverage.
//
// Source: Akeley, RealityEngine Graphics, SIGGRAPH 1993; patterns of Direct3D 11.1 and Vulkan. A surface that owns
// every sample is shaded at the pixel's centre, any other at the mean of its samples (centroid sampling;
// raster/coverage/centroid.h has this and other rules), so that a plane has the same colours for any tessellation.
// Sharpened alpha: Golus, Anti-aliased Alpha Test: The Esoteric Alpha To Coverage, 2017.
#include "zoneplate/antialias/sampling/sample_accumulator.h"
#include "zoneplate/base/error.h"

namespace zoneplate::antialias {
namespace msaa_method {
namespace {

class Msaa : public Resolver {
 public:
  Msaa(SamplePattern pattern, ResolveFilter filter, AlphaTest alpha, Centroid centroid)
      : pattern_(std::move(pattern)),
        filter_(std::move(filter)),
        accumulator_(filter_),
        alpha_(alpha),
        centroid_(centroid) {}
  Request request(const FrameContext&) override {
    Request request{.samples = pattern_, .rate = Rate::Surface, .weights = {}, .planes = {}, .pixel_mask = {}};
    request.alpha = alpha_;
    request.centroid = centroid_;
    request.resolves_per_pixel = filter_.is_plain();
    request.planes.sample_colors = !filter_.is_plain();
    request.halo = filter_.radius();
    request.is_display_referred = filter_.is_display_referred();
    request.ends_in_light = !request.is_display_referred;
    return request;
  }
  LinearImage resolve(Frame& frame) override {
    if (filter_.is_plain()) return std::move(frame.color);
    accumulator_ = SampleAccumulator(filter_);
    accumulator_.add(frame, pattern_);
    return accumulator_.light();
  }
  DisplayImage post_process(DisplayImage image, const Frame& frame) override {
    return filter_.is_plain() ? image : accumulator_.display_referred(std::move(image), frame.display);
  }

 private:
  SamplePattern pattern_;
  ResolveFilter filter_;
  SampleAccumulator accumulator_;
  AlphaTest alpha_;
  Centroid centroid_;
};

constexpr int counts[] = {2, 4, 8, 16};
constexpr std::string_view alphas[] = {"test", "samples", "coverage", "sharp"};
constexpr std::string_view centroids[] = {"mean", "first", "centre"};
constexpr Param params[] = {
    {.name = "n", .meaning = "samples of the standard pattern", .value = 4, .choices = counts},
    {.name = "grid", .meaning = "a regular grid of grid × grid samples, instead of n", .value = 4, .low = 1, .high = 8},
    resolve_param,
    mix_param,
    filter_param,
    radius_param,
    {.name = "alpha",
     .meaning =
         "alpha test of masked surfaces: once a pixel, at every sample, or alpha to coverage, plain or sharpened",
     .names = alphas},
    {.name = "centroid",
     .meaning = "where a surface with some of a pixel's samples is shaded: at their mean, at the first, or at the "
                "pixel's centre, even outside the surface",
     .names = centroids},
};

std::unique_ptr<Resolver> make(const Settings& s) {
  if (s.is_given("n") && s.is_given("grid"))
    throw Error(ErrorKind::Usage, "msaa: n and grid exclude each other: n is a standard pattern, grid a regular one");
  return std::make_unique<Msaa>(s.is_given("grid") ? grid_pattern(s.integer("grid")) : standard_pattern(s.integer("n")),
                                resolve_filter_of("msaa", s), static_cast<AlphaTest>(s.integer("alpha")),
                                static_cast<Centroid>(s.integer("centroid")));
}

constexpr std::string_view variants[] = {"n=2",
                                         "n=8",
                                         "n=16",
                                         "grid=4",
                                         "n=8,resolve=karis",
                                         "n=8,resolve=max3",
                                         "n=8,resolve=display",
                                         "n=8,filter=b-spline,radius=1",
                                         "n=8,alpha=samples",
                                         "n=8,alpha=coverage",
                                         "n=8,alpha=sharp"};

}  // namespace
}  // namespace msaa_method

Method msaa() {
  return {.name = "msaa",
          .summary = "coverage per sample, shading once per surface and pixel",
          .source = "Akeley 1993",
          .params = msaa_method::params,
          .make = msaa_method::make,
          .variants = msaa_method::variants};
}

}  // namespace zoneplate::antialias
