// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// The screen and the viewing conditions. The defaults are a 4K screen of 30 inches at 0.75 m, in an office.
struct Viewing {
  double pixels_per_degree = 75.40245;
  double peak = 200;  ///< cd/m² of white
  double contrast = 1000;
  double ambient = 250;  ///< lux that fall on the screen
};

/// The parameters of the metrics for a screen.
inline constexpr Param viewing_params[] = {real_param("ppd", "pixels per degree of view", 75.40245, 1, 1000),
                                           real_param("peak", "cd/m² of white", 200, 1, 10000)};
Viewing viewing_of(const Settings& settings);

/// Least width and height.
constexpr int least_visible_size = 16;

/// An image as luminance, red-green and violet-yellow (and, in a sequence, luminance that changes), in cd/m².
using OpponentPlanes = std::vector<Plane<double>>;

/// The three opponent planes that a screen makes of an image on black.
OpponentPlanes opponent_planes(const LinearImage& image, const Viewing& viewing);

/// The visible difference by channel, pooled over the image and over all frequency bands.
///
/// Requires  3 or 4 planes of one size, at least 16 × 16.
/// Edges     0 in each channel where the images agree. Not symmetric: the reference's luminance sets the eye.
/// Source    Mantiuk, Hanji, Ashraf, Asano, Chapiro, ColorVideoVDP: A Visual Difference Predictor for Image, Video
///           and Display Distortions, SIGGRAPH 2024; parameters of version 0.5.6.
std::vector<double> visible_difference(const OpponentPlanes& reference, const OpponentPlanes& test,
                                       const Viewing& viewing);

/// The norm over the channels of `visible_difference`.
double pool_channels(std::span<const double> channels);

/// The channels' parts by name, for reports: what is blur or noise and what is flicker.
std::vector<Figure> channel_figures(const std::vector<double>& channels);

/// The root mean square that was fitted with the model, a little less steep at 0: of the differences of frames.
double soft_root_mean_square(std::span<const double> values);

/// The difference as a quality in JOD: 10 is no difference; at 9 three of four people would prefer the reference.
double quality_of(double difference);
double difference_of(double quality);

/// The filters in time of the four channels at a rate of frames, symmetric, each of the same odd number of taps.
std::vector<std::vector<double>> temporal_filters(double frames_per_second);

/// The opponent planes of the last of some frames, filtered in time: three sustained channels and the transient one.
///
/// Edges     where the frames are fewer than the filters' taps, the first counts as shown for ever before.
OpponentPlanes filtered_in_time(std::span<const OpponentPlanes> frames,
                                const std::vector<std::vector<double>>& filters);

}  // namespace zoneplate::metrics
