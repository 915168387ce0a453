#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/api.h"
#include "zoneplate/scene/texel_image.h"
#include "zoneplate/shade/texture/growing_memory.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace ZONEPLATE_API zoneplate {

/// What the texels of an image say.
enum class TexelMeaning {
  Values,  ///< codes are values: code / 255 or code / 65535 (data; or colours with --color-management raw)
  Color,   ///< codes are sRGB, decoded to linear light; alpha is a value
};

/// An image with its smaller levels, in linear light.
///
/// Level l + 1 is half as wide and high as level l, rounded down, at least 1. Each of its texels is the mean of the
/// area it covers (where a size is odd, three texels a side, by the share that it covers of each), of codes rounded to
/// the nearest, halves up. Colours are decoded before they are averaged. Alpha is straight, as glTF has it: colour
/// is averaged without regard to alpha.
///
/// Texels    of 8-bit images: values as 8-bit codes, colours as 15-bit codes of linear light. Of all others: floats.
///           Light is taken as it is, in both meanings; what is not a number or below 0 becomes 0, what is above 1e9
///           (infinity too) 1e9; data and alpha end at 1.
/// Shape     any size up to 2^28 texels; an empty image becomes one white texel. A side of more than
///           TextureView::max_size texels is halved, as between levels, until it is not.
/// Exact     integer arithmetic for codes, sums in double in a fixed order for floats: the same bits for any number of
///           threads; an image of one colour has that colour on all levels.
/// Errors    OutOfMemory("texture levels").
/// Source    mipmaps: Williams, Pyramidal Parametrics, SIGGRAPH 1983; odd sizes: Guthe and Heckbert, Non-Power-of-Two
///           Mipmap Creation, NVIDIA 2005.
class Texture {
 public:
  /// Makes all levels, on the threads of the innermost `with_threads`.
  Texture(const TexelImage& image, TexelMeaning meaning);
  /// The same; the image is freed as soon as level 0 is there, before memory is taken for the other levels.
  Texture(TexelImage&& image, TexelMeaning meaning);

  /// The levels, for kernels; valid as long as this texture.
  const TextureView& view() const { return view_; }

 private:
  void make_first_level(const TexelImage& image, TexelMeaning meaning);
  void make_other_levels();
  template <class Code, class Pixel, class Decode>
  void fill(const Plane<Pixel>& image, const Code* TextureView::*texels, const Decode& decode);
  template <class Code>
  void make_levels(const Code* TextureView::*texels);

  GrowingMemory memory_;
  std::size_t count_ = 0;  ///< of the texels of all levels, with what may be read after them
  TextureView view_;
};

}  // namespace zoneplate
