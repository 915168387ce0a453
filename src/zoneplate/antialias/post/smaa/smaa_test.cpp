// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/smaa/smaa.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/antialias/methods.h"
#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/smaa/edge_detection.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {
namespace {

using Edges = SmaaOptions::Edges;

/// Hashes of another implementation's results for the chart: edges and image of red, green and blue, weights of all
/// channels.
struct Passes {
  std::uint64_t edges, weights, picture;
};

/// The presets, whether corners are detected, and the passes for edges by luma and by colour.
///
/// Source: postprocessing 6.39 for three.js, whose shaders are those of SMAA 2.8, run in headless Chromium.
struct Case {
  const char* name;
  double threshold;
  int steps, diagonal_steps;
  bool has_corners;
  Passes luma, color;
};
constexpr Case runs[] = {
    {"LOW",
     0.15,
     4,
     0,
     false,
     {0x889badcb2c514053u, 0x70fa48428560f10eu, 0x5e0c1e87cd657001u},
     {0x1d079edd96901197u, 0xeb078aba9a220616u, 0x4158983a0c0eccd2u}},
    {"MEDIUM",
     0.1,
     8,
     0,
     false,
     {0x889badcb2c514053u, 0xf685f3db3fa473f1u, 0xd4e9064fbe1e7850u},
     {0x1d079edd96901197u, 0x2a604f3e9a4d7d9du, 0x36148fd88f1c219fu}},
    {"HIGH",
     0.1,
     16,
     8,
     false,
     {0x889badcb2c514053u, 0xc5c284e48dff37b3u, 0x6283553a97e615d4u},
     {0x1d079edd96901197u, 0xca8cf7e22032c247u, 0xd1e64dd9ed10d2acu}},
    {"HIGH",
     0.1,
     16,
     8,
     true,
     {0x889badcb2c514053u, 0xa7602797d8e8bc85u, 0x16a0025d7c13c195u},
     {0x1d079edd96901197u, 0x9ce8016aaa8e971fu, 0x5d8823adbf88bd90u}},
    {"ULTRA",
     0.05,
     32,
     16,
     false,
     {0xaab78336147e11bfu, 0xe6a5b4c8555e0dfeu, 0xf9eb55561a62ac7u},
     {0x1d079edd96901197u, 0x7bd798ce89dd0489u, 0x96f129ef66902881u}},
    {"ULTRA",
     0.05,
     32,
     16,
     true,
     {0xaab78336147e11bfu, 0xa21eb6dd20137f7fu, 0xc7920904ed564344u},
     {0x1d079edd96901197u, 0x8016f31709c539cdu, 0x346de6a86a3788e2u}},
};

SmaaOptions options_of(const Case& run, Edges edges) {
  return {.edges = edges,
          .threshold = run.threshold,
          .steps = run.steps,
          .diagonal_steps = run.diagonal_steps,
          .corner_rounding = run.has_corners ? 25 : 100,
          .mixes_light = false,
          .is_postprocessing = true};
}

Rgba8Image shown(const EdgePlane& edges) {
  return make_codes(edges.width(), edges.height(), [&](int x, int y) {
    const auto code = [&](int edge) { return static_cast<std::uint8_t>(*edges.at(x, y) & edge ? 255 : 0); };
    return Rgba8{code(left_edge), code(top_edge), 0, 255};
  });
}

Rgba8Image shown_weights(const EdgePlane& edges, const SmaaOptions& options) {
  const SmaaBlendingWeights weigher(edges, options);
  WeightRow row(edges.width());
  return make_codes(edges.width(), edges.height(), [&](int x, int y) {
    if (x == 0) row.clear(), weigher.find(y, row);
    return Rgba8{row[x].from_above, row[x].to_above, row[x].from_left, row[x].to_left};
  });
}

TEST(Smaa, EveryPassEqualsAnotherImplementation) {
  const Rgba8Image chart = chart64();
  for (const Case& run : runs)
    for (const auto& [edges, passes] : {std::pair{Edges::Luma, run.luma}, {Edges::Color, run.color}}) {
      const SmaaOptions options = options_of(run, edges);
      const EdgePlane found = smaa_edge_detection(chart, nullptr, options);
      EXPECT_EQ(hash_of_colors(shown(found)), passes.edges) << run.name;
      EXPECT_EQ(hash_of(shown_weights(found, options)), passes.weights) << run.name;
      EXPECT_EQ(hash_of_colors(apply_smaa(chart, nullptr, options)), passes.picture) << run.name;
    }
}

TEST(Smaa, OutputsHaveTheirBits) {
  const Rgba8Image image = random_shapes(200, 150, 1);
  const auto hash = [&](const SmaaOptions& o) { return hash_of(apply_smaa(image, nullptr, o)); };
  EXPECT_EQ(hash({.edges = Edges::Luma}), 0x41b66e60dacd2029u);
  EXPECT_EQ(hash({.edges = Edges::Color}), 0x37ea59af564d9346u);
  EXPECT_EQ(hash({.threshold = 0.15, .steps = 4, .diagonal_steps = 0, .corner_rounding = 100}), 0x44d2c6cffef1a9fau);
  EXPECT_EQ(hash({.threshold = 0.05, .steps = 32, .diagonal_steps = 16}), 0xca556196d0ef9648u);
  EXPECT_EQ(hash({.slots = {1, 1, 1, 0}}), 0xd95b6c422f7c91e9u);
  EXPECT_EQ(hash({.steps = 112, .diagonal_steps = 20, .mixes_light = false}), 0xc81311afcfdf17a6u);
}

TEST(Smaa, MixCodesBlendsEncodedValues) {
  const Rgba8Image image = random_shapes(60, 40, 1);
  DisplayImage display(60, 40);
  std::ranges::transform(image.values(), display.values().begin(), [](Rgba8 c) {
    return Display{unorm8_value[c.r], unorm8_value[c.g], unorm8_value[c.b], unorm8_value[c.a]};
  });
  const auto filtered = [&](const char* method) {
    return quantize8(make_resolver(methods(), method)->post_process(display, Frame()));
  };
  EXPECT_EQ(filtered("smaa:mix=codes"), apply_smaa(image, nullptr, {.mixes_light = false}));
  EXPECT_EQ(filtered("smaa:mix=light"), apply_smaa(image, nullptr, {}));
  EXPECT_EQ(filtered("smaa"), filtered("smaa:mix=light"));
  EXPECT_NE(filtered("smaa"), filtered("smaa:mix=codes"));

  // S2x: the mean of a black and a white sample.
  Frame frame;
  frame.sample_color = {LinearImage(4, 4, {0, 0, 0, 1}), LinearImage(4, 4, {1, 1, 1, 1})};
  frame.sample_depth = {Plane<float>(4, 4), Plane<float>(4, 4)};
  const auto mean = [&](const char* method) {
    return make_resolver(methods(), method)->post_process(DisplayImage(4, 4), frame)(2, 2).g;
  };
  EXPECT_EQ(mean("smaa:mode=s2x,mix=codes"), 0.5f);
  EXPECT_NEAR(mean("smaa:mode=s2x"), encode_srgb(0.5f), 1e-6);
}

/// An image with a texture of small contrast, and a predication buffer with steps, slopes and infinities.
struct Predicated {
  Rgba8Image image = random_shapes(203, 77, 3);
  Plane<float> buffer{203, 77};

  Predicated() {
    for (std::uint32_t i = 0; Rgba8 & c : image.values()) {
      const std::uint32_t noise = hash(i++);
      const auto faint = [&](std::uint8_t v, int shift) {
        return static_cast<std::uint8_t>(v / 4 + (noise >> shift & 63));
      };
      c = {faint(c.r, 0), faint(c.g, 8), faint(c.b, 16)};
    }
    for (int y = 0; y < 77; ++y)
      for (int x = 0; x < 203; ++x) {
        const bool is_far = (x - 100) * (x - 100) + 4 * (y - 40) * (y - 40) > 5000;
        const float step = static_cast<float>(hash(static_cast<std::uint32_t>(x / 5 + 100 * (y / 3))) & 3) * 0.006f;
        buffer(x, y) = is_far ? std::numeric_limits<float>::infinity() : step + 0.0002f * static_cast<float>(x);
      }
  }
};

/// SMAALumaEdgeDetectionPS and SMAAColorEdgeDetectionPS of SMAA.hlsl v2.8 with SMAA_PREDICATION, ported for one pixel:
/// its left and top edges.
class ShaderEdges {
 public:
  ShaderEdges(const Predicated& scene, const SmaaOptions& options) : scene_(scene), options_(options) {}

  int edges(int x, int y) const {
    // SMAACalculatePredicatedThreshold.
    const auto threshold = [&](int i, int j) {
      const float delta = std::abs(predicate(x, y) - predicate(i, j));
      const double edge = delta >= static_cast<float>(options_.predication_threshold) ? 1 : 0;
      return options_.predication_scale * options_.threshold * (1 - options_.predication_strength * edge);
    };
    const double left = difference(x, y, x - 1, y), top = difference(x, y, x, y - 1);
    const bool is_left = reaches(left, threshold(x - 1, y)), is_top = reaches(top, threshold(x, y - 1));
    const bool is_luma = options_.edges == Edges::Luma;
    const double right = difference(x, y, x + 1, y), bottom = difference(x, y, x, y + 1);
    const double far_left = is_luma ? difference(x - 1, y, x - 2, y) : difference(x, y, x - 2, y);
    const double far_top = is_luma ? difference(x, y - 1, x, y - 2) : difference(x, y, x, y - 2);
    const double greatest = std::max({left, top, right, bottom, far_left, far_top});
    return (is_left && reaches(2 * left, greatest) ? left_edge : 0) |
           (is_top && reaches(2 * top, greatest) ? top_edge : 0);
  }

 private:
  /// Ties, which occur with integer codes, count as reached.
  static bool reaches(double value, double threshold) { return value > threshold - 1e-9; }
  static int clamped(int i, int size) { return std::clamp(i, 0, size - 1); }
  float predicate(int x, int y) const { return scene_.buffer(clamped(x, 203), clamped(y, 77)); }
  Rgba8 at(int x, int y) const { return scene_.image(clamped(x, 203), clamped(y, 77)); }
  double difference(int x, int y, int i, int j) const {
    const Rgba8 a = at(x, y), b = at(i, j);
    if (options_.edges == Edges::Color)
      return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}) / 255.0;
    const auto luma = [](Rgba8 c) { return (0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b) / 255; };
    return std::abs(luma(a) - luma(b));
  }

  const Predicated& scene_;
  const SmaaOptions& options_;
};

TEST(Smaa, PredicatedEdgesAreTheShaders) {
  const Predicated scene;
  for (const Edges edges : {Edges::Luma, Edges::Color})
    for (const double threshold : {0.05, 0.1})
      for (const double strength : {0.4, 1.0}) {
        SmaaOptions options{.edges = edges, .threshold = threshold, .is_predicated = true};
        options.predication_strength = strength;
        const EdgePlane found = smaa_edge_detection(scene.image, &scene.buffer, options);
        const ShaderEdges shader(scene, options);
        int counts[4] = {};
        for (int y = 0; y < 77; ++y)
          for (int x = 0; x < 203; ++x) {
            ASSERT_EQ(*found.at(x, y), shader.edges(x, y)) << x << "," << y;
            ++counts[*found.at(x, y)];
          }
        for (const int count : counts) EXPECT_GT(count, 20);
      }
}

TEST(Smaa, PredicationChangesThresholdsAndNothingElse) {
  const Predicated scene;
  for (const Edges edges : {Edges::Luma, Edges::Color}) {
    const auto out = [&](double threshold, double scale, double strength, bool is_predicated = true) {
      SmaaOptions options{.edges = edges, .threshold = threshold, .is_predicated = is_predicated};
      options.predication_scale = scale, options.predication_strength = strength;
      return apply_smaa(scene.image, &scene.buffer, options);
    };
    EXPECT_EQ(out(0.1, 1, 0), out(0.1, 1, 0, false));
    EXPECT_EQ(out(0.05, 2, 0), out(0.1, 1, 0, false));
    EXPECT_NE(out(0.1, 2, 0.4), out(0.1, 1, 0, false));
    const Rgba8Image expected = out(0.1, 2, 0.4);
    for (const Isa isa : supported_isas())
      for (const int threads : {1, 3})
        with_isa(isa, [&] {
          with_threads(threads, [&] {
            const SmaaOptions options{.edges = edges, .is_predicated = true};
            EXPECT_EQ(apply_smaa(scene.image, &scene.buffer, options), expected) << name_of(isa);
          });
        });
  }
}

TEST(Smaa, PredicationByDepthLeavesTexturesAlone) {
  // Steps of 15 % of white: edges at a threshold of 0.1, texture at 0.2, an outline at 0.12.
  const int size = 40;
  DisplayImage picture(size, size);
  Frame frame;
  frame.depth = Plane<float>(size, size, 10);
  frame.object_id = Plane<std::uint32_t>(size, size, 7u);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const bool is_below = y > 8 + x / 5, is_behind = y > 24 + x / 5;
      const float v = is_behind ? 0.55f : is_below ? 0.4f : 0.55f;
      picture(x, y) = {v, v, v, 1};
      if (is_behind) frame.depth(x, y) = 10.15f, frame.object_id(x, y) = 8;
    }
  const auto treated = [&](const char* method) {
    return quantize8(make_resolver(methods(), method)->post_process(picture, frame));
  };
  const Rgba8Image before = quantize8(picture), plain = treated("smaa");
  const auto changed = [&](const Rgba8Image& after, int first, int last) {
    int count = 0;
    for (int y = first; y < last; ++y)
      for (int x = 0; x < size; ++x) count += !(after(x, y) == before(x, y));
    return count;
  };
  EXPECT_GT(changed(plain, 0, 20), 20);
  EXPECT_GT(changed(plain, 20, size), 20);
  for (const char* method :
       {"smaa:predication=depth", "smaa:predication=objects", "smaa:predication=depth,edges=color"}) {
    const Rgba8Image after = treated(method);
    EXPECT_EQ(changed(after, 0, 20), 0) << method;
    EXPECT_EQ(changed(after, 20, size), changed(plain, 20, size)) << method;
  }
  // 1.5 % are less than a threshold of 2 %.
  EXPECT_EQ(treated("smaa:predication=depth,pthreshold=0.02"), before);
  EXPECT_EQ(treated("smaa:predication=depth,pscale=1,pstrength=0"), plain);
  const auto planes_of = [](const char* method) { return make_resolver(methods(), method)->request({}).planes; };
  EXPECT_TRUE(planes_of("smaa:predication=depth").depth);
  EXPECT_TRUE(planes_of("smaa:predication=objects").object_id);
  EXPECT_FALSE(planes_of("smaa").depth);
  for (const char* wrong : {"smaa:predication=depth,edges=depth", "smaa:predication=depth,mode=s2x", "smaa:pscale=3"})
    EXPECT_THROW(make_resolver(methods(), wrong), Error) << wrong;
}

TEST(Smaa, InstructionSetsAndThreadsLeaveNoTrace) {
  const Rgba8Image image = random_shapes(203, 77, 2);
  for (const Edges edges : {Edges::Luma, Edges::Color}) {
    const Rgba8Image expected = with_isa(Isa::Scalar, [&] { return apply_smaa(image, nullptr, {.edges = edges}); });
    for (const Isa isa : supported_isas())
      for (const int threads : {1, 2, 7})
        with_isa(isa, [&] {
          with_threads(threads, [&] {
            EXPECT_EQ(apply_smaa(image, nullptr, {.edges = edges}), expected) << name_of(isa) << threads;
          });
        });
  }
}

TEST(Smaa, KernelsFindWhatTheirTwinsFind) {
  std::vector<std::uint32_t> codes(4 * 300);
  for (std::uint32_t i = 0; std::uint32_t & c : codes) c = hash(i++) & 0x3f7f3f3f;
  std::vector<float> lumas(codes.size());
  RowKernels::scalar.luma(reinterpret_cast<const std::uint8_t*>(codes.data()), lumas.data(), lumas.size());
  for (const Isa isa : supported_isas()) {
    const SmaaKernels& kernels = SmaaKernels::of(isa);
    std::vector<float> row(lumas.size());
    RowKernels::of(isa).luma(reinterpret_cast<const std::uint8_t*>(codes.data()), row.data(), row.size());
    EXPECT_EQ(row, lumas);
    const auto rows = [](const auto& v) {
      return EdgeRows<std::decay_t<decltype(v[0])>>{{&v[2], &v[302], &v[602], &v[902]}};
    };
    for (std::size_t n = 0; n <= 200; ++n) {
      std::vector<std::uint8_t> expected(n + 1, 9), found(n + 1, 9);
      SmaaKernels::scalar.luma_edges(rows(lumas), 100000, expected.data(), n);
      kernels.luma_edges(rows(lumas), 100000, found.data(), n);
      ASSERT_EQ(found, expected);
      SmaaKernels::scalar.color_edges(rows(codes), 26, expected.data(), n);
      kernels.color_edges(rows(codes), 26, found.data(), n);
      ASSERT_EQ(found, expected);
      const auto crossed = [&](std::vector<std::uint8_t>& edges) {
        for (std::size_t i = 0; i < n; ++i)
          edges[i] = static_cast<std::uint8_t>(hash(static_cast<std::uint32_t>(i)) >> 9 & 3);
      };
      crossed(expected), crossed(found);
      SmaaKernels::scalar.predicated_luma_edges(rows(lumas), {150000, 70000}, expected.data(), n);
      kernels.predicated_luma_edges(rows(lumas), {150000, 70000}, found.data(), n);
      ASSERT_EQ(found, expected);
      crossed(expected), crossed(found);
      SmaaKernels::scalar.predicated_color_edges(rows(codes), {40, 20}, expected.data(), n);
      kernels.predicated_color_edges(rows(codes), {40, 20}, found.data(), n);
      ASSERT_EQ(found, expected);
      if (n == 200) {
        EXPECT_GT(std::ranges::count(found, 3), 10);
      }
    }
  }
}

TEST(Smaa, LevelEdgesComeNearTheirArea) {
  for (const double run : {3.0, 4.5, 8.0, 13.0, 20.0, 30.0}) {
    const Band plane{run, 1000};
    const Rgba8Image image = plane.codes(0.5, 0.5);
    EXPECT_LT(plane.error(apply_smaa(image, nullptr, {})), 0.06) << run;
    EXPECT_GT(plane.error(image), 0.24) << run;
  }
}

/// The error of smaa:mode=s2x on a band; `exchanged` swaps the images of the two samples.
double error_of_s2x(const Band& band, bool exchanged) {
  const std::unique_ptr<Resolver> resolver = make_resolver(methods(), "smaa:mode=s2x");
  const Request request = resolver->request({});
  EXPECT_EQ(request.samples, standard_pattern(2));
  Frame frame;
  for (const std::size_t s : {exchanged ? 1u : 0u, exchanged ? 0u : 1u}) {
    const Rgba8Image codes = band.codes(request.samples[s].x / 256.0, request.samples[s].y / 256.0);
    LinearImage light(band.width, band.height);
    std::ranges::transform(codes.values(), light.values().begin(), [](Rgba8 c) {
      const float v = c.g > 0 ? 1.0f : 0.0f;
      return Linear{v, v, v, 1};
    });
    frame.sample_color.push_back(light);
  }
  frame.sample_depth.assign(2, Plane<float>(band.width, band.height));
  return band.error(quantize8(resolver->post_process(DisplayImage(band.width, band.height), frame)));
}

TEST(Smaa, TwoSamplesSeeThinBandsAndExchangedPlacesSpoilThem) {
  double one = 0, two = 0;
  for (const double run : {3.0, 4.5, 7.0, 11.0, 20.0}) {
    // A band of two thirds of a pixel is interrupted at one sample per pixel.
    const Band thin{run, 0.67}, plane{run, 1000};
    one += thin.error(apply_smaa(thin.codes(0.5, 0.5), nullptr, {}));
    two += error_of_s2x(thin, false);
    EXPECT_LT(error_of_s2x(plane, false), 0.09) << run;
    EXPECT_LT(error_of_s2x(plane, false), 0.8 * error_of_s2x(plane, true)) << run;
  }
  EXPECT_LT(two, 0.8 * one);
}

TEST(Smaa, TwoSamplesBeatOneWhereEdgesAreSteepAndLoseWhereTheyAreLongAndAlone) {
  // For off-centre samples the original's areas of a step are the mean of the line's and of its two halves'
  // (SmaaTables.StepsSeenFromBesideTheCentreAreHalfwayToTheirHalves), whose error cancels the gain of two samples.
  for (const double run : {2.0, 4.5, 20.0, 30.0}) {
    double one = 0, two = 0;
    for (int k = 0; k < 4; ++k) {
      const Band plane{run, 1000, 20.013 + 0.25 * k};
      one += plane.error(apply_smaa(plane.codes(0.5, 0.5), nullptr, {})) / 4, two += error_of_s2x(plane, false) / 4;
    }
    if (run < 5) {
      EXPECT_LT(two, 0.8 * one) << run;
    } else {
      EXPECT_GT(two, 1.5 * one) << run;
      EXPECT_LT(two, 0.04) << run;
    }
  }
}

TEST(Smaa, TwoSamplesAloneSeeALevelEdgeToTheHalf) {
  // No edge crosses an exactly horizontal edge, so that no search applies: its pixels are the mean of their two
  // samples.
  for (const double height : {20.1, 20.4, 20.6, 20.9}) {
    const Band level{1e12, 1000, height};
    EXPECT_NEAR(error_of_s2x(level, false),
                std::abs(level.area(80, 20) - (height < 20.25   ? 1
                                               : height < 20.75 ? 0.5
                                                                : 0)),
                5e-3);
  }
}

TEST(Smaa, TwoSamplesUseTheAreasOfTheirDiagonals) {
  // Rising edges near the diagonal, between the two samples: with the samples' own slots the result is closer to the
  // area than with one sample; with exchanged slots or without slots it is not.
  for (const double run : {1.15, 1.3}) {
    const auto depth = [&](double x, double y) { return y - (10.13 + (64 - x) / run); };
    const auto seen = [&](double u, double v) {
      return make_codes(64, 80, [&](int x, int y) {
        return depth(x + u, y + v) > 0 ? Rgba8{255, 255, 255} : Rgba8{0, 0, 0};
      });
    };
    const auto area = [&](int x, int y) {
      double inside = 0;
      for (int i = 0; i < 256; ++i) inside += depth(x + (i % 16 + 0.5) / 16, y + (i / 16 + 0.5) / 16) > 0;
      return inside / 256;
    };
    const auto error = [&](const Rgba8Image& a, const Rgba8Image& b) {
      double sum = 0;
      int count = 0;
      for (int y = 0; y < 80; ++y)
        for (int x = 12; x < 52; ++x) {
          const double expected = area(x, y);
          const double light = static_cast<double>(decode_srgb8(a(x, y).g) + decode_srgb8(b(x, y).g)) / 2;
          if (expected > 0 && expected < 1) sum += (light - expected) * (light - expected), ++count;
        }
      return std::sqrt(sum / count);
    };
    const auto with_slots = [&](int first, int second) {
      return error(apply_smaa(seen(0.75, 0.75), nullptr, {.slots = {1, 1, first, 0}}),
                   apply_smaa(seen(0.25, 0.25), nullptr, {.slots = {2, 2, second, 0}}));
    };
    const Rgba8Image one = apply_smaa(seen(0.5, 0.5), nullptr, {});
    EXPECT_LT(with_slots(1, 2), error(one, one)) << run;
    EXPECT_LT(4 * with_slots(1, 2), with_slots(0, 0)) << run;
    EXPECT_LT(10 * with_slots(1, 2), with_slots(2, 1)) << run;
  }
}

TEST(Smaa, DepthEdgesAreFoundWhereColourHasNone) {
  const Rgba8Image image = make_codes(40, 30, [](int x, int y) {
    return Rgba8{static_cast<std::uint8_t>(100 + (x + y) % 3), 100, 100};
  });
  Plane<float> depth(40, 30, 0.25f);
  for (int y = 0; y < 30; ++y)
    for (int x = 12 + y / 3; x < 40; ++x) depth(x, y) = 0.5f;
  const EdgePlane edges = smaa_edge_detection(image, &depth, {.edges = Edges::Depth});
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      EXPECT_EQ((*edges.at(x, y) & left_edge) != 0, x == 12 + y / 3);
      EXPECT_EQ((*edges.at(x, y) & top_edge) != 0, y > 0 && y % 3 == 0 && x == 11 + y / 3);
    }
}

TEST(Smaa, CornersOfRectanglesAreKept) {
  const Rgba8Image image = make_codes(60, 50, [](int x, int y) {
    return x >= 15 && x < 45 && y >= 12 && y < 38 ? Rgba8{240, 240, 240} : Rgba8{20, 20, 20};
  });
  const auto corner_loss = [&](int rounding) {
    return 240 - apply_smaa(image, nullptr, {.corner_rounding = rounding})(15, 12).g;
  };
  EXPECT_LT(corner_loss(0), corner_loss(25));
  EXPECT_LT(corner_loss(25), corner_loss(100));
}

}  // namespace
}  // namespace zoneplate::antialias
