// SPDX-License-Identifier: Apache-2.0
// Coverage sampling: coverage and depth at many samples, colours in few slots.
//
// A pixel stores the colours of as many surfaces as it has slots, in the order of drawing. If another surface is drawn,
// the one with the fewest samples is dropped, and its samples are unknown until they are drawn again. Smooth where two
// surfaces meet, at the memory cost of the slots. Weakness: pixels with more surfaces than slots, even temporarily:
// fine meshes and corners lose surfaces, and which ones depends on the order.
//
// Source: NVIDIA, Coverage-Sampled Antialiasing, 2006; AMD, EQAA Modes for AMD 6900 Series Graphics Cards, 2011, with a
// depth for every coverage sample: n=8,slots=4 is CSAA 8x, n=16,slots=4 CSAA 16x, n=4,slots=2 EQAA 2f4x. Neither
// defines which surface is dropped. Surfaces in slots are shaded at the end, where they are visible.
#include "zoneplate/antialias/sampling/csaa_draw.h"
#include "zoneplate/base/error.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace csaa_method {
namespace {

class Csaa : public Resolver {
 public:
  Csaa(int samples, int slots) : pattern_(standard_pattern(samples)), slots_(static_cast<std::size_t>(slots)) {}
  Request request(const FrameContext&) override {
    Request request{.samples = pattern_, .rate = Rate::Surface, .weights = {}, .planes = {}, .pixel_mask = {}};
    request.ends_in_light = true;
    request.draw = [samples = pattern_, slots = slots_](const CustomDraw& drawing) {
      draw_with_slots(drawing, samples, slots);
    };
    return request;
  }

 private:
  SamplePattern pattern_;
  std::size_t slots_;
};

constexpr int counts[] = {4, 8, 16}, slot_counts[] = {1, 2, 4, 8};
constexpr Param params[] = {
    {.name = "n", .meaning = "coverage samples, in the standard pattern", .value = 8, .choices = counts},
    {.name = "slots", .meaning = "colour slots per pixel", .value = 4, .choices = slot_counts}};

std::unique_ptr<Resolver> make(const Settings& s) {
  if (s.integer("slots") > s.integer("n")) throw Error(ErrorKind::Usage, "csaa: more slots than samples: give n=16");
  return std::make_unique<Csaa>(s.integer("n"), s.integer("slots"));
}

constexpr std::string_view variants[] = {"n=8,slots=2", "n=16,slots=4"};

}  // namespace
}  // namespace csaa_method

Method csaa() {
  return {.name = "csaa",
          .summary = "coverage at many samples, colours of few surfaces per pixel (CSAA, EQAA)",
          .source = "after NVIDIA 2006",
          .params = csaa_method::params,
          .make = csaa_method::make,
          .variants = csaa_method::variants,
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
