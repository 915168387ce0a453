#pragma once

#include <span>

namespace zoneplate {

/// An instruction set for which kernels are built. Scalar is the plain C++ twin; every one gives the same bits.
enum class Isa { Scalar, Sse4, Avx2 };

/// The sets that this machine can run, Scalar first, the best last.
std::span<const Isa> supported_isas();

inline Isa best_isa() { return supported_isas().back(); }

/// "scalar", "sse4", "avx2".
const char* name_of(Isa isa);

/// Chooses among the tables of one kernel set. Each `foo_simd.cpp` is built once per set and defines its table in
/// Highway's namespace for it (N_SSE4, N_AVX2); the scalar twin defines its own in zoneplate::scalar.
template <class Table>
const Table& pick(Isa isa, const Table& scalar, const Table& sse4, const Table& avx2) {
  return isa == Isa::Avx2 ? avx2 : isa == Isa::Sse4 ? sse4 : scalar;
}

}  // namespace zoneplate
