// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/kernel.h"

namespace zoneplate::cli {

enum class Via { Space, Frequency, Both };

struct ConvolveArgs : SignalArgs {
  KernelChoice kernel = parse_kernel_choice("gaussian:sigma=2");
  std::string kernel_file;              ///< instead of `kernel`, a file that is read within the limits
  std::optional<Plane<double>> values;  ///< one row, instead of an image
  Via via = Via::Space;
  Border border = Border::Clamp;
  bool is_side_by_side = false;
};

/// Prints the convolution of `values`, and plots it if there is an output.
///
/// Errors    ErrorKind::Usage for a kernel of more than one row.
void convolve_row(const ConvolveArgs& args, Delivery& out);

}  // namespace zoneplate::cli
