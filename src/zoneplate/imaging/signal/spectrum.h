// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/imaging/signal/result.h"

namespace zoneplate {

/// What of a spectrum is written.
enum class SpectrumView { Magnitude, Phase, Radial, Everything };

struct SpectrumOptions : SignalOptions {
  std::string window = "none";
  bool is_periodic = false;
  double range_db = 80;
  SpectrumView shown = SpectrumView::Magnitude;
};

/// The name of a window, with its parameters.
///
/// Errors    those of make_window (signal/fourier/window.h).
std::string window_name(const std::string& text);

/// Computes the spectrum of an image, writes a view of it, and prints its statistics.
void analyse_spectrum(const std::string& input, const SpectrumOptions& args, Delivery& out);

}  // namespace zoneplate
