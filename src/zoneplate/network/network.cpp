// SPDX-License-Identifier: Apache-2.0
// The network has two branches. At half the frame's resolution three convolutions of 3 × 3 pixels see 15 × 15 of them;
// their 24 activations are 6 of each of four pixels. One convolution of each pixel alone keeps the frame's resolution.
// A last one of 3 × 3 pixels joins both, and one per pixel makes the corrections.
//
// Numbers are integers of 16 bits, of whose products an instruction adds two (pmaddwd). A sum of at most 360 products
// of integers up to 127, with its bias, is below 2^24, so that a float holds it; the constructor checks this. The one
// product with a scale is rounded once.
#include "zoneplate/network/network.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/network/network_rows.h"

namespace zoneplate::network {
namespace {

constexpr std::string_view signature = "ZPLEARN1";

constexpr int of_each = 6, own = 8;  ///< the activations of a pixel that the two branches make
int halved(int size) { return (size + 1) / 2; }

/// Inputs, outputs, side and stride of a layer.
using LayerForm = std::array<std::uint8_t, 4>;

/// Reads little-endian numbers, and throws at the end.
class Bytes {
 public:
  Bytes(std::span<const std::uint8_t> bytes, std::string_view name) : bytes_(bytes), name_(name) {}
  std::span<const std::uint8_t> take(std::size_t count) {
    if (bytes_.size() < count) fail("ends too early");
    const auto out = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return out;
  }
  std::uint32_t number() {
    const auto b = take(4);
    return b[0] | std::uint32_t{b[1]} << 8 | std::uint32_t{b[2]} << 16 | std::uint32_t{b[3]} << 24;
  }
  bool is_empty() const { return bytes_.empty(); }
  [[noreturn]] void fail(std::string_view what) const {
    throw Error(ErrorKind::Input, fmt::format("{}: weights of a network: {}", name_, what));
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::string_view name_;
};

Convolution read_layer(Bytes& file, const LayerForm& form) {
  const auto found = file.take(4);
  if (!std::ranges::equal(found, form))
    file.fail(fmt::format("a layer has {} inputs, {} outputs, side {} and stride {}, expected {}, {}, {} and {}",
                          found[0], found[1], found[2], found[3], form[0], form[1], form[2], form[3]));
  Convolution out{.inputs = form[0], .outputs = form[1], .side = form[2], .stride = form[3]};
  const auto outputs = static_cast<std::size_t>(out.outputs);
  for (std::size_t o = 0; o < outputs; ++o) {
    const std::uint32_t bits = file.number();
    float scale = 0;
    std::memcpy(&scale, &bits, sizeof scale);
    if (!(scale > 0 && scale < 1e6f)) file.fail("a scale is not a positive number");
    out.scale.push_back(scale);
  }
  std::vector<double> greatest;
  for (std::size_t o = 0; o < outputs; ++o) {
    const auto bias = static_cast<std::int32_t>(file.number());
    out.bias.push_back(bias);
    greatest.push_back(std::abs(static_cast<double>(bias)));
  }
  const std::size_t products = static_cast<std::size_t>(out.inputs) * form[2] * form[2];
  out.weights.resize(products * outputs);
  for (std::size_t o = 0; o < outputs; ++o) {
    const auto weights = file.take(products);
    for (std::size_t k = 0; k < products; ++k) {
      const int weight = static_cast<std::int8_t>(weights[k]);
      out.weights[k / 2 * 2 * outputs + 2 * o + k % 2] = static_cast<std::int16_t>(weight);
      greatest[o] += std::abs(weight) * double{Network::levels};
    }
    if (greatest[o] >= 1 << 24) file.fail("a sum may exceed 2^24");
  }
  return out;
}

/// Applies a layer. Activations of `to` are written from channel `channel` on.
void convolve(const Convolution& layer, const Activations& from, Activations& to, int channel) {
  const int radius = layer.side / 2;
  parallel_ranges(static_cast<std::size_t>(to.height), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int y = static_cast<int>(i);
      ConvolutionRow row{.inputs = layer.inputs,
                         .outputs = layer.outputs,
                         .side = layer.side,
                         .stride = layer.stride,
                         .weights = layer.weights.data(),
                         .scale = layer.scale.data(),
                         .bias = layer.bias.data(),
                         .all_outputs = layer.outputs,
                         .activations = to.at(0, y) + channel,
                         .channels = to.channels};
      for (int k = 0; k < layer.side; ++k) row.input[k] = from.at(-radius, y * layer.stride + k - radius);
      NetworkKernels::of().convolve(row, static_cast<std::size_t>(to.width));
    }
  });
  to.close();
}

}  // namespace

Activations::Activations(int w, int h, int c)
    : width(w),
      height(h),
      channels(c),
      values(static_cast<std::size_t>(w + 2) * static_cast<std::size_t>(h + 2) * static_cast<std::size_t>(c)) {}

void Activations::close() {
  for (int y = 0; y < height; ++y) {
    std::copy_n(at(0, y), channels, at(-1, y));
    std::copy_n(at(width - 1, y), channels, at(width, y));
  }
  const std::ptrdiff_t row = std::ptrdiff_t{width + 2} * channels;
  std::copy_n(at(-1, 0), row, at(-1, -1));
  std::copy_n(at(-1, height - 1), row, at(-1, height));
}

Network::Network(std::span<const std::uint8_t> bytes, NetworkForm form, std::string_view name) {
  const auto features = static_cast<std::uint8_t>(form.features), outputs = static_cast<std::uint8_t>(form.outputs);
  const LayerForm forms[] = {{features, 16, 3, 2}, {16, 16, 3, 1}, {16, 24, 3, 1},
                             {features, 8, 1, 1},  {14, 16, 3, 1}, {16, outputs, 1, 1}};
  Bytes file(bytes, name);
  const auto start = file.take(signature.size());
  if (!std::equal(start.begin(), start.end(), signature.begin())) file.fail("does not begin with ZPLEARN1");
  for (int k = 0; k < layer_count; ++k) layers_[k] = read_layer(file, forms[k]);
  for (float& scale : layers_[Out].scale) scale /= levels;
  if (!file.is_empty()) file.fail("goes on after the last layer");
}

NetworkFrame::NetworkFrame(int width, int height, int channels)
    : features(width, height, channels),
      half_{{halved(width), halved(height), 16},
            {halved(width), halved(height), 16},
            {halved(width), halved(height), 24}},
      joined_(width, height, of_each + own),
      last_(width, height, 16) {}

void Network::read(NetworkFrame& frame) const {
  const int width = frame.features.width, height = frame.features.height;
  frame.features.close();
  convolve(layers_[Wide0], frame.features, frame.half_[0], 0);
  convolve(layers_[Wide1], frame.half_[0], frame.half_[1], 0);
  convolve(layers_[Wide2], frame.half_[1], frame.half_[2], 0);
  convolve(layers_[Own], frame.features, frame.joined_, of_each);
  const Activations& wide = frame.half_[2];
  parallel_ranges(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      std::int16_t* to = frame.joined_.at(0, y);
      for (int x = 0; x < width; ++x, to += frame.joined_.channels) {
        const std::int16_t* const from = wide.at(x / 2, y / 2) + 2 * (y % 2) + x % 2;
        for (int c = 0; c < of_each; ++c) to[c] = from[4 * c];
      }
    }
  });
  frame.joined_.close();
  convolve(layers_[Joined], frame.joined_, frame.last_, 0);
}

void Network::write(const NetworkFrame& frame, int x, int y, int count, int first, int outputs, float* out) const {
  const Convolution& layer = layers_[Out];
  const ConvolutionRow row{.input = {frame.last_.at(x, y)},
                           .inputs = layer.inputs,
                           .outputs = outputs,
                           .side = 1,
                           .stride = 1,
                           .weights = layer.weights.data() + std::ptrdiff_t{2} * first,
                           .scale = layer.scale.data() + first,
                           .bias = layer.bias.data() + first,
                           .all_outputs = layer.outputs,
                           .sums = out,
                           .channels = outputs};
  NetworkKernels::of().convolve(row, static_cast<std::size_t>(count));
}

std::uint64_t Network::multiplications(int width, int height) const {
  std::uint64_t sum = 0;
  for (int k = 0; k < layer_count; ++k) {
    const Convolution& layer = layers_[k];
    const bool is_half = k == Wide0 || k == Wide1 || k == Wide2;
    const int w = is_half ? halved(width) : width, h = is_half ? halved(height) : height;
    sum += static_cast<std::uint64_t>(w) * static_cast<std::uint64_t>(h) * layer.weights.size();
  }
  return sum;
}

}  // namespace zoneplate::network
