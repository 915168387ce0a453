#pragma once

#include <memory>

#include "zoneplate/base/api.h"
#include "zoneplate/scene/texel_image.h"

namespace zoneplate {
struct TextureView;  // shade/texture/texture_view.h
}  // namespace zoneplate

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
/// Texels    of 8-bit images: values as 8-bit codes, colours as 15-bit codes of linear light. Of scene-linear images
///           (HDR, EXR): half floats where half floats represent every texel of level 0 exactly, as they do for an EXR
///           file of half floats; else floats, as of 16-bit images. Scene-linear values are not decoded. NaN and
///           values below 0 become 0, values above 1e9 (infinity too) 1e9; data and alpha are at most 1.
/// Shape     any size up to 2^28 texels; an empty image becomes one white texel. A side of more than
///           TextureView::max_size texels is halved, as between levels, until it is not.
/// Exact     integer arithmetic for codes; sums in double in a fixed order for floats and half floats, rounded to float
///           and, for half floats, from there to half, each to nearest even. The same bits for any number of threads;
///           an image of one colour has that colour on all levels.
/// Errors    OutOfMemory("texture levels").
/// Source    mipmaps: Williams, Pyramidal Parametrics, SIGGRAPH 1983; odd sizes: Guthe and Heckbert, Non-Power-of-Two
///           Mipmap Creation, NVIDIA 2005.
class Texture {
 public:
  /// Makes all levels, on the threads of the innermost `with_threads`.
  Texture(const TexelImage& image, TexelMeaning meaning);
  /// The same; the image is freed as soon as level 0 is there, before memory is taken for the other levels.
  Texture(TexelImage&& image, TexelMeaning meaning);

  ~Texture();
  /// Moves the levels; afterwards `other` may only be destroyed or assigned to.
  Texture(Texture&& other) noexcept;
  /// The same.
  Texture& operator=(Texture&& other) noexcept;

  /// The levels, for kernels; valid as long as this texture or the one that it was moved to.
  const TextureView& view() const;

 private:
  struct Levels;
  std::unique_ptr<Levels> levels_;
};

}  // namespace zoneplate
