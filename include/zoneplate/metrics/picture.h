// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "zoneplate/image/rgb.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// What the values of an image mean (image/rgb_space.h).
struct RgbSpace;

namespace metrics {

/// The input of metrics: the same image as display-referred values and in linear light.
struct Picture {
  DisplayImage display{};        ///< straight alpha
  LinearImage linear{};          ///< premultiplied; of files as stored, with NaN and infinities
  bool is_scene_linear = false;  ///< `display` was made from `linear`, not the other way round
  /// 1 where a surface was hidden, or outside the image, in the frame before. Only of references that the renderer has
  /// made as frames of a sequence; otherwise empty.
  Plane<std::uint8_t> is_uncovered = {};
  /// Of references: 1 at pixels that are not measured; empty if all are. Metrics measure the others: those that look at
  /// neighbours find the reference at ignored pixels of both images, and pool the pixels that remain.
  Plane<std::uint8_t> is_ignored = {};
  std::string flaw = {};  ///< damage of its file that the decoder passed over, after the file's name; empty if none
  /// What the values of its file mean: `display` has codes of this space, and `linear` light of its primaries. Null:
  /// sRGB and Rec.709, as metrics expect it (in_srgb, metrics/file/picture_file.h).
  std::shared_ptr<const RgbSpace> space = nullptr;
  std::string color_flaw = {};  ///< why a profile of its file is not `space`, after the file's name; empty if it is

  /// Pixels in a row; both images have the same size.
  int width() const { return display.width(); }
  /// Rows of pixels.
  int height() const { return display.height(); }
};

/// From display-referred values; linear light is their decoded value.
Picture make_picture(DisplayImage display);

/// From linear light; the display-referred values are clamped and encoded, without tone mapping. There NaN is 0, and
/// infinity the greatest value.
Picture make_picture(LinearImage linear);

/// True if two images have the same pixels: bits of light, of which NaN equals only the same NaN, or codes, with the
/// colours of transparent pixels. A display-referred image never equals a scene-linear one.
bool has_same_values(const Picture& a, const Picture& b);

/// The number of pixels in which a channel is NaN or infinite.
std::size_t count_not_finite(const Picture& picture);

/// The image over black: each encoded value times alpha. Metrics measure this unless they state otherwise.
struct Codes {
  double r = 0, g = 0, b = 0;  ///< sRGB values times alpha, in [0, 1]
};
/// A colour composited over black in sRGB-encoded values.
constexpr Codes codes_on_black(Display c) {
  const double alpha = c.a;
  return {c.r * alpha, c.g * alpha, c.b * alpha};
}

/// Weights of red, green and blue.
struct LumaWeights {
  double r = 0, g = 0, b = 0;  ///< they sum to 1
};
constexpr LumaWeights rec709_luma{0.2126, 0.7152, 0.0722};  ///< ITU-R BT.709-6
constexpr LumaWeights rec601_luma{0.299, 0.587, 0.114};     ///< ITU-R BT.601-7

/// Luma: the weighted sum of encoded values (not of linear light).
constexpr double luma(Codes c, LumaWeights w = rec709_luma) { return w.r * c.r + w.g * c.g + w.b * c.b; }

/// The luma of every pixel of an image on black.
Plane<double> luma_plane(const DisplayImage& image, LumaWeights weights = rec709_luma);

/// Rec.709 luminance of every pixel of an image on black, in linear light.
Plane<double> luminance_plane(const LinearImage& image);

}  // namespace metrics
}  // namespace zoneplate
#pragma GCC visibility pop
