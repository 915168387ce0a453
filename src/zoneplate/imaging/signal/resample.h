// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/imaging/signal/result.h"
#include "zoneplate/signal/border.h"

namespace zoneplate {

struct ResamplingOptions : SignalOptions {
  std::string size;  ///< "640x480", or a factor: "0.5", "50%"
  std::string kernel = "lanczos3";
  Border border = Border::Clamp;
  bool is_side_by_side = false;
};

/// Resamples an image to another size.
///
/// Errors    ErrorKind::Usage for the text of the size.
void resample_image(const std::string& input, const ResamplingOptions& args, Delivery& out);

}  // namespace zoneplate
