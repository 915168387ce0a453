// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/network/network_rows.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/network/network_rows_lanes.h"

namespace zoneplate {
namespace {

template <class>
class Products {
 public:
  struct Weights {
    std::int16_t pair[2];
  };
  using Inputs = Weights;

  static Weights load(const std::int16_t* weights) { return {weights[0], weights[1]}; }
  static Inputs both(std::int32_t pair) {
    Inputs out;
    std::memcpy(out.pair, &pair, sizeof pair);
    return out;
  }
  void add(Weights weights, Inputs inputs) {
    sum_ += weights.pair[0] * inputs.pair[0] + weights.pair[1] * inputs.pair[1];
  }
  scalar::Int total() const { return sum_; }

 private:
  std::int32_t sum_ = 0;
};

}  // namespace

template <>
const NetworkKernels PerIsa<NetworkKernels>::scalar =
    stages::network_rows<scalar::WideFloat, scalar::Float, Products>();

}  // namespace zoneplate
