// SPDX-License-Identifier: Apache-2.0
// Light that changes slowly, on surfaces at rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/antialias/temporal/accumulation.h"
#include "zoneplate/antialias/temporal/sequences_for_test.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate::antialias {
namespace {

constexpr int drift_side = 40;
/// The light at a point of the image, in pixels, in a frame.
using LightAt = std::function<Linear(double x, double y, int frame)>;

Linear grey(double light) {
  const auto l = static_cast<float>(light);
  return {l, l, l, 1};
}

/// The frames of one surface at rest, each sampled at the position that the method requests.
std::vector<LinearImage> accumulated(const std::string& method, const LightAt& light, int frames) {
  TemporalAccumulation accumulation(temporal_options(Settings("method", temporal_params(), method)));
  std::vector<LinearImage> out;
  for (int i = 0; i < frames; ++i) {
    FrameContext context;
    context.index = i, context.is_first = i == 0;
    const SamplePosition sample = accumulation.request(context).samples[0];
    Frame frame;
    frame.color = LinearImage(drift_side, drift_side);
    for (int y = 0; y < drift_side; ++y)
      for (int x = 0; x < drift_side; ++x) frame.color(x, y) = light(x + sample.x / 256.0, y + sample.y / 256.0, i);
    frame.reversed_depth = frame.depth = Plane<float>(drift_side, drift_side, 0.5f);
    frame.object_id = Plane<std::uint32_t>(drift_side, drift_side, 7u);
    frame.motion = Plane<float2>(drift_side, drift_side, float2{0, 0});
    frame.last_position = Plane<float3>(drift_side, drift_side, float3{0, 0, -0.5f});
    out.push_back(accumulation.resolve(frame));
  }
  return out;
}

/// Squares of 1.3 pixels in random greys between 0.2 and 1, and a bright wire half a pixel wide.
double detail(double x, double y) {
  if (std::abs(x - 0.13 * y - 20) < 0.25) return 2;
  const auto column = static_cast<std::uint32_t>(x / 1.3), row = static_cast<std::uint32_t>(y / 1.3);
  return 0.2 + 0.8 * double{unit_float(hash(column, row, 1))};
}

double mean_of(const LinearImage& image) {
  double sum = 0;
  for (const Linear& c : image.values()) sum += double{c.g};
  return sum / static_cast<double>(image.values().size());
}

/// From 0 to 1 in half of the frames, and back.
double ramp(int frame, int frames) { return 1 - std::abs(2.0 * frame / frames - 1); }

TEST(TaaDrift, ALightThatGrowsAndFallsIsFollowed) {
  for (const int frames : {12, 24, 48, 96, 192}) {
    const auto images = accumulated(
        "", [&](double, double, int i) { return grey(ramp(i, frames)); }, frames);
    for (int i = 0; i < frames; ++i)
      ASSERT_NEAR(images[static_cast<std::size_t>(i)](7, 9).g, ramp(i, frames), 0.012) << frames << ' ' << i;
  }
}

TEST(TaaDrift, AFadeBetweenColorsIsFollowed) {
  const Linear colors[] = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  for (int from = 0; from < 3; ++from)
    for (int to = 0; to < 3; ++to) {
      const auto fade = [&](double, double, int i) {
        const float part = static_cast<float>(std::clamp(i - 20, 0, 48)) / 48;
        return Linear{colors[from].r * (1 - part) + colors[to].r * part,
                      colors[from].g * (1 - part) + colors[to].g * part,
                      colors[from].b * (1 - part) + colors[to].b * part, 1};
      };
      const auto images = accumulated("taa", fade, 90);
      for (int i = 0; i < 90; ++i) {
        const Linear is = images[static_cast<std::size_t>(i)](7, 9), right = fade(0, 0, i);
        ASSERT_NEAR(is.r, right.r, 0.08) << from << to << ' ' << i;
        ASSERT_NEAR(is.g, right.g, 0.08) << from << to << ' ' << i;
        ASSERT_NEAR(is.b, right.b, 0.08) << from << to << ' ' << i;
      }
    }
}

// Also where the light's period is that of the jitter, or divides it.
TEST(TaaDrift, AFlickeringLightIsFollowed) {
  for (const int period : {4, 5, 8, 16, 24, 40}) {
    const auto flicker = [&](int i) { return 0.5 + 0.3 * std::sin(2 * std::numbers::pi * i / period); };
    const auto images = accumulated(
        "", [&](double, double, int i) { return grey(flicker(i)); }, 80);
    for (int i = 0; i < 80; ++i)
      ASSERT_NEAR(images[static_cast<std::size_t>(i)](7, 9).g, flicker(i), 0.03) << period << ' ' << i;
  }
}

// In details, whose samples differ more than the light does, the mean of the image follows; and it is there soon after
// the light rests.
TEST(TaaDrift, FineDetailsFollow) {
  for (const int frames : {24, 48, 96}) {
    const auto light = [&](double x, double y, int i) {
      return grey(detail(x, y) * (0.1 + std::min(1.0 * i / frames, 0.9)));
    };
    const auto images = accumulated("taa", light, frames + 24);
    const double whole = mean_of(accumulated(
                                     "rectify=none", [](double x, double y, int) { return grey(detail(x, y)); }, 64)
                                     .back());
    for (int i = 3; i < frames + 24; ++i) {
      const double right = whole * (0.1 + std::min(1.0 * i / frames, 0.9));
      const double allowed = i < frames ? 0.2 : i < frames + 20 ? 0.12 : 0.05;
      EXPECT_NEAR(mean_of(images[static_cast<std::size_t>(i)]) / right, 1, allowed) << frames << ' ' << i;
    }
  }
}

/// The centre of the light beyond 0.2 in the image's middle rows.
double centroid_of(const LinearImage& image) {
  double sum = 0, moment = 0;
  for (int y = 15; y < 25; ++y)
    for (int x = 0; x < drift_side; ++x) {
      const double light = std::max(double{image(x, y).g} - 0.2, 0.0);
      sum += light, moment += light * (x + 0.5);
    }
  return moment / sum;
}

TEST(TaaDrift, ASoftDiscIsWhereItIs) {
  for (const double speed : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    const int frames = static_cast<int>(28 / speed);
    const auto place = [&](int i) { return 6 + speed * i; };
    const auto light = [&](double x, double y, int i) {
      const double dx = (x - place(i)) / 9, dy = (y - 20) / 9, inside = std::max(0.0, 1 - dx * dx - dy * dy);
      return grey(0.2 + 0.6 * inside * inside);
    };
    const auto images = accumulated("taa", light, frames);
    const auto samples = accumulated("taa:blend=fixed,alpha=1,rectify=none,rest=test", light, frames);
    for (int i = 1; i < frames; ++i) {
      const auto k = static_cast<std::size_t>(i);
      EXPECT_NEAR(centroid_of(images[k]), centroid_of(samples[k]), 1.5) << speed << ' ' << i;
    }
  }
}

// Samples of details vary by the jitter alone: nothing may be taken for light that changes.
TEST(TaaDrift, AtRestNothingIsLost) {
  const std::pair<const char*, double> cases[] = {
      {"halton", 1.15}, {"r2", 1.15}, {"halton,length=8", 1.15}, {"halton-uncentred,length=32", 1.35}};
  for (const auto& [jitter, most] : cases) {
    const auto light = [](double x, double y, int) { return grey(detail(x, y)); };
    const LinearImage exact = accumulated("taa:rectify=none,alpha=0.001,length=256", light, 256).back();
    const std::string text = std::string("taa:jitter=") + jitter;
    const double kept = rms(accumulated(text + ",rectify=none", light, 64).back(), exact);
    const double own = rms(accumulated(text, light, 64).back(), exact);
    EXPECT_LE(own, most * kept) << jitter;
    EXPECT_GT(rms(accumulated(text + ",rest=test", light, 64).back(), exact), 1.5 * kept) << jitter;
  }
}

/// The error of the changes from each frame to the next.
double rms_of_changes(const std::vector<LinearImage>& images, const std::vector<LinearImage>& reference) {
  double sum = 0;
  for (std::size_t i = 1; i < images.size(); ++i)
    for (std::size_t k = 0; k < images[i].values().size(); ++k) {
      const auto change = [&](const std::vector<LinearImage>& of) {
        return double{of[i].values()[k].g} - double{of[i - 1].values()[k].g};
      };
      const double error = change(images) - change(reference);
      sum += error * error;
    }
  return std::sqrt(sum / (static_cast<double>(images.size() - 1) * static_cast<double>(images[0].values().size())));
}

TEST(TaaDrift, ScenesOfSlowLightAreNoWorseThanClamped) {
  // The ratio of the errors of changes: a soft disc's gradient moves with the jitter.
  const std::pair<const char*, double> cases[] = {{"light-ramp", 1.3}, {"soft-shadow", 1.1}, {"soft-disc", 1.4}};
  for (const auto& [name, most] : cases) {
    const auto at = [scene = std::string(name)](int i) {
      return *make_builtin_scene(scene + ":time=" + std::to_string(i / 24.0));
    };
    const MovingScene moving{at, [](int) { return flat_camera(1); }};
    const auto reference = film(moving, "ssaa:n=8", 24), own = film(moving, "taa", 24),
               clamped = film(moving, "taa:rest=test", 24);
    double error = 0, limit = 0;
    for (std::size_t i = 0; i < 24; ++i) error += rms(own[i], reference[i]), limit += rms(clamped[i], reference[i]);
    EXPECT_LE(error, 0.75 * limit) << name;
    EXPECT_LE(rms_of_changes(own, reference), most * rms_of_changes(clamped, reference)) << name;
  }
}

TEST(TaaDrift, InstructionSetsAndThreadsDoNotChangeABit) {
  const MovingScene moving{[](int i) { return *make_builtin_scene("soft-disc:time=" + std::to_string(i / 24.0)); },
                           [](int) { return flat_camera(1); }, 67, 45};
  const std::vector<LinearImage> reference = film(moving, "taa", 12);
  for (const Isa isa : supported_isas())
    for (const int threads : {1, 3}) {
      std::vector<LinearImage> images;
      with_isa(isa, [&] { with_threads(threads, [&] { images = film(moving, "taa", 12); }); });
      EXPECT_EQ(images, reference) << name_of(isa) << ' ' << threads;
    }
}

}  // namespace
}  // namespace zoneplate::antialias
