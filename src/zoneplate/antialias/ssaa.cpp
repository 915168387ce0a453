// Supersampling: shade every sample of a pattern and average them in linear light.
//
// Tends to the box-filtered image as the number of samples grows, at a cost that grows with it. Weak where an edge
// follows the grid: a nearly vertical edge shows n levels of coverage on an n × n grid, not n².
//
// Source: Crow, The Aliasing Problem in Computer-Generated Shaded Images, CACM 20(11), 1977. The patterns are those of
// signal/samples.h.
#include "zoneplate/base/error.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

class Ssaa : public Resolver {
 public:
  explicit Ssaa(SamplePattern pattern) : pattern_(std::move(pattern)) {}
  Request ask(int) override {
    return {.samples = pattern_, .rate = Rate::Sample, .weights = {}, .planes = {}, .is_local = true};
  }

 private:
  SamplePattern pattern_;
};

constexpr std::string_view patterns[] = {"grid", "rotated", "halton", "sobol", "nrooks"};
constexpr Param params[] = {
    {.name = "n", .meaning = "an n × n grid of samples", .value = 2, .low = 1, .high = 16},
    {.name = "pattern", .meaning = "where the samples lie", .value = 0, .names = patterns},
    {.name = "samples", .meaning = "samples a pixel, instead of n", .value = 4, .low = 1, .high = 1024},
};

std::unique_ptr<Resolver> make(const Settings& s) {
  if (s.is_given("n") && s.is_given("samples"))
    throw Error(Trouble::Usage, "ssaa: n and samples exclude each other: n=4 is samples=16");
  const int samples = s.is_given("samples") ? s.integer("samples") : s.integer("n") * s.integer("n");
  return std::make_unique<Ssaa>(named_pattern(std::string(s.chosen("pattern")), samples));
}

}  // namespace

Method ssaa();

Method ssaa() {
  return {.name = "ssaa",
          .summary = "shade every sample of a pattern and average them",
          .source = "Crow 1977",
          .params = params,
          .make = make};
}

}  // namespace zoneplate::antialias
