// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <optional>

#include "zoneplate/scene/material.h"
#include "zoneplate/scene/texel_image.h"
#include "zoneplate/scene/texture_filter.h"

namespace zoneplate {
struct TextureView;  // shade/texture/texture_view.h
struct RipmapView;   // the same
struct SumsView;     // the same
}  // namespace zoneplate

#pragma GCC visibility push(default)
namespace zoneplate {

/// How the texels of an image are interpreted.
enum class TexelMeaning {
  Values,  ///< linear: the integer / 255 or / 65535 (data; or colours with --color-management raw)
  Color,   ///< sRGB, decoded to linear light; alpha is linear
};

/// How the mip levels of a texture are made.
struct LevelOptions {
  MipFilter filter = MipFilter::Box;                  ///< from level to level
  Wrap wrap_u = Wrap::Repeat, wrap_v = Wrap::Repeat;  ///< the texels beyond the border that filters other than Box read
  /// The alpha cutoff of alpha-tested surfaces whose coverage the levels keep: each level's alpha is multiplied by a
  /// number with which the fraction of texels that pass is nearest to that of level 0.
  /// Source    Castaño, Computing Alpha Mipmaps, 2010.
  std::optional<float> kept_cutoff{};
  /// Weights colours by alpha between levels, and gives entirely transparent texels, on all levels, the colour of what
  /// is visible around them: look-ups do not see the colours that they hide.
  bool weights_by_alpha = false;
};

/// An image with its mip levels, in linear light.
///
/// Level l + 1 is half as wide and high as level l, rounded down, at least 1. Each of its texels is the mean of the
/// area that it covers (where a size is odd, of three texels a side, weighted by the fraction that it covers of each);
/// means of integers are rounded to the nearest, halves up. Colours are decoded before they are averaged. Alpha is
/// straight, as in glTF: colour is averaged without regard to alpha, unless LevelOptions::weights_by_alpha is set.
/// MipFilter::Kaiser and Lanczos replace that mean; their values are clamped to the range of the texels.
///
/// Texels    of 8-bit images: values as unorm8, colours as unorm15 in linear light. Of scene-linear images (HDR, EXR):
///           half floats where half floats represent every texel of level 0 exactly, as they do for an EXR file of half
///           floats; else floats, as of 16-bit images. Scene-linear values are not decoded. NaN and values below 0
///           become 0, values above 1e9 and infinity become 1e9; data and alpha are clamped to 1.
/// Shape     any size up to 2^28 texels; an empty image becomes one white texel. A side of more than
///           TextureView::max_size texels is halved, as between levels, until it fits.
/// Exact     integer arithmetic for unorm texels; sums in double in a fixed order for floats and half floats, rounded to
///           float and, for half floats, from there to half, each to nearest even. The same bits for any number of
///           threads; an image of one colour has that colour on all levels.
/// Errors    OutOfMemory("texture levels").
/// Source    mipmaps: Williams, Pyramidal Parametrics, SIGGRAPH 1983; odd sizes: Guthe and Heckbert, Non-Power-of-Two
///           Mipmap Creation, NVIDIA 2005.
class Texture {
 public:
  /// Makes all levels, on the threads of the innermost `with_threads`.
  Texture(const TexelImage& image, TexelMeaning meaning, const LevelOptions& options = {});
  /// The same; the image is freed as soon as level 0 is made, before memory is taken for the other levels.
  Texture(TexelImage&& image, TexelMeaning meaning, const LevelOptions& options = {});

  ~Texture();
  /// Moves the levels; afterwards `other` may only be destroyed or assigned to.
  Texture(Texture&& other) noexcept;
  /// The same.
  Texture& operator=(Texture&& other) noexcept;

  /// The levels, for kernels; valid as long as this texture or the one that it was moved to.
  const TextureView& view() const;

  // Other tables, each made from level 0 by the first call and kept; several threads may call. Errors: OutOfMemory.
  /// The levels that are reduced along one axis or both: three times the memory of level 0 in addition.
  const RipmapView& ripmap() const;
  /// The summed-area table: 32 bytes a texel.
  const SumsView& sums() const;
  /// Of a normal map: the spread of the normals within each texel of each level, as a texture of the same shape in
  /// floats. Red: the length of the mean of the unit normals; green, blue and alpha: the variances of the slopes x / z
  /// and y / z, and their covariance. At level 0 they are 1, 0, 0 and 0.
  const TextureView& normal_spread() const;

 private:
  struct Levels;
  std::unique_ptr<Levels> levels_;
};

}  // namespace zoneplate
#pragma GCC visibility pop
