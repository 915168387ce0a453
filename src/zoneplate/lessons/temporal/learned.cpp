// SPDX-License-Identifier: Apache-2.0
// What a network adds to the mean of jittered frames: where it trusts history, and where it should not have.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <type_traits>

#include "zoneplate/image/tonemap.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/lessons/temporal/moving_film.h"
#include "zoneplate/metrics/mse.h"
#include "zoneplate/metrics/psnr.h"
#include "zoneplate/upscale/learned/learned_mean.h"
#include "zoneplate/upscale/taau/taau_method.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::lessons {
namespace learned_lesson {
namespace {

constexpr int factor = 4;

struct Case {
  const char *scene, *heading, *words;
  int frame;    ///< that is shown
  double x, y;  ///< the middle of the crop, in parts of the image
};
constexpr std::array<Case, 3> cases = {
    {{"panning-wires", "The first frame", "Without history: the mean of several samples, not the nearest one alone.", 0,
      0.22, 0.42},
     {"light-switch", "A switched light",
      "History of the other light is dropped, but for its highlight at the left: a ghost.", 13, 0.42, 0.45},
     {"teleport", "Turning spokes", "Where it fails: beside a spoke some of the last positions are kept.", 13, 0.5,
      0.5}}};

/// A method whose images are the counts of samples that each pixel rests on: black none, white 64, by their logarithm.
template <class Mean>
class Counts : public Mean {
 public:
  using Mean::Mean;
  LinearImage accumulate(const upscale::TaauInput& frame) {
    LinearImage image = Mean::accumulate(frame);
    const std::span<const float> counts = Mean::counts().values();
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const float grey = std::log2(1 + counts[i]) / std::log2(65.0f);
      image.values()[i] = {grey, grey, grey, 1};
    }
    return image;
  }
};

double psnr(const LinearImage& reference, const LinearImage& test) {
  return metrics::psnr_of_mse(metrics::mean_squared_error(make_display(reference, {}), make_display(test, {})));
}

Lesson make(const DemoSize& size, const Settings&) {
  const int side = size.panel, height = side * 3 / 4;
  Figure figure{.title = "Learned super-sampling: a network corrects the mean of jittered frames"};
  for (const Case& each : cases) {
    const auto last = [&](std::unique_ptr<Resolver> method) {
      return film_of_scene(each.scene, std::move(method), each.frame + 1, side, height).back();
    };
    const auto by_name = [&](const char* method) { return last(upscale::make_method(method)); };
    const auto crop = [&](const Rgba8Image& picture) {
      return crop_of(picture, static_cast<int>(side * each.x), static_cast<int>(height * each.y), factor, side);
    };
    const LinearImage reference = by_name("ssaa:n=8"), taau = by_name("taau:scale=2,bias=-1"),
                      learned = by_name("learned");
    const auto counts = [&]<class Mean>(std::type_identity<Mean>) {
      return crop(shown(last(std::make_unique<upscale::TaauMethod<Counts<Mean>>>("counts", 2, -1))));
    };
    figure.rows.push_back(
        {{crop(shown(reference)), fmt::format("{}\n{}", each.heading, each.words)},
         {crop(shown(taau)), fmt::format("taau\n{} dB", number(psnr(reference, taau), 1))},
         {crop(shown(learned)), fmt::format("learned\n{} dB", number(psnr(reference, learned), 1))},
         {counts(std::type_identity<upscale::SampleMean>()), "taau\nThe samples that a pixel rests on."},
         {counts(std::type_identity<upscale::LearnedMean>()), "learned\nThe same: dark where history is dropped."}});
  }
  figure.text =
      "Each frame has a quarter of the image's pixels. taau is the mean of all samples that a pixel has had, less "
      "those "
      "that rules drop. learned is the same mean; a network corrects the weights of a frame's samples, and how much "
      "history counts, per pixel, and filters of 3 x 3 pixels improve the image. The crops are enlarged 4 times, with "
      "the PSNR of the whole frame against 64 samples "
      "per pixel; on the right black is a pixel without samples, white one with 64.";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace learned_lesson

Demo demo_learned() {
  return {"learned", "where a network keeps history that rules drop, and where it keeps too much",
          learned_lesson::make};
}

}  // namespace zoneplate::lessons
