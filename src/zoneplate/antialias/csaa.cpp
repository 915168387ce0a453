// Coverage sampling: many places where coverage is known, few slots for colours.
//
// A pixel keeps the colours of as many surfaces as it has slots, those that own most of its samples; what other
// surfaces own counts for nobody. Smooth where two surfaces meet, at the memory of the slots. Weak where more surfaces
// than slots share a pixel: fine meshes and corners lose some of them.
//
// Source: NVIDIA, Coverage-Sampled Antialiasing, 2006; AMD, EQAA Modes for AMD 6900 Series Graphics Cards, 2011. Theirs
// fill slots in the order of drawing; here they are filled from what is visible in the end.
#include <algorithm>
#include <array>

#include "zoneplate/antialias/codes.h"
#include "zoneplate/base/error.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

class Csaa : public Resolver {
 public:
  Csaa(int samples, int slots) : pattern_(standard_pattern(samples)), slots_(static_cast<std::size_t>(slots)) {}
  Request ask(int) override {
    Request request{.samples = pattern_, .rate = Rate::Surface, .weights = {}, .planes = {}, .where = {}};
    request.planes.samples = true;
    return request;
  }
  LinearImage resolve(Frame& frame) override {
    LinearImage out(frame.color.width(), frame.color.height());
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x) out(x, y) = pixel(frame, x, y);
    });
    return out;
  }

 private:
  struct Slot {
    std::uint32_t triangle = 0;
    int samples = 0;
    Linear color;
  };

  /// Of equally large surfaces the one that owns the earlier sample keeps its slot.
  Linear pixel(const Frame& frame, int x, int y) const {
    std::array<Slot, 16> found;
    std::size_t count = 0;
    for (std::size_t s = 0; s < pattern_.size(); ++s) {
      const std::uint32_t triangle = frame.sample_triangle[s](x, y);
      const auto end = found.begin() + static_cast<std::ptrdiff_t>(count);
      const auto own = std::find_if(found.begin(), end, [&](const Slot& f) { return f.triangle == triangle; });
      if (own == end) found[count++] = {triangle, 0, frame.sample_color[s](x, y)};
      ++own->samples;
    }
    const auto end = found.begin() + static_cast<std::ptrdiff_t>(count);
    std::stable_sort(found.begin(), end, [](const Slot& p, const Slot& q) { return p.samples > q.samples; });
    Linear sum{0, 0, 0, 0};
    int known = 0;
    for (std::size_t i = 0; i < std::min(count, slots_); ++i) {
      sum = sum + found[i].color * static_cast<float>(found[i].samples);
      known += found[i].samples;
    }
    const auto n = static_cast<float>(known);
    return {sum.r / n, sum.g / n, sum.b / n, sum.a / n};
  }

  SamplePattern pattern_;
  std::size_t slots_;
};

constexpr int counts[] = {4, 8, 16}, slot_counts[] = {1, 2, 4, 8};
constexpr Param params[] = {
    {.name = "n", .meaning = "samples of coverage, of the standard pattern", .value = 8, .choices = counts},
    {.name = "slots", .meaning = "colours that a pixel keeps", .value = 4, .choices = slot_counts}};

std::unique_ptr<Resolver> make(const Settings& s) {
  if (s.integer("slots") > s.integer("n")) throw Error(Trouble::Usage, "csaa: more slots than samples: give n=16");
  return std::make_unique<Csaa>(s.integer("n"), s.integer("slots"));
}

constexpr std::string_view variants[] = {"n=8,slots=2", "n=16,slots=4"};

}  // namespace

Method csaa();

Method csaa() {
  return {.name = "csaa",
          .summary = "coverage at many samples, colours of few surfaces (CSAA, EQAA)",
          .source = "after NVIDIA 2006",
          .params = params,
          .make = make,
          .variants = variants,
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
