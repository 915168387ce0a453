#pragma once

#include <optional>
#include <span>

#include "zoneplate/render/method.h"
#include "zoneplate/signal/kernel.h"

namespace zoneplate::antialias {

/// What a sample's colour counts as, before samples are averaged.
enum class SampleWeight {
  Even,     ///< linear light as it is
  Karis,    ///< less the brighter it is: 1 / (1 + luma × exposure)
  Max3,     ///< mapped by c / (1 + max(c)), the mean mapped back
  Display,  ///< as it is shown, tone mapped over the background: the mean of what a screen would show
};

/// How a method makes one colour of many samples.
struct Gathering {
  SampleWeight weight = SampleWeight::Even;
  std::optional<Kernel> kernel;  ///< of pixels; none: the samples of the pixel alone count, all alike

  /// True for the plain mean, which the renderer makes by itself.
  bool is_plain() const { return weight == SampleWeight::Even && !kernel; }
  /// How many pixels to each side the samples are taken from.
  int reach() const;
};

/// The parameters `resolve`, `filter` and `radius` of methods that gather samples, and what they say.
///
/// `radius` is the filter's in hundredths of a pixel; 0 leaves it as the kernel has it.
/// Errors    Trouble::Usage where the radius has no filter.
inline constexpr std::string_view resolve_names[] = {"box", "karis", "max3", "display"};
inline constexpr std::string_view filter_names[] = {"pixel",       "box",      "tent",     "gaussian",       "mitchell",
                                                    "catmull-rom", "b-spline", "lanczos3", "blackman-harris"};
inline constexpr Param resolve_param = {
    .name = "resolve",
    .meaning = "averages light, light that weighs less the brighter, or what is shown",
    .names = resolve_names};
inline constexpr Param filter_param = {
    .name = "filter", .meaning = "over samples of pixels around too, or the pixel's own", .names = filter_names};
inline constexpr Param radius_param = {.name = "radius",
                                       .meaning = "of the filter, in pixels; 0: its own",
                                       .value = 0,
                                       .low = 0,
                                       .high = 400,
                                       .decimals = 2};
Gathering gathering_of(std::string_view method, const Settings& settings);

/// Sums samples that come in one frame or several.
///
/// Edges     samples beyond the picture's sides are not there; the weights of the others are divided by their sum.
/// Exact     in float, in the order of samples, then rows, then columns; the same for any number of threads.
/// Source    wide resolves and weights: Pettineo, Experimenting with Reconstruction Filters for MSAA Resolve, 2012;
///           Karis, Tone Mapping, 2013; Lottes, Optimized Reversible Tonemapper for Resolve, 2016.
class SampleGather {
 public:
  explicit SampleGather(Gathering gathering) : gathering_(std::move(gathering)) {}

  /// Takes a frame's samples; `positions` are theirs.
  void add(const Frame& frame, std::span<const SamplePosition> positions);
  bool is_empty() const { return sum_.empty(); }

  /// The mean in linear light; for SampleWeight::Display it has no meaning.
  LinearImage light() const;
  /// The mean of what is shown, in place of `image`, for SampleWeight::Display; else `image`.
  DisplayImage shown(DisplayImage image, const DisplayOptions& display) const;

 private:
  void add_plane(const LinearImage& samples, SamplePosition position, float exposure);

  Gathering gathering_;
  LinearImage sum_;
  Plane<float> weight_;
};

}  // namespace zoneplate::antialias
