// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "zoneplate/image/rgb.h"
#include "zoneplate/render/method.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The grids of an upscaled image and of its input, both of which may be parts of whole images.
///
/// Output pixel (x, y) of the whole image is at ((x + ½) width / to.width - ½, ...) among the centres of the input's
/// pixels.
struct UpscaleGrid {
  int width = 0, height = 0;  ///< pixels of the whole input
  int x = 0, y = 0;           ///< position of the given part of the input in the whole one
  ImageExtent to{};           ///< the whole output, and the part of it that is made

  /// The rectangle that is made: `to.crop`, or the whole output.
  Crop made() const { return to.crop.value_or(Crop{0, 0, to.width, to.height}); }
};

/// A filter that makes an image of more pixels than its input.
class SpatialUpscaler {
 public:
  virtual ~SpatialUpscaler() = default;
  /// An output pixel at x among the centres of the input reads columns ⌊x⌋ + 1 - radius() to ⌊x⌋ + radius(), and rows
  /// likewise; beyond the edges of the whole input, the pixels at the edge.
  virtual int radius() const = 0;
  /// Makes the output of a grid.
  ///
  /// Requires  the output is not smaller than the input; the image contains the pixels that the output reads.
  /// Exact     the same bits for any number of threads, instruction set and part of the output.
  virtual DisplayImage upscale(const DisplayImage& image, const UpscaleGrid& grid) const = 0;
  /// The same of scene-linear, premultiplied values of any sign and range; nothing from a method that is defined for
  /// display-referred ones only.
  virtual std::optional<LinearImage> upscale_light(const LinearImage& /*image*/, const UpscaleGrid& /*grid*/) const {
    return std::nullopt;
  }
};

/// An entry of the catalogue of upscalers.
struct Upscaler {
  std::string_view name{};             ///< in lower case: "fsr1" of `fsr1:scale=2`
  std::string_view summary{};          ///< one line for listings
  std::string_view source{};           ///< the publication or implementation that defines the method
  std::span<const Param> params = {};  ///< what may follow the name, beginning with `scale`
  /// Makes a filter of the display-referred image; empty for temporal methods.
  std::function<std::unique_ptr<SpatialUpscaler>(const Settings&)> make_spatial{};
  /// Makes the resolver of a temporal method, which jitters its own samples; empty for filters.
  std::function<std::unique_ptr<Resolver>(const Settings&)> make_temporal{};
  bool is_specification_only = false;  ///< tested against its publication only, for lack of another implementation
};

/// The number of output pixels per input pixel along each axis: the parameter that every upscaler has.
inline constexpr Param scale_param = real_param("scale", "image size over render size, per axis", 1.5, 1, 4);

/// Upscalers, by name.
namespace upscale {

/// The catalogue, in the order of upscalers.txt.
std::span<const Upscaler> upscalers();

/// Makes a spatial upscaler of a text such as `fsr1:sharpness=0.5`; its scale is without effect.
///
/// Errors    ErrorKind::Usage naming an unknown upscaler or parameter, or a temporal upscaler.
std::unique_ptr<SpatialUpscaler> make_spatial_upscaler(std::string_view text);

/// An upscaled scene-linear image, and what a filter of display-referred ones cannot represent.
struct UpscaledLight {
  LinearImage image{};       ///< premultiplied, of the size of the grid
  std::size_t negative = 0;  ///< pixels with a channel below 0, which counted as 0
  std::size_t bright = 0;    ///< with a straight colour above 32768, which counted as that
  std::size_t additive = 0;  ///< with light at alpha 0, which counted as none
  float brightest = 0;       ///< the greatest straight colour that is represented
  float constant = 0;        ///< what an image becomes of which all pixels have that
};

/// Upscales a scene-linear image: by upscale_light, or else by a filter of display-referred ones: of the square roots
/// of straight colours that c / (1 + max(c)) maps to [0, 1), and back.
///
/// Edges     of the latter: NaN counts as 0.
/// Source    AMD, ffx_fsr1.h: FsrSrtmF, FsrSrtmInvF.
UpscaledLight upscale_linear(const SpatialUpscaler& upscaler, const LinearImage& image, const UpscaleGrid& grid);

/// Makes the resolver of an antialiasing method, of an upscaler, or of one after the other: `smaa`, `fsr2:scale=2` or
/// `smaa+fsr1:scale=2,sharpness=0.5`. A spatial upscaler alone renders with `none`.
///
/// A temporal upscaler jitters its own samples and has no method before it but `none`. Textures are filtered for
/// pixels of the image: the level of detail is lower by log2(scale), or by more if the upscaler says so.
/// Errors    ErrorKind::Usage naming an unknown method, parameter or value, or a method before a temporal upscaler.
std::unique_ptr<Resolver> make_method(std::string_view text);

}  // namespace upscale
}  // namespace zoneplate
#pragma GCC visibility pop
