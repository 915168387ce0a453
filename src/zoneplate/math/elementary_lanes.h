// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/elementary_rows.h"
#include "zoneplate/math/for_row.h"

/// The kernel of math/elementary_rows.h over a lane type of math/lanes.h.
namespace zoneplate::stages {

template <class F>
[[gnu::always_inline]] inline F evaluate_lanes(Elementary function, const float* a, const float* b) {
  const F x = F::load(a);
  switch (function) {
    case Elementary::Exp2:
      return exp2(x);
    case Elementary::Exp:
      return exp(x);
    case Elementary::Log2:
      return log2(x);
    case Elementary::Log:
      return log(x);
    case Elementary::Pow:
      return pow(x, F::load(b));
    case Elementary::Sin:
      return sin(x);
    case Elementary::Cos:
      return cos(x);
    case Elementary::Atan2:
      return atan2(x, F::load(b));
    case Elementary::Acos:
      return acos(x);
    case Elementary::Asin:
      return asin(x);
  }
  return F(0.0f);
}

template <class Full, class One>
[[gnu::flatten]] void evaluate(Elementary function, const float* a, const float* b, float* out, std::size_t n) {
  const bool has_two = function == Elementary::Pow || function == Elementary::Atan2;
  for_row<Full, One>(
      n, [&]<class F>(std::size_t i) { evaluate_lanes<F>(function, a + i, has_two ? b + i : nullptr).store(out + i); });
}

template <class Full, class One>
constexpr ElementaryKernels elementary_rows() {
  return {.evaluate = &evaluate<Full, One>};
}

}  // namespace zoneplate::stages
