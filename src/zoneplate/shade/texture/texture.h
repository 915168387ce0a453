#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/scene/texel_image.h"
#include "zoneplate/shade/texture/growing_memory.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {

/// How the texels of an image are interpreted.
enum class TexelMeaning {
  Values,  ///< linear: the integer / 255 or / 65535 (data; or colours with --color-management raw)
  Color,   ///< sRGB, decoded to linear light; alpha is linear
};

/// An image with its mip levels, in linear light.
///
/// Level l + 1 is half as wide and high as level l, rounded down, at least 1. Each of its texels is the mean of the
/// area that it covers (where a size is odd, of three texels a side, weighted by the fraction that it covers of each);
/// means of integers are rounded to the nearest, halves up. Colours are decoded before they are averaged. Alpha is
/// straight, as in glTF: colour is averaged without regard to alpha.
///
/// Texels    of 8-bit images: values as unorm8, colours as unorm15 in linear light. Of all other images: floats. Linear
///           images keep their values, with both meanings; NaN and values below 0 become 0, values above 1e9 and
///           infinity become 1e9; data and alpha are clamped to 1.
/// Shape     any size up to 2^28 texels; an empty image becomes one white texel. A side of more than
///           TextureView::max_size texels is halved, as between levels, until it fits.
/// Exact     integer arithmetic for unorm texels, sums in double in a fixed order for floats: the same bits for any
///           number of threads; an image of one colour has that colour on all levels.
/// Errors    OutOfMemory("texture levels").
/// Source    mipmaps: Williams, Pyramidal Parametrics, SIGGRAPH 1983; odd sizes: Guthe and Heckbert, Non-Power-of-Two
///           Mipmap Creation, NVIDIA 2005.
class Texture {
 public:
  Texture(const TexelImage& image, TexelMeaning meaning);
  /// The same; the image is freed as soon as level 0 is made, before memory is taken for the other levels.
  Texture(TexelImage&& image, TexelMeaning meaning);

  const TextureView& view() const { return view_; }

 private:
  void make_first_level(const TexelImage& image, TexelMeaning meaning);
  void make_other_levels();
  template <class Code, class Pixel, class Decode>
  void fill(const Plane<Pixel>& image, const Code* TextureView::*texels, const Decode& decode);
  template <class Code>
  void make_levels(const Code* TextureView::*texels);

  GrowingMemory memory_;
  std::size_t count_ = 0;  ///< of texels: all levels, and those after the last that may be read
  TextureView view_;
};

}  // namespace zoneplate
