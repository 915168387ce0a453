// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "zoneplate/image/plane.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// How a filter extends an image beyond its border, shown for a row abcd.
enum class Border {
  Clamp,    ///< aaaa abcd dddd
  Reflect,  ///< dcba abcd dcba: mirrored at the outer edge of the last pixel
  Wrap,     ///< abcd abcd abcd
  Zero,     ///< 0000 abcd 0000
  Cut,      ///< no extension: the weights inside are divided by their sum; for resample() only
};

/// "clamp", "reflect", "wrap", "zero", "cut".
const char* name_of(Border border);

/// Errors    ErrorKind::Usage for another name.
Border parse_border(std::string_view name);

/// The index of the pixel, of n, that replaces index i, which may be far outside; -1 if the value is 0 or omitted
/// (Zero, Cut).
///
/// Requires  n >= 1.
int border_index(int i, int n, Border border);

/// The number of pixels to add on each side.
struct Margins {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// The plane with margins filled according to `border`; a plane without pixels is unchanged.
template <class T>
Plane<T> padded(const Plane<T>& plane, Margins margins, Border border);

/// The region of width × height pixels whose top-left pixel is (left, top).
template <class T>
Plane<T> cropped(const Plane<T>& plane, int left, int top, int width, int height);

extern template Plane<float> padded(const Plane<float>&, Margins, Border);
extern template Plane<double> padded(const Plane<double>&, Margins, Border);
extern template Plane<Linear> padded(const Plane<Linear>&, Margins, Border);
extern template Plane<float> cropped(const Plane<float>&, int, int, int, int);
extern template Plane<double> cropped(const Plane<double>&, int, int, int, int);
extern template Plane<Linear> cropped(const Plane<Linear>&, int, int, int, int);

}  // namespace zoneplate
