#pragma once

#include <span>

namespace zoneplate {

/// An instruction set for which kernels are built. Scalar is the plain C++ twin; every one gives the same bits.
enum class Isa { Scalar, Sse4, Avx2, Avx512, Neon, Wasm };

/// Every set there is: those of x86-64 in order, then AArch64's and WebAssembly's.
inline constexpr Isa all_isas[] = {Isa::Scalar, Isa::Sse4, Isa::Avx2, Isa::Avx512, Isa::Neon, Isa::Wasm};

/// The sets that this machine can run, Scalar first.
std::span<const Isa> supported_isas();

/// The set that is used unless another is asked for.
inline Isa best_isa() { return supported_isas().back(); }

/// "scalar", "sse4", "avx2", "avx512", "neon", "wasm".
const char* name_of(Isa isa);

/// Chooses among the tables of one kernel set: `scalar` is the twin's, in plain C++; the others are static members of
/// the table's own type. Each `foo_simd.cpp` is built once for every set of the machine's architecture and defines the
/// member that is named as Highway's namespace for the set; the others are defined nowhere.
template <class Table>
const Table& pick([[maybe_unused]] Isa isa, const Table& scalar) {
#if defined(__x86_64__)
  if (isa == Isa::Avx512) return Table::N_AVX3;
  if (isa == Isa::Avx2) return Table::N_AVX2;
  if (isa == Isa::Sse4) return Table::N_SSE4;
#elif defined(__aarch64__)
  if (isa == Isa::Neon) return Table::N_NEON;
#elif defined(__wasm_simd128__)
  if (isa == Isa::Wasm) return Table::N_WASM;
#endif
  return scalar;
}

}  // namespace zoneplate
