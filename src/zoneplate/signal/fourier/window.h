// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/spec.h"
#include "zoneplate/image/plane.h"

namespace zoneplate {

/// A window: a function by which a signal is multiplied before its transform, so that its ends match.
struct Window {
  std::string name;                       ///< the text that it was parsed from: "kaiser:beta=8"
  std::function<double(double t)> value;  ///< for t in [0, 1]; 1 at ½, symmetric
};

struct WindowEntry {
  std::string_view name;
  std::string_view summary;
  std::string_view source;
  std::vector<Param> params;
  std::function<double(double t)> (*make)(std::span<const double> params);
};

/// none, hann, hamming, blackman, kaiser, tukey.
std::span<const WindowEntry> windows();

/// Errors    ErrorKind::Usage for an unknown name or parameter, or a value out of its range.
Window make_window(std::string_view text);

/// The window at the centres of n pixels: value((k + ½) / n).
std::vector<double> sampled(const Window& window, int n);

/// The mean of the samples, by which the peak of a wave in the spectrum is multiplied.
double coherent_gain(std::span<const double> samples);

/// n Σ w² / (Σ w)²: the equivalent noise bandwidth in bins; 1.5 for Hann.
double noise_bandwidth(std::span<const double> samples);

/// The plane multiplied by the window along x and along y.
Plane<float> windowed(const Plane<float>& plane, const Window& window);

}  // namespace zoneplate
