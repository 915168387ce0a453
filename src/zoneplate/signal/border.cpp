// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/border.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {

const char* name_of(Border border) {
  static constexpr const char* names[] = {"clamp", "reflect", "wrap", "zero", "cut"};
  return names[static_cast<int>(border)];
}

Border parse_border(std::string_view name) {
  for (const Border border : {Border::Clamp, Border::Reflect, Border::Wrap, Border::Zero, Border::Cut})
    if (name == name_of(border)) return border;
  throw Error(ErrorKind::Usage, fmt::format("no border rule '{}'; expected clamp, reflect, wrap, zero or cut", name));
}

int border_index(int i, int n, Border border) {
  assert(n >= 1);
  if (i >= 0 && i < n) return i;
  const auto modulo = [](std::int64_t a, std::int64_t m) { return static_cast<int>(((a % m) + m) % m); };
  switch (border) {
    case Border::Clamp:
      return std::clamp(i, 0, n - 1);
    case Border::Reflect: {
      const int period = modulo(i, 2 * std::int64_t{n});
      return period < n ? period : 2 * n - 1 - period;
    }
    case Border::Wrap:
      return modulo(i, n);
    case Border::Zero:
    case Border::Cut:
      break;
  }
  return -1;
}

template <class T>
Plane<T> padded(const Plane<T>& plane, Margins margins, Border border) {
  if (plane.empty()) return plane;
  const int w = plane.width() + margins.left + margins.right, h = plane.height() + margins.top + margins.bottom;
  T nothing{};
  if constexpr (std::is_same_v<T, Linear>) nothing.a = 0;
  Plane<T> out(w, h, nothing);
  parallel_for(static_cast<std::size_t>(h), [&](std::size_t row) {
    const int y = static_cast<int>(row), from_y = border_index(y - margins.top, plane.height(), border);
    if (from_y < 0) return;
    const auto from = plane.row(from_y);
    const auto to = out.row(y);
    for (int x = 0; x < w; ++x) {
      const int from_x = border_index(x - margins.left, plane.width(), border);
      if (from_x >= 0) to[static_cast<std::size_t>(x)] = from[static_cast<std::size_t>(from_x)];
    }
  });
  return out;
}

template <class T>
Plane<T> cropped(const Plane<T>& plane, int left, int top, int width, int height) {
  assert(left >= 0 && top >= 0 && left + width <= plane.width() && top + height <= plane.height());
  Plane<T> out(width, height);
  for (int y = 0; y < height; ++y) std::copy_n(plane.row(top + y).begin() + left, width, out.row(y).begin());
  return out;
}

template Plane<float> padded(const Plane<float>&, Margins, Border);
template Plane<double> padded(const Plane<double>&, Margins, Border);
template Plane<Linear> padded(const Plane<Linear>&, Margins, Border);
template Plane<float> cropped(const Plane<float>&, int, int, int, int);
template Plane<double> cropped(const Plane<double>&, int, int, int, int);
template Plane<Linear> cropped(const Plane<Linear>&, int, int, int, int);

}  // namespace zoneplate
