// Multisampling: coverage and depth at every sample, shading once per surface and pixel.
//
// Smooths the edges of geometry at little more than the cost of one sample; does nothing for what shading itself
// makes of a pixel: textures, highlights, alpha tests. Because visibility is kept per sample and shading is deferred, a
// pixel where two surfaces meet mixes their two colours and never the background's (the black edge of one depth a
// pixel).
//
// Source: Akeley, RealityEngine Graphics, SIGGRAPH 1993; patterns of Direct3D 11.1 and Vulkan. A surface that owns
// every sample is shaded at the pixel's centre, another at its first sample (centroid sampling).
#include "zoneplate/base/error.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

class Msaa : public Resolver {
 public:
  explicit Msaa(SamplePattern pattern) : pattern_(std::move(pattern)) {}
  Request ask(int) override {
    return {.samples = pattern_, .rate = Rate::Surface, .weights = {}, .planes = {}, .is_local = true};
  }

 private:
  SamplePattern pattern_;
};

constexpr int counts[] = {2, 4, 8, 16};
constexpr Param params[] = {
    {.name = "n", .meaning = "samples of the standard pattern", .value = 4, .choices = counts},
    {.name = "grid", .meaning = "a regular grid of grid × grid samples, instead of n", .value = 4, .low = 1, .high = 8},
};

std::unique_ptr<Resolver> make(const Settings& s) {
  if (s.is_given("n") && s.is_given("grid"))
    throw Error(Trouble::Usage, "msaa: n and grid exclude each other: n is a standard pattern, grid a regular one");
  return std::make_unique<Msaa>(s.is_given("grid") ? grid_pattern(s.integer("grid"))
                                                   : standard_pattern(s.integer("n")));
}

}  // namespace

Method msaa();

Method msaa() {
  return {.name = "msaa",
          .summary = "coverage per sample, shading once per surface and pixel",
          .source = "Akeley 1993",
          .params = params,
          .make = make};
}

}  // namespace zoneplate::antialias
