// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"
#include "zoneplate/network/network.h"

namespace zoneplate::antialias {

/// What the networks of `learned-smaa` and `learned-still` say of each pixel of an image: corrections of weights.
///
/// Units     sRGB-encoded codes; alpha is not read
/// Edges     the outermost pixels are repeated beyond the sides
/// Exact     the same bits on every instruction set; a part of an image, with `radius` pixels around it, has the
///           corrections of the whole image.
class StillCorrections {
 public:
  static constexpr int features = 12;
  /// How many pixels away corrections depend on the images.
  static constexpr int radius = 10;

  /// Rows of an image whose corrections are in memory at once: some 100 bytes per pixel.
  static constexpr int band = 256;

  /// Of the `band` rows from `first` on. `smooth` is the image after SMAA; both are a part of an image from its pixel
  /// (x, y) on.
  StillCorrections(const Rgba8Image& image, const Rgba8Image& smooth, int x, int y, int first,
                   const network::Network& network, int outputs);

  /// Writes the outputs of all pixels of row y, by pixel and output.
  ///
  /// Requires  the row is one of the band's.
  void write_row(int y, float* out) const;

 private:
  void describe(const Rgba8Image& image, const Rgba8Image& smooth);

  const network::Network& network_;
  int outputs_, width_;
  int begin_;       ///< the first row that the network reads
  int left_, top_;  ///< 1 where it begins at an odd pixel, since the network halves the whole image
  network::NetworkFrame frame_;
};

}  // namespace zoneplate::antialias
