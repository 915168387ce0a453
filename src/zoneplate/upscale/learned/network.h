// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace zoneplate::upscale {

/// A frame's features or activations, by row, column and channel: whole numbers, with a border of one pixel that
/// repeats the outermost ones.
struct Activations {
  int width = 0, height = 0, channels = 0;
  std::vector<float> values;

  Activations(int w, int h, int c);
  /// The channels of pixel (x, y); the border is at -1 and at the width or height.
  float* at(int x, int y) { return values.data() + offset(x, y); }
  const float* at(int x, int y) const { return values.data() + offset(x, y); }
  /// Writes the border.
  void close();

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(width + 2) + static_cast<std::size_t>(x + 1)) *
           static_cast<std::size_t>(channels);
  }
};

/// What a network reads and writes for frames of one size.
struct NetworkFrame {
  Activations features;
  std::vector<float> corrections;

  NetworkFrame(int width, int height);

 private:
  friend class Network;
  Activations half_[3], joined_, last_;
};

/// A convolution with integers: weights in [-127, 127] times a scale per output, activations in [0, 127].
struct Convolution {
  int inputs = 0, outputs = 0, side = 0, stride = 0;
  std::vector<float> scale, bias;  ///< per output; the bias is a whole number
  std::vector<float> weights;      ///< by row, column, input and output
};

/// The network of `learned`: from features of a frame's pixels to corrections of its output pixels.
///
/// Exact     the same bits on every instruction set: all sums are of integers, below 2^24, which floats hold exactly.
/// Source    trained by train/; all numbers are in weights.bin.
class Network {
 public:
  static constexpr int features = 40;
  static constexpr int corrections = 14;  ///< for each of four output pixels
  static constexpr float levels = 127;    ///< the activation that stands for 1

  /// The network that the program contains.
  static const Network& trained();

  /// Reads a file of weights; `name` is for messages.
  ///
  /// Errors    ErrorKind::Input if it is not a network of this form, or its sums are not exact.
  Network(std::span<const std::uint8_t> bytes, std::string_view name);

  /// Writes the corrections of all pixels, by pixel, output pixel and correction: products of integers and scales.
  ///
  /// Requires  features are integers in [0, 127].
  void correct(NetworkFrame& frame) const;

 private:
  enum Layer { Wide0, Wide1, Wide2, Own, Joined, Out, layer_count };
  Convolution layers_[layer_count];
};

}  // namespace zoneplate::upscale
