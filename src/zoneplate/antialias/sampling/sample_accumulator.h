// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "zoneplate/render/method.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate::antialias {

/// The weight or mapping of a sample's colour before samples are averaged.
enum class SampleWeight {
  Even,     ///< linear light, all weights equal
  Karis,    ///< weighted by 1 / (1 + luma × exposure)
  Max3,     ///< mapped by c / (1 + max(c)), the mean mapped back
  Display,  ///< display-referred: tone-mapped over the background, linear
  Encoded,  ///< display-referred and sRGB-encoded, as in the resolve of an 8-bit framebuffer without sRGB conversion
};

/// The filter by which a method averages samples.
struct ResolveFilter {
  SampleWeight weight = SampleWeight::Even;
  std::optional<Kernel> kernel;  ///< in pixels; without a kernel, the unweighted mean of the pixel's own samples

  /// True for the unweighted mean, which the renderer computes itself.
  bool is_plain() const { return weight == SampleWeight::Even && !kernel; }
  /// The filter's radius in whole pixels.
  int radius() const;
  /// True if the mean is of values after tone mapping.
  bool is_display_referred() const { return weight == SampleWeight::Display || weight == SampleWeight::Encoded; }
};

/// The parameters `resolve`, `mix`, `filter` and `radius` of methods that accumulate samples, and the filter that they
/// select.
///
/// `radius` is the filter's, in pixels; 0: the kernel's own radius.
/// Errors    ErrorKind::Usage for a radius without a filter, or for sRGB-encoded averaging with a weight for
///           scene-linear values.
inline constexpr std::string_view resolve_names[] = {"box", "karis", "max3", "display"};
inline constexpr std::string_view filter_names[] = {"pixel",       "box",      "tent",     "gaussian",       "mitchell",
                                                    "catmull-rom", "b-spline", "lanczos3", "blackman-harris"};
inline constexpr Param resolve_param = {
    .name = "resolve",
    .meaning = "mean of linear light, mean with smaller weights for brighter samples, or mean after tone mapping",
    .names = resolve_names};
inline constexpr std::string_view mix_names[] = {"light", "codes"};
inline constexpr Param mix_param = {.name = "mix",
                                    .meaning = "blend space: linear light, or sRGB-encoded values after tone mapping",
                                    .names = mix_names};
inline constexpr Param filter_param = {
    .name = "filter",
    .meaning = "reconstruction filter over the samples of the neighbourhood; pixel: those of the pixel alone",
    .names = filter_names};
inline constexpr Param radius_param = {.name = "radius",
                                       .meaning = "radius of the filter in pixels; 0: the default of the filter",
                                       .value = 0,
                                       .low = 0,
                                       .high = 4,
                                       .decimals = 2};
ResolveFilter resolve_filter_of(std::string_view method, const Settings& settings);

class SampleRow;

/// Accumulates samples of one or several frames. A filter is applied along the rows first, then along the columns.
///
/// Edges     there are no samples outside the image; the weights of the others are divided by their sum.
/// Exact     in float, in the order of samples, then rows, each row from left to right; the same bits for any number of
///           threads and any instruction set.
/// Cost      width + height of the filter in products per sample and channel, not width × height.
/// Source    wide resolves and weights: Pettineo, Experimenting with Reconstruction Filters for MSAA Resolve, 2012;
///           Karis, Tone Mapping, 2013; Lottes, Optimized Reversible Tonemapper for Resolve, 2016.
class SampleAccumulator {
 public:
  explicit SampleAccumulator(ResolveFilter filter) : filter_(std::move(filter)) {}

  /// Adds a frame's samples, whose positions are `positions`.
  void add(const Frame& frame, std::span<const SamplePosition> positions);
  bool is_empty() const { return sum_.empty(); }

  /// The mean in linear light; for a display-referred filter, the premultiplied mean of display-referred values.
  LinearImage light() const;
  /// The mean of the display-referred colours for a display-referred filter; else `image`.
  DisplayImage display_referred(DisplayImage image, const DisplayOptions& display) const;

 private:
  struct Taps {
    std::vector<float> across, down;  ///< by distance, the leftmost or uppermost first
  };
  void begin(int width, int height);
  void add_rows(const Frame& frame, std::span<const Taps> taps, int first, int last);
  void spread(const SampleRow& row, const Taps& taps, int y, int first, int last);

  ResolveFilter filter_;
  int width_ = 0, height_ = 0;
  std::size_t stride_ = 0;           ///< pixels per row, a multiple of whole vectors
  std::vector<float> sum_, weight_;  ///< four floats and one float per pixel
};

}  // namespace zoneplate::antialias
