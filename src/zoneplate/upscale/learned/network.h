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
  std::vector<std::int16_t> values;

  Activations(int w, int h, int c);
  /// The channels of pixel (x, y); the border is at -1 and at the width or height.
  std::int16_t* at(int x, int y) { return values.data() + offset(x, y); }
  const std::int16_t* at(int x, int y) const { return values.data() + offset(x, y); }
  /// Writes the border.
  void close();

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(width + 2) + static_cast<std::size_t>(x + 1)) *
           static_cast<std::size_t>(channels);
  }
};

/// What a network reads, and what its layers say, for frames of one size.
struct NetworkFrame {
  Activations features;

  NetworkFrame(int width, int height);

 private:
  friend class Network;
  Activations half_[3], joined_, last_;
};

/// A convolution with integers: weights in [-127, 127] times a scale per output, activations in [0, 127].
struct Convolution {
  int inputs = 0, outputs = 0, side = 0, stride = 0;
  std::vector<float> scale;           ///< per output
  std::vector<std::int32_t> bias;     ///< likewise
  std::vector<std::int16_t> weights;  ///< by row, pair of a row's inputs, output and input
};

/// The network of `learned`: from features of a frame's pixels to corrections of its output pixels.
///
/// Exact     the same bits on every instruction set: all sums are of integers, below 2^24, which floats hold exactly.
/// Source    trained by train/; all numbers are in weights.bin.
class Network {
 public:
  static constexpr int features = 40;
  static constexpr int corrections = 14;  ///< for each of four output pixels
  /// The numbers that `correct` writes for a frame pixel, and where in them the two output pixels above and below its
  /// sample begin.
  static constexpr int per_pixel = 32, begins[2] = {0, 4};
  static constexpr float levels = 127;  ///< the activation that stands for 1
  /// The number of the history's samples at which corrections of weights change half as much as without history.
  static constexpr float count_at_rest = 4;

  /// The network that the program contains.
  static const Network& trained();

  /// Reads a file of weights; `name` is for messages.
  ///
  /// Errors    ErrorKind::Input if it is not a network of this form, or its sums are not exact.
  Network(std::span<const std::uint8_t> bytes, std::string_view name);

  /// Applies all layers but the last to the features.
  ///
  /// Requires  features are in [0, 127].
  void read(NetworkFrame& frame) const;
  /// Applies the last layer to `count` frame pixels from (x, y) on, and writes the corrections of their output pixels
  /// above the samples (half 0) or below (1), by pixel and correction.
  void correct(const NetworkFrame& frame, int x, int y, int count, int half, float* out) const;

 private:
  enum Layer { Wide0, Wide1, Wide2, Own, Joined, Out, layer_count };
  Convolution layers_[layer_count];
};

}  // namespace zoneplate::upscale
