// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// The display and the viewing conditions. The defaults are a 4K display of 30 inches at 0.75 m, in an office.
struct Viewing {
  double pixels_per_degree = 75.40245;
  double peak = 200;  ///< cd/m² of white
  double contrast = 1000;
  double ambient = 250;  ///< illuminance on the display in lux
};

/// The metrics' parameters that describe the display.
inline constexpr Param viewing_params[] = {real_param("ppd", "pixels per degree of view", 75.40245, 1, 1000),
                                           real_param("peak", "cd/m² of white", 200, 1, 10000)};
Viewing viewing_of(const Settings& settings);

/// Minimum width and height.
constexpr int min_visible_size = 16;

/// An image as luminance, red-green and violet-yellow planes (and, in a sequence, transient luminance), in cd/m².
using OpponentPlanes = std::vector<Plane<double>>;

/// The three opponent planes of a display that shows an image over black.
OpponentPlanes opponent_planes(const LinearImage& image, const Viewing& viewing);

/// The visible difference by channel, pooled over the image and all frequency bands.
///
/// `is_ignored`: 1 at pixels that do not count in the pooling of a band; empty if there are none. A pixel of a coarser
/// band is ignored if all of its pixels are.
/// Requires  3 or 4 planes of one size, at least 16 × 16.
/// Edges     0 in each channel in which the images agree. Not symmetric: the eye is adapted to the reference's
///           luminance.
/// Source    Mantiuk, Hanji, Ashraf, Asano, Chapiro, ColorVideoVDP: A Visual Difference Predictor for Image, Video and
///           Display Distortions, SIGGRAPH 2024; parameters of version 0.5.6.
std::vector<double> visible_difference(const OpponentPlanes& reference, const OpponentPlanes& test,
                                       const Viewing& viewing, Plane<std::uint8_t> is_ignored = {});

/// The norm of `visible_difference` over the channels.
double pool_channels(std::span<const double> channels);

/// The channels' contributions with their names, for reports: sustained channels measure blur and noise, the transient
/// one flicker.
std::vector<Figure> channel_figures(const std::vector<double>& channels);

/// The root mean square of the fitted model, which is less steep at 0; for the differences of frames.
double soft_root_mean_square(std::span<const double> values);

/// Converts a difference to a quality in JOD: 10 is no difference; at 9, three of four people would prefer the
/// reference.
double quality_of(double difference);
double difference_of(double quality);

/// The temporal filters of the four channels at a frame rate; symmetric, all with the same odd number of taps.
std::vector<std::vector<double>> temporal_filters(double frames_per_second);

/// The opponent planes of the last frame, filtered in time: three sustained channels and a transient one.
///
/// Edges     if there are fewer frames than taps, the first frame is repeated before the sequence.
OpponentPlanes filtered_in_time(std::span<const OpponentPlanes> frames,
                                const std::vector<std::vector<double>>& filters);

}  // namespace zoneplate::metrics
