// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/isa.h"

#include <cstddef>
#include <utility>

namespace zoneplate {
namespace {

thread_local Isa isa_of_thread = best_isa();

}  // namespace

Isa current_isa() { return isa_of_thread; }

Isa exchange_isa(Isa isa) { return std::exchange(isa_of_thread, isa); }

std::span<const Isa> supported_isas() {
#if defined(__x86_64__)
  const bool sse4 = __builtin_cpu_supports("sse4.2");
  const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
                    __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  return std::span(all_isas).first(avx512 ? std::size_t{4} : avx2 ? std::size_t{3} : sse4 ? std::size_t{2} : 1);
#elif defined(__aarch64__)
  static constexpr Isa all[] = {Isa::Scalar, Isa::Neon};
  return all;
#elif defined(ZONEPLATE_WITHOUT_SCALAR_TWINS)  // the page, which selects none and has to be small
  return std::span(all_isas).last(1);
#elif defined(__wasm_simd128__)
  static constexpr Isa all[] = {Isa::Scalar, Isa::Wasm};
  return all;
#else
  return std::span(all_isas).first(1);
#endif
}

const char* name_of(Isa isa) {
  switch (isa) {
    case Isa::Scalar:
      return "scalar";
    case Isa::Sse4:
      return "sse4";
    case Isa::Avx2:
      return "avx2";
    case Isa::Avx512:
      return "avx512";
    case Isa::Neon:
      return "neon";
    case Isa::Wasm:
      return "wasm";
  }
  return "";
}

}  // namespace zoneplate
