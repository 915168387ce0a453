#include "zoneplate/base/isa.h"

#include <cstddef>

namespace zoneplate {

std::span<const Isa> supported_isas() {
  static constexpr Isa all[] = {Isa::Scalar, Isa::Sse4, Isa::Avx2};
  const bool sse4 = __builtin_cpu_supports("sse4.2");
  const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
                    __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
  return std::span(all).first(avx2 ? std::size_t{3} : sse4 ? std::size_t{2} : std::size_t{1});
}

const char* name_of(Isa isa) { return isa == Isa::Avx2 ? "avx2" : isa == Isa::Sse4 ? "sse4" : "scalar"; }

}  // namespace zoneplate
