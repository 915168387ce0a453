#pragma once

#include <cstdint>

#include "zoneplate/image/rgb.h"
#include "zoneplate/raster/arena.h"
#include "zoneplate/shade/texture_view.h"

namespace zoneplate {

/// What the texels of an image say.
enum class TexelMeaning {
  Values,  ///< codes are values: code / 255 (data; or colours with --color-management raw)
  Color,   ///< codes are sRGB, decoded to linear light; alpha is a value
};

/// An image with its smaller levels, in linear light.
///
/// Level l + 1 is half as wide and high as level l, rounded down, at least 1. Each of its texels is the mean of the
/// area it covers (where a size is odd, three texels a side, by the share that it covers of each), rounded to the
/// nearest code, halves up. Colours are decoded before they are averaged. Alpha is straight, as glTF has it: colour
/// is averaged without regard to alpha.
///
/// Shape     any size up to 2^28 texels; an empty image becomes one white texel.
/// Exact     integer arithmetic: the same bits for any number of threads; an image of one colour has that colour on
///           all levels.
/// Source    mipmaps: Williams, Pyramidal Parametrics, SIGGRAPH 1983; odd sizes: Guthe and Heckbert, Non-Power-of-Two
///           Mipmap Creation, NVIDIA 2005.
class Texture {
 public:
  Texture(const Rgba8Image& image, TexelMeaning meaning);

  const TextureView& view() const { return view_; }

 private:
  RawMemory codes_;
  TextureView view_;
};

}  // namespace zoneplate
