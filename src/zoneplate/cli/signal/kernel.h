// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/image/plane.h"

namespace zoneplate::cli {

/// The --kernel of `zoneplate signal convolve`.
///
/// A name of the list (`gaussian:sigma=2`), numbers ("1/4 1/2 1/4"; rows end at a semicolon or line end), or a file of
/// such numbers, in which # begins a comment.
struct KernelChoice {
  std::string name;
  std::vector<double> taps;  ///< of a name: the same along rows and columns; else empty
  Plane<float> weights;      ///< all of it

  bool is_separable() const { return !taps.empty(); }
  double sum() const;
};

/// Errors    ErrorKind::Usage for text that is none of these, ErrorKind::Input for a file that holds something else.
KernelChoice parse_kernel_choice(const std::string& text);

/// "1 3/4 -.5": numbers and fractions at spaces and commas; rows at semicolons and line ends, all of one length.
///
/// Errors    ErrorKind::Usage naming the text that is no number.
Plane<double> parse_number_rows(const std::string& text);

}  // namespace zoneplate::cli
