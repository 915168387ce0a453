// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/mat.h"

#include <cmath>
#include <utility>

namespace zoneplate {

float4x4 inverse(const float4x4& m) {
  // Gauss-Jordan elimination with row pivots on [m | 1].
  double a[4][8] = {};
  for (int c = 0; c < 4; ++c) {
    const float4 v = m.column[static_cast<std::size_t>(c)];
    a[0][c] = v.x, a[1][c] = v.y, a[2][c] = v.z, a[3][c] = v.w;
    a[c][4 + c] = 1;
  }
  for (int c = 0; c < 4; ++c) {
    int pivot = c;
    for (int r = c + 1; r < 4; ++r)
      if (std::abs(a[r][c]) > std::abs(a[pivot][c])) pivot = r;
    if (a[pivot][c] == 0) return {};
    for (int k = 0; k < 8; ++k) std::swap(a[c][k], a[pivot][k]);
    const double scale = a[c][c];
    for (int k = 0; k < 8; ++k) a[c][k] /= scale;
    for (int r = 0; r < 4; ++r) {
      const double f = a[r][c];
      if (r != c)
        for (int k = 0; k < 8; ++k) a[r][k] -= f * a[c][k];
    }
  }
  float4x4 out;
  for (int c = 0; c < 4; ++c)
    out.column[static_cast<std::size_t>(c)] = {static_cast<float>(a[0][4 + c]), static_cast<float>(a[1][4 + c]),
                                               static_cast<float>(a[2][4 + c]), static_cast<float>(a[3][4 + c])};
  return out;
}

}  // namespace zoneplate
