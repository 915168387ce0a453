// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/network/network_rows_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate {
namespace HWY_NAMESPACE {
namespace {

template <class F>
class Products {
  using Sum = typename F::Int::IntTag;
  using Narrow = hn::Repartition<std::int16_t, Sum>;

 public:
  using Weights = hn::Vec<Narrow>;
  using Inputs = Weights;

  HWY_INLINE Products() : sum_(hn::Zero(Sum())), rest_(hn::Zero(Sum())) {}
  static HWY_INLINE Weights load(const std::int16_t* weights) { return hn::LoadU(Narrow(), weights); }
  static HWY_INLINE Inputs both(std::int32_t pair) { return hn::BitCast(Narrow(), hn::Set(Sum(), pair)); }
  HWY_INLINE void add(Weights weights, Inputs inputs) {
    sum_ = hn::ReorderWidenMulAccumulate(Sum(), weights, inputs, sum_, rest_);
  }
  HWY_INLINE typename F::Int total() const { return typename F::Int(hn::RearrangeToOddPlusEven(sum_, rest_)); }

 private:
  // Some instruction sets add the products of a pair in the end, and keep them in two vectors until then.
  hn::Vec<Sum> sum_, rest_;
};

}  // namespace
}  // namespace HWY_NAMESPACE

template <>
const NetworkKernels PerIsa<NetworkKernels>::HWY_NAMESPACE =
    stages::network_rows<HWY_NAMESPACE::WideFloat, HWY_NAMESPACE::Float, HWY_NAMESPACE::Products>();
}  // namespace zoneplate
HWY_AFTER_NAMESPACE();
