// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "zoneplate/antialias/temporal/accumulation.h"
#include "zoneplate/antialias/temporal/sequences_for_test.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/default_lights.h"

namespace zoneplate::antialias {
namespace {

constexpr const char* taa_presets[] = {"best", "karis", "inside", "salvi", "three", "playcanvas", "bevy"};

std::string of_preset(const std::string& preset) { return "taa:preset=" + preset; }

float max_difference(const LinearImage& a, const LinearImage& b) {
  float most = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) {
    const Linear &p = a.values()[i], &q = b.values()[i];
    most = std::max({most, std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b), std::abs(p.a - q.a)});
  }
  return most;
}

MovingScene turning_teapot() {
  // Lights of its own: filtering the default studio takes minutes on an emulated processor.
  Scene scene = *make_builtin_scene("teapot:divisions=4");
  scene.lights = default_lights();
  MovingScene moving = still(std::move(scene));
  moving.camera = [still = moving.camera(0)](int i) {
    Camera camera = still;
    camera.world_from_camera = rotation(float3{0, 1, 0}, 0.01f * static_cast<float>(i)) * camera.world_from_camera;
    return camera;
  };
  return moving;
}

TEST(Taa, BitsAreThoseOfEveryInstructionSetAndNumberOfThreads) {
  const MovingScene moving = turning_teapot();
  for (const char* preset : taa_presets) {
    const LinearImage scalar = with_isa(Isa::Scalar, [&] { return last_frame(moving, of_preset(preset), 4); });
    for (const Isa isa : supported_isas())
      for (const int threads : {1, 3})
        EXPECT_EQ(with_isa(isa,
                           [&] {
                             LinearImage image;
                             with_threads(threads, [&] { image = last_frame(moving, of_preset(preset), 4); });
                             return image;
                           }),
                  scalar)
            << preset << ' ' << name_of(isa);
  }
  // Parts that no preset has, and the sharpening.
  for (const char* method : {"taa:box=both,history=bilinear,blend=confidence,sharpen=0.5,bias=-1",
                             "taa:rectify=clamp,box=variance,reject=depth,range=compressed,jitter=r2",
                             "taa:reject=id,dilate=none,weigh=luma,current=unjitter"})
    for (const Isa isa : supported_isas())
      EXPECT_EQ(with_isa(isa, [&] { return last_frame(moving, method, 3); }),
                with_isa(Isa::Scalar, [&] { return last_frame(moving, method, 3); }))
          << method << ' ' << name_of(isa);
}

TEST(Taa, ACropHasTheWholeImagesBits) {
  const MovingScene moving = turning_teapot();
  RenderSettings settings = moving.settings();
  const LinearImage whole = film(moving, "taa", 4).back();
  settings.options.crop = Crop{30, 20, 31, 17};
  const LinearImage part = film(moving, "taa", 4, settings).back();
  for (int y = 0; y < 17; ++y)
    for (int x = 0; x < 31; ++x) ASSERT_EQ(part(x, y), whole(30 + x, 20 + y));
}

TEST(Taa, WithoutRectificationAStillSceneIsTheWeightedMeanOfItsFrames) {
  const MovingScene moving = still(*make_builtin_scene("wires"));
  const std::string own = "taa:rectify=none,reject=none,length=16,jitter=halton,bias=0";
  constexpr int frames = 20;
  const std::vector<LinearImage> single = film(moving, own + ",blend=fixed,alpha=1", frames);
  const LinearImage fixed = last_frame(moving, own + ",blend=fixed,alpha=0.1", frames);
  const LinearImage counted = last_frame(moving, own + ",blend=count,alpha=0.001", frames);
  LinearImage exponential = single[0], mean = single[0];
  for (std::size_t p = 0; p < mean.values().size(); ++p) {
    double sum[4] = {}, recursive[4] = {};
    for (std::size_t i = 0; i < frames; ++i) {
      const Linear& c = single[i].values()[p];
      const double channel[4] = {c.r, c.g, c.b, c.a};
      for (int k = 0; k < 4; ++k) {
        sum[k] += channel[k] / frames;
        recursive[k] = i == 0 ? channel[k] : 0.9 * recursive[k] + 0.1 * channel[k];
      }
    }
    const auto color = [](const double(&v)[4]) {
      return Linear{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]),
                    static_cast<float>(v[3])};
    };
    mean.values()[p] = color(sum), exponential.values()[p] = color(recursive);
  }
  EXPECT_LT(max_difference(fixed, exponential), 1e-6f);
  EXPECT_LT(max_difference(counted, mean), 1e-6f);
  EXPECT_GT(max_difference(mean, single[0]), 0.1f);
}

// An edge at rest under a light that is switched every twelve frames, as in the scene light-switch.
TEST(Taa, ASwitchedLightLeavesNoHistory) {
  MovingScene moving;
  const auto light_switch = [](int frame) {
    return *make_builtin_scene("light-switch:time=" + std::to_string(frame / 12 * 0.5 + 0.01));
  };
  moving.scene = light_switch;
  moving.camera = [](int) { return flat_camera(1); };
  constexpr int frames = 40;
  const LinearImage reference = last_frame({moving.scene, moving.camera}, "converged:samples=64", frames);
  const double error = rms(last_frame(moving, "taa", frames), reference);
  EXPECT_LE(error, rms(last_frame(moving, "taa:rest=test", frames), reference));
}

// Catmull-Rom's history falls below both colours at the edges of what moves.
TEST(Taa, ADarkObjectHasNoBlackEdge) {
  MovingScene moving = square_before_wall([](int i) {
    return float2{1.3f * static_cast<float>(i), 0.7f * static_cast<float>(i)};
  });
  const auto bright = moving.scene;
  moving.scene = [bright](int i) {
    Scene scene = bright(i);
    scene.materials[0].base_color = {0.8f, 0.8f, 0.8f, 1}, scene.materials[1].base_color = {0.1f, 0.1f, 0.1f, 1};
    return scene;
  };
  for (const LinearImage& image : film(moving, "taa", 8))
    for (const Linear& c : image.values()) ASSERT_GE(c.g, 0.0999f);
}

// A box in Y, Co and Cg has corners with less of a channel than any of the nine colours.
TEST(Taa, HistoryHasNoMoreAndNoLessOfAChannelThanNineSamples) {
  MovingScene moving = still(*make_builtin_scene("moving-texture"));
  moving.camera = [camera = moving.camera(0)](int i) {
    Camera moved = camera;
    moved.world_from_camera = camera.world_from_camera * translation(float3{0.013f * static_cast<float>(i), 0, 0});
    return moved;
  };
  constexpr int frames = 12;
  const std::vector<LinearImage> images = film(moving, "taa", frames),
                                 samples = film(moving, "taa:blend=fixed,alpha=1,rectify=none,rest=test", frames);
  constexpr int border = 8;  // beyond which the history has no surface
  for (std::size_t f = 1; f < frames; ++f)
    for (int y = border; y < moving.height - border; ++y)
      for (int x = border; x < moving.width - border; ++x)
        for (const auto channel : {&Linear::r, &Linear::g, &Linear::b}) {
          float low = 1e9f, high = -1e9f;
          for (int k = 0; k < 9; ++k) {
            const float near = samples[f](x + k % 3 - 1, y + k / 3 - 1).*channel;
            low = std::min(low, near), high = std::max(high, near);
          }
          ASSERT_GE(images[f](x, y).*channel, low - 1e-5f) << f << ": " << x << ", " << y;
          ASSERT_LE(images[f](x, y).*channel, high + 1e-5f) << f << ": " << x << ", " << y;
        }
}

TEST(Taa, NewPixelsMayBeSmoothedBySmaa) {
  const MovingScene moving = still(*make_builtin_scene("thin-diagonal"));
  const auto frames = [&](const std::string& method) {
    const PreparedScene prepared(moving.scene(0));
    Renderer renderer(prepared, make_resolver(methods(), method));
    RenderSettings settings = moving.settings();
    settings.form = ImageForm::Display16;
    std::vector<Plane<Rgba16>> out;
    for (int i = 0; i < 4; ++i) out.push_back(renderer.render(moving.camera(i), settings).display16);
    return out;
  };
  const auto error = [](const Plane<Rgba16>& a, const Plane<Rgba16>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.values().size(); ++i) {
      const int difference = int{a.values()[i].g} - int{b.values()[i].g};
      sum += static_cast<double>(difference) * difference;
    }
    return std::sqrt(sum);
  };
  const auto samples = frames("taa"), reference = frames("converged:samples=64");
  for (const std::string method : {"taa:new=smaa", "taa:new=smaa-exact"}) {
    const auto smoothed = frames(method);
    EXPECT_LT(error(smoothed[0], reference[0]), 0.8 * error(samples[0], reference[0]));
    EXPECT_LT(error(smoothed[1], reference[0]), error(samples[1], reference[0]));
    EXPECT_TRUE(std::ranges::equal(smoothed[3].values(), samples[3].values()));
    EXPECT_THROW(frames(method + ",blend=fixed"), Error);
  }
}

// A wall that fills the image, seen by a camera that moves by fractions of a pixel.
TEST(Taa, AConstantColourIsAFixedPoint) {
  MovingScene wall = square_before_wall([](int) { return float2{0, 0}; });
  const auto scene = wall.scene;
  wall.scene = [scene](int i) {
    Scene out = scene(i);
    out.instances.resize(1);
    return out;
  };
  wall.camera = [](int i) {
    Camera camera = flat_camera(1);
    camera.world_from_camera = translation(float3{0.011f * static_cast<float>(i), 0.007f * static_cast<float>(i), 1});
    return camera;
  };
  for (const char* preset : taa_presets)
    for (const char* more : {"", ",range=compressed", ",weigh=luma", ",history=catmull5", ",space=rgb,rectify=clamp"}) {
      const std::vector<LinearImage> images = film(wall, of_preset(preset) + more, 9);
      for (const LinearImage& image : images)
        for (const Linear& c : image.values()) ASSERT_EQ(c, images[0](0, 0)) << preset << more;
      EXPECT_EQ(images[0](0, 0).g, 0.3f);
    }
}

TEST(Taa, APanByWholePixelsKeepsTheBits) {
  MovingScene resting = still(*make_builtin_scene("text-ui"));
  resting.camera = [](int) { return flat_camera(1); };
  MovingScene panning = resting;
  constexpr int frames = 8, border = 3;
  // 1/32 unit is a pixel; the last frame is at the same place.
  panning.camera = [](int i) {
    Camera camera = flat_camera(1);
    camera.world_from_camera =
        translation(float3{static_cast<float>(i - frames + 1) / 32, 0, 0}) * camera.world_from_camera;
    return camera;
  };
  for (const char* method : {"taa", "taa:preset=karis", "taa:preset=playcanvas", "taa:preset=bevy"}) {
    const LinearImage still_image = last_frame(resting, method, frames), panned = last_frame(panning, method, frames);
    int differing = 0;
    // Columns that entered the image on the right have less history.
    for (int y = border; y < resting.height - border; ++y)
      for (int x = border; x < resting.width - border - frames; ++x) differing += still_image(x, y) != panned(x, y);
    EXPECT_EQ(differing, 0) << method;
  }
}

/// The error of the pixels that a teleported square has left, relative to that of keeping its image.
double ghost_energy(const std::string& method, int frames_after) {
  constexpr int before = 20;
  const MovingScene moving = square_before_wall([](int i) { return i < before ? float2{-28, 4} : float2{25, -3}; });
  const std::vector<LinearImage> images = film(moving, method, before + frames_after);
  const Linear wall{0.25f, 0.3f, 0.2f, 1};
  double left = 0, kept = 0;
  for (int y = 0; y < moving.height; ++y)
    for (int x = 0; x < 45; ++x) {
      left += std::abs(images.back()(x, y).r - wall.r);
      kept += std::abs(images[before - 1](x, y).r - wall.r);
    }
  EXPECT_GT(kept, 100);
  return left / kept;
}

TEST(Taa, TestsOfIdOrDepthLeaveNoGhost) {
  for (const char* test : {"id", "depth", "both"}) {
    EXPECT_LE(ghost_energy(std::string("taa:reject=") + test, 1), 0.01) << test;
    // The pixels beside the square accept history of the wall, into which their antialiased edge has mixed the square.
    EXPECT_LE(ghost_energy(std::string("taa:rectify=none,reject=") + test, 1), 0.2) << test;
  }
  EXPECT_GT(ghost_energy("taa:rectify=none,reject=none,blend=fixed,alpha=0.1", 1), 0.85);
  EXPECT_LE(ghost_energy("taa:reject=none", 1), 0.01);
}

/// A row of waves that moves by `velocity` pixels per frame, accumulated with a tenth of the current frame: the
/// amplitude of wave k of 128 pixels, relative to its own.
std::vector<double> transfer(const std::string& filter, double velocity) {
  constexpr int width = 768, window = 128, frames = 96;
  TemporalAccumulation accumulation(temporal_options(
      Settings("method", temporal_params(),
               "taa:rectify=none,reject=none,dilate=none,jitter=none,blend=fixed,alpha=0.1,history=" + filter)));
  LinearImage result;
  for (int i = 0; i < frames; ++i) {
    FrameContext context;
    context.index = i, context.is_first = i == 0;
    accumulation.request(context);
    Frame frame;
    frame.color = LinearImage(width, 1);
    for (int x = 0; x < width; ++x) {
      double sum = 0.5;
      for (int k = 1; k <= window / 2; ++k)
        sum += std::cos(2 * std::numbers::pi * k * (x - velocity * i) / window + k * k * 0.7) / 200;
      frame.color(x, 0) = Linear{1, 1, 1, 1} * static_cast<float>(sum);
    }
    frame.reversed_depth = frame.depth = Plane<float>(width, 1, 0.5f);
    frame.object_id = Plane<std::uint32_t>(width, 1, 7u);
    frame.motion = Plane<float2>(width, 1, float2{static_cast<float>(velocity), 0});
    result = accumulation.resolve(frame);
  }
  std::vector<double> out;
  for (int k = 1; k < window / 2; ++k) {
    std::complex<double> sum = 0;
    for (int x = 0; x < window; ++x)
      sum += double{result(width / 2 - window / 2 + x, 0).g} * std::polar(1.0, -2 * std::numbers::pi * k * x / window);
    out.push_back(2 * std::abs(sum) / window * 200);
  }
  return out;
}

/// The frequency, in waves per pixel, at which a transfer function falls to a half; ½ if it does not.
double half_frequency(const std::vector<double>& transfer) {
  for (std::size_t k = 1; k < transfer.size(); ++k)
    if (transfer[k] < 0.5) {
      const double part = (transfer[k - 1] - 0.5) / (transfer[k - 1] - transfer[k]);
      return (static_cast<double>(k) + part) / 128;
    }
  return 0.5;
}

std::vector<double> theory(bool is_cubic, double velocity) {
  const double f = 1 - (velocity - std::floor(velocity));
  double weights[4] = {0, 1 - f, f, 0};
  if (is_cubic) {
    weights[0] = -0.5 * f + f * f - 0.5 * f * f * f, weights[1] = 1 - 2.5 * f * f + 1.5 * f * f * f;
    weights[2] = 0.5 * f + 2 * f * f - 1.5 * f * f * f, weights[3] = -0.5 * f * f + 0.5 * f * f * f;
  }
  std::vector<double> out;
  for (int k = 1; k < 64; ++k) {
    const double w = 2 * std::numbers::pi * k / 128;
    std::complex<double> h = 0;
    for (int j = 0; j < 4; ++j) h += weights[j] * std::polar(1.0, w * (j - 1 - f));
    out.push_back(std::abs(0.1 / (1.0 - 0.9 * h)));
  }
  return out;
}

TEST(Taa, HistoryBlursAsItsFilterPredicts) {
  double cubic_at_half = 0, linear_at_half = 0;
  for (int sixteenths = 1; sixteenths <= 16; ++sixteenths) {
    const double velocity = sixteenths / 16.0;
    for (const bool is_cubic : {false, true}) {
      const double measured = half_frequency(transfer(is_cubic ? "catmull9" : "bilinear", velocity));
      EXPECT_NEAR(measured / half_frequency(theory(is_cubic, velocity)), 1, 0.02) << sixteenths << ' ' << is_cubic;
      if (sixteenths == 8) (is_cubic ? cubic_at_half : linear_at_half) = measured;
    }
  }
  EXPECT_GE(cubic_at_half, 1.5 * linear_at_half);
}

// 64 frames of a scene at rest, with the period of 16 samples, against 16 samples of one frame.
TEST(Taa, AStillSceneConverges) {
  for (const char* name : {"wires", "checkerboard", "text-ui", "foliage"}) {
    const MovingScene moving = still(*make_builtin_scene(name));
    const LinearImage reference = last_frame(moving, "converged:samples=256", 1);
    const double sampled = rms(last_frame(moving, "ssaa:pattern=halton,samples=16", 1), reference);
    const double accumulated = rms(last_frame(moving, "taa", 64), reference);
    ASSERT_GT(sampled, 0.005);
    EXPECT_LE(accumulated, 1.35 * sampled) << name << ' ' << accumulated / sampled;
  }
}

TEST(Taa, AStillImageIsThatOfASettledSequence) {
  const Scene scene = *make_builtin_scene("wires");
  const MovingScene moving = still(scene);
  Renderer renderer(PreparedScene(scene), make_resolver(methods(), "taa:frames=5"));
  const RenderedImage image = renderer.render_still(scene.cameras[0], moving.settings());
  EXPECT_EQ(image.linear, last_frame(moving, "taa:frames=5", 5));
  EXPECT_NE(image.linear, last_frame(moving, "taa:frames=5", 1));
  // A second still image begins anew.
  EXPECT_EQ(renderer.render_still(scene.cameras[0], moving.settings()).linear, image.linear);
}

TEST(Taa, MotionBlurIsRefused) {
  const Scene scene = *make_builtin_scene("cyclic");
  const PreparedScene prepared(scene);
  Renderer renderer(prepared, make_resolver(methods(), "taa"));
  EXPECT_THROW(renderer.render_mean(2,
                                    [&](int) {
                                      return SceneView{prepared, scene.cameras[0]};
                                    },
                                    {.options = {.width = 16, .height = 16}}),
               Error);
}

}  // namespace
}  // namespace zoneplate::antialias
