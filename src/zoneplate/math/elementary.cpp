#include "zoneplate/math/elementary.h"

#include "zoneplate/math/elementary_kernels.h"

namespace zoneplate::scalar {
namespace {

float evaluate_one(Elementary function, float a, const float* b) {
  switch (function) {
    case Elementary::Exp2:
      return exp2(a);
    case Elementary::Exp:
      return exp(a);
    case Elementary::Log2:
      return log2(a);
    case Elementary::Log:
      return log(a);
    case Elementary::Pow:
      return pow(a, *b);
    case Elementary::Sin:
      return sin(a);
    case Elementary::Cos:
      return cos(a);
    case Elementary::Atan2:
      return atan2(a, *b);
    case Elementary::Acos:
      return acos(a);
    case Elementary::Asin:
      return asin(a);
  }
  return 0;
}

void evaluate(Elementary function, const float* a, const float* b, float* out, std::size_t n) {
  const bool has_two = function == Elementary::Pow || function == Elementary::Atan2;
  for (std::size_t i = 0; i < n; ++i) out[i] = evaluate_one(function, a[i], has_two ? b + i : nullptr);
}

}  // namespace

}  // namespace zoneplate::scalar

namespace zoneplate {

template <>
const ElementaryKernels PerIsa<ElementaryKernels>::scalar = {.evaluate = scalar::evaluate};

}  // namespace zoneplate
