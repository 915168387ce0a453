// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/image/plane.h"

namespace zoneplate {

/// The value of --kernel of `zoneplate signal convolve`.
///
/// A name of the list (`gaussian:sigma=2`), numbers ("1/4 1/2 1/4"; rows are separated by semicolons or line ends), or
/// a file of such numbers, in which # starts a comment.
struct KernelChoice {
  std::string name;
  std::vector<double> taps;  ///< taps of a named kernel, the same for rows and columns; else empty
  Plane<float> weights;      ///< the two-dimensional kernel

  bool is_separable() const { return !taps.empty(); }
  double sum() const;
};

/// Errors    ErrorKind::Usage for any other text, ErrorKind::Input for a file with other contents.
KernelChoice parse_kernel_choice(const std::string& text);

/// Whether the value of --kernel is the name of a file.
bool is_kernel_file(const std::string& text);

/// Parses "1 3/4 -.5": numbers and fractions separated by spaces and commas; rows separated by semicolons and line
/// ends, all of the same length.
///
/// Errors    ErrorKind::Usage naming the text that is not a number.
Plane<double> parse_number_rows(const std::string& text);

}  // namespace zoneplate
