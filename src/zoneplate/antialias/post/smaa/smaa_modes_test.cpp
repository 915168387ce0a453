// SPDX-License-Identifier: Apache-2.0
// SMAA with several samples per pixel, in one frame (S2x), over two (T2x), or both (4x).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/smaa/smaa.h"
#include "zoneplate/antialias/temporal/sequences_for_test.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/sdf/field/field_image.h"

namespace zoneplate::antialias {
namespace {

constexpr int side = 48;

/// A white half-plane before black; its edge has a direction, and a distance from the image's centre in pixels.
MovingScene half_plane(double degrees, double offset) {
  MovingScene moving;
  moving.width = moving.height = side;
  moving.scene = [=](int) {
    const double angle = degrees * std::numbers::pi / 180, dx = std::cos(angle), dy = std::sin(angle), far = 6;
    const auto at = [&](double along, double across) {
      const double a = across + offset * 2 / side;
      return float3{static_cast<float>(along * dx - a * dy), static_cast<float>(along * dy + a * dx), -1};
    };
    Mesh black, white;
    add_quad(black, {{-9, -9, -2}, {9, -9, -2}, {9, 9, -2}, {-9, 9, -2}});
    add_quad(white, {at(-far, -far), at(far, -far), at(far, 0), at(-far, 0)});
    Scene scene;
    add_part(scene, unlit("black", {0, 0, 0}), std::move(black));
    add_part(scene, unlit("white", {1, 1, 1}), std::move(white));
    return scene;
  };
  moving.camera = [](int) { return flat_camera(1); };
  return moving;
}

RenderSettings display_settings(const MovingScene& moving) {
  RenderSettings settings = moving.settings();
  settings.form = ImageForm::Display8;
  return settings;
}

Rgba8Image settled(const MovingScene& moving, const std::string& method) {
  Renderer renderer(PreparedScene(moving.scene(0)), make_resolver(methods(), method));
  return renderer.render_still(moving.camera(0), display_settings(moving)).display;
}

/// The root mean square error of coverage, away from the image's sides.
double coverage_error(const Rgba8Image& image, const LinearImage& exact) {
  constexpr int border = 12;
  double sum = 0;
  for (int y = border; y < side - border; ++y)
    for (int x = border; x < side - border; ++x) {
      const double d = static_cast<double>(decode_srgb8(image(x, y).g)) - static_cast<double>(exact(x, y).g);
      sum += d * d;
    }
  return std::sqrt(sum) / (side - 2 * border);
}

/// A straight edge through the middle of an image, white on one side and black on the other.
struct StraightEdge {
  static constexpr int size = 72;
  double x, y, distance;  ///< white where x (u - size / 2) + y (v - size / 2) < distance; (x, y) has length 1

  LinearImage sampled(SamplePosition at) const {
    LinearImage image(size, size, Linear{0, 0, 0, 1});
    const double u = at.x / 256.0 - size / 2.0, v = at.y / 256.0 - size / 2.0;
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i)
        if (x * (i + u) + y * (j + v) < distance) image(i, j) = {1, 1, 1, 1};
    return image;
  }
  /// The root mean square error of coverage in the pixels of the edge, far from the image's sides.
  template <class Light>
  double error(const Light& light) const {
    constexpr int border = 28;
    double sum = 0;
    int count = 0;
    for (int j = border; j < size - border; ++j)
      for (int i = border; i < size - border; ++i) {
        const double d = distance - x * (i + 0.5 - size / 2.0) - y * (j + 0.5 - size / 2.0);
        const double covered = sdf::half_plane_area(x, y, d), off = light(i, j) - covered;
        sum += off * off, count += covered > 0 && covered < 1;
      }
    return std::sqrt(sum / count);
  }
};

/// What a method makes of the edge at rest: its last image of as many frames as it needs.
Rgba8Image settled(const StraightEdge& edge, const std::string& method) {
  const std::unique_ptr<Resolver> resolver = make_resolver(methods(), method);
  DisplayImage image;
  for (int index = 0, frames = 1; index < frames; ++index) {
    const Request request = resolver->request({.index = index, .is_first = index == 0});
    Frame frame;
    frames = request.settling_frames;
    for (const SamplePosition sample : request.samples) frame.sample_color.push_back(edge.sampled(sample));
    frame.sample_depth.assign(request.samples.size(), Plane<float>(StraightEdge::size, StraightEdge::size));
    frame.motion = Plane<float2>(StraightEdge::size, StraightEdge::size);
    image = resolver->post_process(make_display(frame.sample_color[0], {}), frame);
  }
  return quantize8(image);
}

/// Edges in every direction, at all distances from the pixels' centres.
std::vector<StraightEdge> straight_edges() {
  constexpr int count = 144;
  std::vector<StraightEdge> edges;
  for (int i = 0; i < count; ++i) {
    const double angle = (i + 0.137) * std::numbers::pi / count, distance = 0.03 + 0.618034 * i;
    edges.push_back({-std::sin(angle), std::cos(angle), distance - std::floor(distance)});
  }
  return edges;
}

TEST(SmaaModes, MoreSamplesHaveLessError) {
  const std::vector<StraightEdge> edges = straight_edges();
  // The test's report has each mean, and those of edges up to 15, 30 and 45 degrees off the nearest axis.
  const auto mean = [&](const std::string& name, const auto& error_of) {
    double sums[3] = {}, all = 0;
    for (const StraightEdge& edge : edges) {
      const double slope = std::min(std::abs(edge.x), std::abs(edge.y)), error = error_of(edge);
      sums[slope < std::sin(std::numbers::pi / 12) ? 0 : slope < 0.5 ? 1 : 2] += error, all += error;
    }
    const double count = static_cast<double>(edges.size());
    RecordProperty(name, fmt::format("{:.4f}: {:.4f} {:.4f} {:.4f}", all / count, sums[0] * 3 / count,
                                     sums[1] * 3 / count, sums[2] * 3 / count));
    return all / count;
  };
  const auto error = [&](const std::string& method) {
    return mean(method, [&](const StraightEdge& edge) {
      const Rgba8Image image = settled(edge, method);
      return edge.error([&](int x, int y) { return static_cast<double>(decode_srgb8(image(x, y).g)); });
    });
  };
  const double eight = mean("msaa:n=8", [&](const StraightEdge& edge) {
    std::vector<LinearImage> images;
    for (const SamplePosition sample : standard_pattern(8)) images.push_back(edge.sampled(sample));
    return edge.error([&](int x, int y) {
      return static_cast<double>(std::ranges::count_if(images, [&](const auto& i) { return i(x, y).g > 0.5f; })) / 8;
    });
  });

  const double one = error("smaa"), two = error("smaa:mode=s2x");
  const double four = error("smaa:mode=4x");
  EXPECT_LT(one, 0.3 * error("none"));
  EXPECT_LT(two, 0.9 * one);
  EXPECT_LT(four, 0.85 * two);
  EXPECT_LT(four, 1.1 * eight);

  const double exact_one = error("smaa-exact"), exact_two = error("smaa-exact:mode=s2x");
  const double exact_four = error("smaa-exact:mode=4x");
  EXPECT_LT(exact_one, one);
  EXPECT_LT(exact_two, 0.75 * exact_one);
  EXPECT_LT(exact_four, 0.75 * exact_two);
  EXPECT_LT(exact_two, 0.8 * two);
  EXPECT_LT(exact_four, 0.75 * four);
  EXPECT_LT(exact_four, 0.6 * eight);
}

// Over frames a scene at rest is the mean of both of them, which are those of S2x.
TEST(SmaaModes, ASceneAtRestDoesNotFlicker) {
  const MovingScene moving = half_plane(11.3, 0.3);
  for (const char* method : {"smaa:mode=t2x", "smaa:mode=4x", "smaa-exact:mode=t2x", "smaa-exact:mode=4x"}) {
    Renderer renderer(PreparedScene(moving.scene(0)), make_resolver(methods(), method));
    std::vector<Rgba8Image> images;
    for (int i = 0; i < 6; ++i) images.push_back(renderer.render(moving.camera(0), display_settings(moving)).display);
    EXPECT_NE(images[0], images[1]) << method;
    for (std::size_t i = 2; i < images.size(); ++i)
      for (std::size_t p = 0; p < images[i].values().size(); ++p)
        ASSERT_LE(std::abs(images[i].values()[p].g - images[1].values()[p].g), 1) << method;
  }
  EXPECT_EQ(settled(moving, "smaa:mode=t2x"), settled(moving, "smaa:mode=s2x"));
  EXPECT_EQ(settled(moving, "smaa-exact:mode=t2x"), settled(moving, "smaa-exact:mode=s2x"));
}

// The areas for the other sample make the error of a half-plane greater.
TEST(SmaaModes, ExchangedSamplesAndAreasAreWrong) {
  constexpr std::array<int, 4> slots[] = {{1, 1, 1, 0}, {2, 2, 2, 0}};
  const auto error = [&](bool is_exact, bool is_exchanged) {
    double sum = 0;
    for (const double degrees : {5.7, 11.3, 18.4, 41.0, 128.0})
      for (const double offset : {0.03, 0.28, 0.53, 0.78}) {
        const MovingScene moving = half_plane(degrees, offset);
        LinearImage mean(side, side, Linear{0, 0, 0, 1});
        const SamplePattern samples = standard_pattern(2);
        for (std::size_t s = 0; s < 2; ++s) {
          const Request request{.samples = {samples[s]}};
          const Frame frame =
              render(PreparedScene(moving.scene(0)), moving.camera(0), request, moving.settings().options);
          const std::size_t taken = is_exchanged ? 1 - s : s;
          SmaaOptions options;
          options.slots = slots[taken];
          if (is_exact) options.exact_offset = offset_from_centre(samples[taken]);
          const Rgba8Image image = apply_smaa(quantize8(make_display(frame.color, {})), nullptr, options);
          for (std::size_t p = 0; p < mean.values().size(); ++p)
            mean.values()[p].g += 0.5f * decode_srgb8(image.values()[p].g);
        }
        sum += coverage_error(quantize8(make_display(mean, {})), last_frame(moving, "analytic", 1));
      }
    return sum;
  };
  EXPECT_LT(error(false, false), 0.8 * error(false, true));
  EXPECT_LT(error(true, false), 0.4 * error(true, true));
}

// No slot of the tables is for the samples of a pattern of eight. Areas for samples a sixteenth of a pixel beside them
// have a greater error.
TEST(SmaaModes, ExactAreasAreThoseOfEverySample) {
  const SamplePattern samples = standard_pattern(8);
  struct Sampled {
    std::vector<Rgba8Image> images;
    LinearImage coverage;
  };
  std::vector<Sampled> planes;
  for (int i = 0; i < 18; ++i) {
    const MovingScene moving = half_plane(10 * i + 2.637, 0.618034 * i - std::floor(0.618034 * i));
    Sampled sampled{{}, last_frame(moving, "analytic", 1)};
    for (const SamplePosition sample : samples) {
      const Frame frame = render(PreparedScene(moving.scene(0)), moving.camera(0), Request{.samples = {sample}},
                                 moving.settings().options);
      sampled.images.push_back(quantize8(make_display(frame.color, {})));
    }
    planes.push_back(std::move(sampled));
  }
  const auto error = [&](float2 displaced) {
    double sum = 0;
    for (const Sampled& plane : planes) {
      LinearImage mean(side, side, Linear{0, 0, 0, 1});
      for (std::size_t s = 0; s < samples.size(); ++s) {
        const float2 at = offset_from_centre(samples[s]);
        SmaaOptions options;
        options.exact_offset = float2{at.x + displaced.x, at.y + displaced.y};
        const Rgba8Image image = apply_smaa(plane.images[s], nullptr, options);
        for (std::size_t p = 0; p < mean.values().size(); ++p)
          mean.values()[p].g += 0.125f * decode_srgb8(image.values()[p].g);
      }
      sum += coverage_error(quantize8(make_display(mean, {})), plane.coverage);
    }
    return sum;
  };
  const double exact = error({0, 0});
  for (const float2 displaced : {float2{0.0625f, 0}, float2{-0.0625f, 0}, float2{0, 0.0625f}, float2{0, -0.0625f}})
    EXPECT_GT(error(displaced), 1.1 * exact);
}

TEST(SmaaModes, InstructionSetsAndThreadsLeaveNoTraceInExactAreas) {
  const Rgba8Image image = random_shapes(203, 77, 2);
  SmaaOptions options;
  options.exact_offset = float2{0.1875f, -0.3125f};
  const Rgba8Image expected = with_isa(Isa::Scalar, [&] { return apply_smaa(image, nullptr, options); });
  EXPECT_GT(count_differing(expected, apply_smaa(image, nullptr, {}), 1), 1000);
  for (const Isa isa : supported_isas())
    for (const int threads : {1, 2, 7})
      with_isa(isa, [&] {
        with_threads(threads,
                     [&] { EXPECT_EQ(apply_smaa(image, nullptr, options), expected) << name_of(isa) << threads; });
      });
}

// A ghost lasts for one frame.
TEST(SmaaModes, HistoryIsThatOfOneFrame) {
  const MovingScene moving = square_before_wall([](int i) { return i < 4 ? float2{-28, 4} : float2{25, -3}; });
  for (const char* method : {"smaa:mode=t2x", "smaa:mode=4x"}) {
    PreparedScene prepared(moving.scene(0));
    Renderer renderer(prepared, make_resolver(methods(), method));
    std::vector<Rgba8Image> images;
    for (int i = 0; i < 6; ++i) {
      if (i > 0) renderer.set_scene(PreparedScene(moving.scene(i), prepared));
      images.push_back(renderer.render(moving.camera(i), display_settings(moving)).display);
    }
    const Rgba8 wall = images[5](90, 60);
    int ghosts = 0;
    for (int y = 0; y < moving.height; ++y)
      for (int x = 0; x < 45; ++x) ghosts += std::abs(images[5](x, y).g - wall.g) > 1;
    EXPECT_EQ(ghosts, 0) << method;
  }
}

// Nothing moves in a first frame, but what has moved in the second one has left its place, with its outline.
TEST(SmaaModes, TheSecondFrameHasNoGhost) {
  constexpr float step_x = 12.3f, step_y = -5.6f;  // pixels per frame
  const MovingScene moving = square_before_wall([](int i) {
    return float2{step_x * static_cast<float>(i), step_y * static_cast<float>(i)};
  });
  for (const char* method : {"smaa:mode=t2x", "smaa:mode=4x"}) {
    PreparedScene prepared(moving.scene(0));
    Renderer renderer(prepared, make_resolver(methods(), method));
    renderer.render(moving.camera(0), display_settings(moving));
    renderer.set_scene(PreparedScene(moving.scene(1), prepared));
    const Rgba8Image image = renderer.render(moving.camera(1), display_settings(moving)).display;
    const Rgba8 wall = image(90, 60);
    const int left = moving.width / 2 - 10, top = moving.height / 2 - 10;  // of the square in the first frame
    for (int y = top - 2; y < top + 22; ++y)
      for (int x = left - 2; x < left + 11; ++x)
        ASSERT_LE(std::abs(image(x, y).g - wall.g), 1) << method << x << ' ' << y;
  }
}

}  // namespace
}  // namespace zoneplate::antialias
