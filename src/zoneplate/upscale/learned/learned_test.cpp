// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/network/trained.h"
#include "zoneplate/upscale/learned/learned_mean.h"
#include "zoneplate/upscale/taau/taau_frames_for_test.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

using namespace taau_frames;
using network::Activations;
using network::Network;
using network::NetworkFrame;

std::span<const std::uint8_t> learned_weights() { return network::trained_weights(network::Trained::Learned); }

/// Inputs, outputs, side and stride of the layers.
constexpr int forms[][4] = {{40, 16, 3, 2}, {16, 16, 3, 1}, {16, 24, 3, 1},
                            {40, 8, 1, 1},  {14, 16, 3, 1}, {16, 56, 1, 1}};
constexpr std::size_t out_layer = 5;

/// The weights of a layer as the file has them, unpacked.
struct Layer {
  std::vector<double> scale, bias, weights;  ///< weights by output, row, column and input
};
std::vector<Layer> layers_of(std::span<const std::uint8_t> file) {
  std::vector<Layer> out;
  const std::uint8_t* at = file.data() + 8;
  for (const auto& [inputs, outputs, side, stride] : forms) {
    Layer layer;
    at += 4;
    for (int o = 0; o < outputs; ++o, at += 4) {
      float scale = 0;
      std::memcpy(&scale, at, 4);
      layer.scale.push_back(static_cast<double>(scale));
    }
    for (int o = 0; o < outputs; ++o, at += 4) {
      std::int32_t bias = 0;
      std::memcpy(&bias, at, 4);
      layer.bias.push_back(bias);
    }
    for (int k = 0; k < outputs * side * side * inputs; ++k) layer.weights.push_back(static_cast<std::int8_t>(*at++));
    out.push_back(std::move(layer));
  }
  return out;
}

/// A network whose corrections are 0.
std::vector<std::uint8_t> without_corrections() {
  const auto trained = learned_weights();
  std::vector<std::uint8_t> out(trained.begin(), trained.end());
  const std::size_t products = 16 * 56;
  std::fill(out.end() - static_cast<std::ptrdiff_t>(products + 56 * 4), out.end(), std::uint8_t{0});
  return out;
}

const LightAt wires = [](double x, double y, int) {
  const double place = x + 0.37 * y;
  return std::abs(place - 5 * std::floor(place / 5) - 2.5) < 0.17 ? 0.9 : 0.1;
};

LinearImage after_learned(int frames, const LightAt& light, float2 motion, const Network& network) {
  LearnedMean mean(scale * width, scale * height, network);
  LinearImage image;
  for (int i = 0; i < frames; ++i) image = mean.accumulate(frame_of(light, i, motion));
  return image;
}

TEST(Learned, WithoutCorrectionsItIsTaau) {
  const Network none(without_corrections(), LearnedNetwork::form, "test");
  for (const float2 motion : {float2{0, 0}, float2{0.4f, -0.3f}}) {
    const LinearImage expected = after<SampleMean>(6, wires, motion), found = after_learned(6, wires, motion, none);
    for (std::size_t i = 0; i < found.values().size(); ++i)
      ASSERT_NEAR(found.values()[i].g, expected.values()[i].g, 2e-5f) << i;
  }
}

TEST(Learned, SameBitsOnEveryInstructionSetAndThreadCount) {
  const LightAt light = [](double x, double y, int frame) { return wires(x, y, 0) * (frame < 3 ? 1.0 : 2.5); };
  const auto image = [&] { return after<FilteredLearned>(5, light, {0.4f, -0.3f}); };
  const LinearImage expected = with_isa(Isa::Scalar, image);
  for (const Isa isa : supported_isas())
    with_isa(isa, [&] { with_threads(3, [&] { EXPECT_EQ(image(), expected) << name_of(isa); }); });
}

// What the filters are for: less error in what moves, and in what rests.
TEST(Learned, FiltersImproveItsImages) {
  for (const float2 motion : {float2{0, 0}, float2{0.37f, 0.11f}})
    EXPECT_LT(error_after<FilteredLearned>(16, wires, motion), 0.97 * error_after<LearnedMean>(16, wires, motion))
        << motion.x;
}

TEST(Learned, OneColourStaysThatColour) {
  for (const auto& [w, h] : {std::pair(80, 60), std::pair(81, 61), std::pair(80, 61)}) {
    FilteredLearned mean(w, h);
    for (int i = 0; i < 5; ++i) {
      const LinearImage image = mean.accumulate(frame_of([](double, double, int) { return 0.3; }, i, {0.3f, -1.7f}));
      for (const Linear& c : image.values()) ASSERT_EQ(c, (Linear{0.3f, 0.15f, 0.075f, 1})) << w;
    }
  }
}

TEST(Learned, NoColourLeavesTheSamples) {
  LearnedMean mean(scale * width, scale * height);
  for (int i = 0; i < 8; ++i) {
    const LinearImage image = mean.accumulate(frame_of(wires, i, {0.4f, -0.3f}));
    for (const Linear& c : image.values()) ASSERT_TRUE(c.r >= 0 && c.r <= 1.2f) << c.r;  // of Catmull-Rom
  }
}

// What a foreign frame may contain must not leave it.
TEST(Learned, InvalidDataStayWhereTheyAre) {
  FilteredLearned mean(scale * width, scale * height);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 4; ++i) {
    TaauInput frame = frame_of(wires, i);
    frame.color(3, 4) = {nan, infinity, -infinity, 1};
    frame.motion_x(8, 9) = nan, frame.motion_y(20, 9) = infinity, frame.motion_x(30, 20) = -1e30f;
    frame.nearness(12, 12) = nan, frame.nearness(13, 20) = infinity;
    const LinearImage image = mean.accumulate(frame);
    for (const Linear& c : image.values())
      ASSERT_TRUE(std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b)) << i;
  }
}

/// Corrections in doubles, without rounding of activations.
class FloatTwin {
 public:
  explicit FloatTwin(std::span<const std::uint8_t> file) : layers_(layers_of(file)) {}

  std::vector<double> corrections_of(const Activations& frame) const {
    Planes in{frame.width, frame.height, frame.channels, {}};
    for (int y = 0; y < frame.height; ++y)
      for (int x = 0; x < frame.width; ++x)
        for (int c = 0; c < frame.channels; ++c) in.values.push_back(frame.at(x, y)[c] / 127.0);
    const Planes wide = applied(2, applied(1, applied(0, in))), own = applied(3, in);
    Planes joined{in.width, in.height, 14, {}};
    for (int y = 0; y < in.height; ++y)
      for (int x = 0; x < in.width; ++x)
        for (int c = 0; c < 14; ++c)
          joined.values.push_back(c < 6 ? wide.at(x / 2, y / 2, 4 * c + 2 * (y % 2) + x % 2) : own.at(x, y, c - 6));
    return applied(out_layer, applied(4, joined)).values;
  }

 private:
  struct Planes {
    int width, height, channels;
    std::vector<double> values;
    double at(int x, int y, int c) const {
      x = std::clamp(x, 0, width - 1), y = std::clamp(y, 0, height - 1);
      return values[static_cast<std::size_t>((y * width + x) * channels + c)];
    }
  };
  Planes applied(std::size_t number, const Planes& in) const {
    const auto& [inputs, outputs, side, stride] = forms[number];
    const Layer& layer = layers_[number];
    Planes out{(in.width + stride - 1) / stride, (in.height + stride - 1) / stride, outputs, {}};
    for (int y = 0; y < out.height; ++y)
      for (int x = 0; x < out.width; ++x)
        for (int o = 0; o < outputs; ++o) {
          const auto at = static_cast<std::size_t>(o);
          double sum = layer.bias[at] / 127;
          for (int k = 0; k < side * side * inputs; ++k) {
            const int tap = k / inputs;
            sum += layer.weights[at * static_cast<std::size_t>(side * side * inputs) + static_cast<std::size_t>(k)] *
                   in.at(x * stride + tap % side - side / 2, y * stride + tap / side - side / 2, k % inputs);
          }
          const double value = sum * layer.scale[at];
          out.values.push_back(number == out_layer ? value : std::clamp(value, 0.0, 1.0));
        }
    return out;
  }
  std::vector<Layer> layers_;
};

/// Of all pixels of a frame, by pixel, output pixel and correction.
std::vector<float> corrections_of(NetworkFrame& frame) {
  const Network& network = LearnedNetwork::trained();
  const int width = frame.features.width, height = frame.features.height;
  network.read(frame);
  // Three layers at half the size, and then one that reads the features, one of 3 × 3 and the last.
  EXPECT_EQ(network.multiplications(20, 10), 50u * (9 * 40 * 16 + 9 * 16 * 16 + 9 * 16 * 24) +
                                                 200u * (40 * 8 + 9 * 14 * 16 + 16 * LearnedNetwork::form.outputs));
  std::vector<float> out, row(static_cast<std::size_t>(width) * LearnedNetwork::per_pixel);
  constexpr int of_half = 2 * LearnedNetwork::corrections;
  for (int y = 0; y < height; ++y) {
    std::vector<float> halves[2];
    for (int half = 0; half < 2; ++half) {
      network.write(frame, 0, y, width, LearnedNetwork::first[half], LearnedNetwork::per_pixel, row.data());
      halves[half] = row;
    }
    for (int x = 0; x < width; ++x)
      for (int half = 0; half < 2; ++half) {
        const float* const first = halves[half].data() + x * LearnedNetwork::per_pixel + LearnedNetwork::begins[half];
        out.insert(out.end(), first, first + of_half);
      }
  }
  return out;
}

NetworkFrame random_frame(int w, int h) {
  NetworkFrame frame(w, h, LearnedNetwork::features);
  Activations& out = frame.features;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      for (int c = 0; c < LearnedNetwork::features; ++c)
        out.at(x, y)[c] =
            static_cast<std::int16_t>(hash(static_cast<std::uint32_t>(y * w + x), static_cast<std::uint32_t>(c)) % 128);
  return frame;
}

TEST(Network, IntegersAgreeWithFloats) {
  const FloatTwin twin(learned_weights());
  NetworkFrame frame = random_frame(21, 13);
  const std::vector<float> found = corrections_of(frame);
  const std::vector<double> expected = twin.corrections_of(frame.features);
  ASSERT_EQ(found.size(), expected.size());
  double error = 0, size = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    error += std::pow(double{found[i]} - expected[i], 2), size += std::pow(expected[i], 2);
  EXPECT_GT(size, 0);
  EXPECT_LT(error, 0.02 * 0.02 * size);
}

TEST(Network, SameBitsOnEveryInstructionSetAndThreadCount) {
  const auto corrections = [] {
    NetworkFrame frame = random_frame(37, 11);
    return corrections_of(frame);
  };
  const std::vector<float> expected = with_isa(Isa::Scalar, corrections);
  for (const Isa isa : supported_isas())
    with_isa(isa, [&] { with_threads(3, [&] { EXPECT_EQ(corrections(), expected) << name_of(isa); }); });
}

std::string network_refusal(std::span<const std::uint8_t> bytes) {
  try {
    Network(bytes, LearnedNetwork::form, "w.bin");
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Input);
    return e.what();
  }
  return "accepted";
}

TEST(Network, ReadsNoOtherFiles) {
  const auto trained = learned_weights();
  EXPECT_EQ(network_refusal(trained), "accepted");
  for (std::size_t size = 0; size < trained.size(); size += 37)
    EXPECT_NE(network_refusal(trained.first(size)).find("ends too early"), std::string::npos) << size;
  std::vector<std::uint8_t> bytes(trained.begin(), trained.end());
  bytes.push_back(0);
  EXPECT_NE(network_refusal(bytes).find("goes on after"), std::string::npos);
  for (std::uint32_t k = 0; k < 300; ++k) {  // any bytes make a network or an error
    bytes.assign(trained.begin(), trained.end());
    for (std::uint32_t n = 0; n < 4; ++n)
      bytes[hash(k, n, 1u) % bytes.size()] = static_cast<std::uint8_t>(hash(k, n, 2u));
    network_refusal(bytes);
  }
  bytes.assign(trained.begin(), trained.end());
  bytes[8] = 41;
  EXPECT_EQ(network_refusal(bytes),
            "w.bin: weights of a network: a layer has 41 inputs, 16 outputs, side 3 and stride 2, expected 40, 16, 3 "
            "and 2");
  bytes[8] = 40, bytes[12] = bytes[13] = bytes[14] = bytes[15] = 255;  // NaN
  EXPECT_NE(network_refusal(bytes).find("a scale is not"), std::string::npos);
  bytes.assign(trained.begin(), trained.end());
  bytes[12 + 4 * 16 + 3] = 127;  // the first bias
  EXPECT_NE(network_refusal(bytes).find("may exceed"), std::string::npos);
}

TEST(Learned, RefusesOtherRatios) {
  const auto refusal = [](const auto& make) {
    try {
      make();
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::Usage);
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refusal([] { make_method("learned:scale=1.5"); }).find("scale"), std::string::npos);
  const auto request = [](int frame_width, const char* method = "learned") {
    FrameContext context{.image = {160, 120, std::nullopt}};
    context.given = GivenFrame{.width = frame_width, .height = 60};
    make_method(method)->request(context);
  };
  EXPECT_EQ(refusal([&] { request(80); }), "accepted");
  EXPECT_EQ(refusal([&] { request(160, "learned:scale=1"); }),
            "learned makes images of the frames' size: for 160 x 120 pixels it needs frames of 160 x 120, not of 160 x "
            "60");
  EXPECT_EQ(refusal([&] { request(100); }),
            "learned makes images of twice the frames' size: for 160 x 120 pixels it needs frames of 80 x 60, not of "
            "100 x 60");
}

}  // namespace
}  // namespace zoneplate::upscale
