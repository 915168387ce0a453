// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "zoneplate/imaging/signal/kernel.h"
#include "zoneplate/imaging/signal/result.h"
#include "zoneplate/signal/border.h"

namespace zoneplate {

/// The way of computing a convolution: by its definition, by the product of the spectra, or both, to compare them.
enum class Via { Space, Frequency, Both };

struct ConvolutionOptions : SignalOptions {
  KernelChoice kernel = parse_kernel_choice("gaussian:sigma=2");
  std::string kernel_file;              ///< instead of `kernel`, a file that is read within the limits
  std::optional<Plane<double>> values;  ///< one row, instead of an image
  Via via = Via::Space;
  Border border = Border::Clamp;
  bool is_side_by_side = false;
};

/// Convolves an image, or the row of `values`, with a kernel, and prints how the two ways of computing it compare.
///
/// Errors    ErrorKind::Usage for a row and a kernel of more than one row; ErrorKind::Input for a file that is no kernel.
void convolve_signal(const std::string& input, ConvolutionOptions args, Delivery& out);

/// Prints the convolution of `values`, and plots it if there is an output.
///
/// Errors    ErrorKind::Usage for a kernel of more than one row.
void convolve_row(const ConvolutionOptions& args, Delivery& out);

}  // namespace zoneplate
