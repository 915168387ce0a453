// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zoneplate::metrics {

/// Powers and roots in double, with the same bits on every machine and compiler; based on signal/functions.h.

/// x to the power of y, x finite. Edges: 0 for x <= 0. Exact: within 1e-15 (1 + |y ln x|), relative.
double power(double x, double y);

/// The cube root of x, finite. Edges: 0 for x <= 0. Exact: within 4e-16, relative.
double cube_root(double x);

/// Edges: -infinity for x <= 0; infinity at infinity. Exact: within 1e-15, relative or absolute.
double decimal_log(double x);
double binary_log(double x);

}  // namespace zoneplate::metrics
