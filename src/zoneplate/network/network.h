// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace zoneplate::network {

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

  NetworkFrame(int width, int height, int features);

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

/// The numbers that a network reads of each pixel of a frame, and those that it says of it.
struct NetworkForm {
  int features, outputs;
};

/// A small network: from features of a frame's pixels, 0 to 127, to outputs of each, which are real numbers.
///
/// Exact     the same bits on every instruction set: all sums are of integers, below 2^24, which floats hold exactly.
/// Source    trained by train/
class Network {
 public:
  static constexpr float levels = 127;  ///< the activation that stands for 1

  /// Reads a file of weights; `name` is for messages.
  ///
  /// Requires  features are even, and outputs a multiple of 8.
  /// Errors    ErrorKind::Input if it is not a network of this form, or its sums are not exact.
  Network(std::span<const std::uint8_t> bytes, NetworkForm form, std::string_view name);

  /// Applies all layers but the last to the features.
  ///
  /// Requires  features are in [0, 127].
  void read(NetworkFrame& frame) const;
  /// Applies the last layer to `count` pixels from (x, y) on, and writes for each the `outputs` from `first` on.
  ///
  /// Requires  `outputs` is a multiple of 8.
  void write(const NetworkFrame& frame, int x, int y, int count, int first, int outputs, float* out) const;
  /// The multiplications of a weight and an activation in all layers, for all pixels of a frame.
  std::uint64_t multiplications(int width, int height) const;

 private:
  enum Layer { Wide0, Wide1, Wide2, Own, Joined, Out, layer_count };
  Convolution layers_[layer_count];
};

}  // namespace zoneplate::network
