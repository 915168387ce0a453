#include "zoneplate/math/elementary_simd.h"

#include "zoneplate/math/elementary_kernels.h"
#include "zoneplate/math/for_lanes_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {

template <class D>
HWY_INLINE hn::Vec<D> evaluate_vector(D d, Elementary function, const float* a, const float* b) {
  const auto x = hn::LoadU(d, a);
  switch (function) {
    case Elementary::Exp2:
      return exp2(d, x);
    case Elementary::Exp:
      return exp(d, x);
    case Elementary::Log2:
      return log2(d, x);
    case Elementary::Log:
      return log(d, x);
    case Elementary::Pow:
      return pow(d, x, hn::LoadU(d, b));
    case Elementary::Sin:
      return sin(d, x);
    case Elementary::Cos:
      return cos(d, x);
    case Elementary::Atan2:
      return atan2(d, x, hn::LoadU(d, b));
    case Elementary::Acos:
      return acos(d, x);
    case Elementary::Asin:
      return asin(d, x);
  }
  return hn::Zero(d);
}

void evaluate(Elementary function, const float* a, const float* b, float* out, std::size_t n) {
  const bool has_two = function == Elementary::Pow || function == Elementary::Atan2;
  const auto second = [&](std::size_t i) { return has_two ? b + i : nullptr; };
  for_lanes(n, [&](auto d, std::size_t i)
                   HWY_ATTR { hn::StoreU(evaluate_vector(d, function, a + i, second(i)), d, out + i); });
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const ElementaryKernels PerIsa<ElementaryKernels>::HWY_NAMESPACE = {.evaluate = HWY_NAMESPACE::evaluate};
}  // namespace zoneplate
