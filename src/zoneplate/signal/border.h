#pragma once

#include <cstdint>
#include <string_view>

#include "zoneplate/image/plane.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// What a filter finds outside the image, shown for a row abcd.
enum class Border {
  Clamp,    ///< aaaa abcd dddd
  Reflect,  ///< dcba abcd dcba: mirrored at the outer edge of the last pixel
  Wrap,     ///< abcd abcd abcd
  Zero,     ///< 0000 abcd 0000
  Cut,      ///< nothing: of a kernel that reaches beyond, the rest is divided by its sum; for resample() alone
};

/// "clamp", "reflect", "wrap", "zero", "cut".
const char* name_of(Border border);

/// Errors    ErrorKind::Usage for another name.
Border parse_border(std::string_view name);

/// Which of the n pixels stands at index i, which may be far outside; -1 for none (Zero, Cut).
///
/// Requires  n >= 1.
int border_index(int i, int n, Border border);

/// How many pixels are added on each side.
struct Margins {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// The plane with its border written out; a plane without pixels stays as it is.
template <class T>
Plane<T> padded(const Plane<T>& plane, Margins margins, Border border);

/// The width × height pixels from (left, top) on.
template <class T>
Plane<T> cropped(const Plane<T>& plane, int left, int top, int width, int height);

extern template Plane<float> padded(const Plane<float>&, Margins, Border);
extern template Plane<double> padded(const Plane<double>&, Margins, Border);
extern template Plane<Linear> padded(const Plane<Linear>&, Margins, Border);
extern template Plane<float> cropped(const Plane<float>&, int, int, int, int);
extern template Plane<double> cropped(const Plane<double>&, int, int, int, int);
extern template Plane<Linear> cropped(const Plane<Linear>&, int, int, int, int);

}  // namespace zoneplate
