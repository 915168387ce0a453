// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "zoneplate/image/plane.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// A part of a canvas: its left, top corner and its size.
struct CanvasPart {
  int x = 0, y = 0, width = 0, height = 0;
};

/// What becomes of a frame's part of the canvas before the next frame is drawn.
enum class Disposal : std::uint8_t { Keep, Clear, Restore };

/// The image to which the frames of an animation are drawn, transparent black at first. `Pixel` has straight alpha.
template <class Pixel>
class FrameCanvas {
 public:
  explicit FrameCanvas(int2 size) : image_(size.x, size.y, Pixel{0, 0, 0, 0}) {}

  const Plane<Pixel>& image() const { return image_; }

  /// Disposes of the frame before, and begins one whose own disposal is `disposal`.
  ///
  /// Requires  the part lies within the canvas.
  void begin(const CanvasPart& part, Disposal disposal) {
    if (last_disposal_ == Disposal::Clear)
      for_rows(last_, [](auto row, int) { std::ranges::fill(row, Pixel{0, 0, 0, 0}); });
    if (last_disposal_ == Disposal::Restore)
      for_rows(last_, [&](auto row, int y) { std::ranges::copy(saved_.row(y), row.begin()); });
    if (disposal == Disposal::Restore) {
      saved_ = Plane<Pixel>(part.width, part.height);
      for_rows(part, [&](auto row, int y) { std::ranges::copy(row, saved_.row(y).begin()); });
    }
    last_ = part, last_disposal_ = disposal;
  }

  /// The pixel (x, y) of the frame's part.
  Pixel& at(int x, int y) { return image_(last_.x + x, last_.y + y); }

 private:
  template <class Use>
  void for_rows(const CanvasPart& part, const Use& use) {
    for (int y = 0; y < part.height; ++y)
      use(image_.row(part.y + y).subspan(static_cast<std::size_t>(part.x), static_cast<std::size_t>(part.width)), y);
  }

  Plane<Pixel> image_, saved_;
  CanvasPart last_;
  Disposal last_disposal_ = Disposal::Keep;
};

}  // namespace zoneplate
