// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#pragma GCC visibility push(default)
namespace zoneplate {

/// An instruction set for which kernels are built. Scalar is the plain C++ twin; all give the same bits.
enum class Isa {
  Scalar,  ///< plain C++, on every processor
  Sse4,    ///< x86-64 with SSE4.2
  Avx2,    ///< x86-64 with AVX2
  Avx512,  ///< x86-64 with AVX-512 F, BW, DQ and VL
  Neon,    ///< 64-bit ARM
  Wasm,    ///< WebAssembly with simd128
};

/// All instruction sets: those of x86-64 in order, then those of AArch64 and WebAssembly.
inline constexpr Isa all_isas[] = {Isa::Scalar, Isa::Sse4, Isa::Avx2, Isa::Avx512, Isa::Neon, Isa::Wasm};

/// The instruction sets that this machine supports, Scalar first.
std::span<const Isa> supported_isas();

/// The fastest supported instruction set.
inline Isa best_isa() { return supported_isas().back(); }

/// The instruction set of the innermost enclosing `with_isa`; best_isa() outside of any.
Isa current_isa();
/// Sets what `current_isa` returns on this thread and returns what it returned before, for threads that work on behalf
/// of another (base/parallel.cpp).
Isa exchange_isa(Isa isa);

/// Runs `body`, the loops of base/parallel.h in it included, with the kernels of one set, and returns what it returns.
///
/// Requires  a supported set.
template <class Body>
decltype(auto) with_isa(Isa isa, const Body& body) {
  struct Restore {
    Isa outer;
    ~Restore() { exchange_isa(outer); }
  } const restore{exchange_isa(isa)};
  return body();
}

/// "scalar", "sse4", "avx2", "avx512", "neon", "wasm".
const char* name_of(Isa isa);

#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wundefined-var-template"  // each table is defined in a source of its own
#endif

/// The base of a table of kernels, a struct of pointers to functions: one table for each instruction set.
///
/// `foo.cpp` defines `scalar`, the plain C++ twin. `foo_simd.cpp` is built once for every set of the machine's
/// architecture and defines the member that is named as Highway's namespace for the set:
///
///     template <>
///     const FooKernels PerIsa<FooKernels>::HWY_NAMESPACE = {.sum = HWY_NAMESPACE::sum};
///
/// Where both are one text it is a template over the lane types of math/lanes.h, in `foo_lanes.h`; `foo.cpp`
/// instantiates it for single numbers and `foo_simd.cpp` for vectors.
template <class Table>
struct PerIsa {
  static const Table scalar, N_SSE4, N_AVX2, N_AVX3, N_NEON, N_WASM;  ///< those of other architectures are not defined

  /// The table of one instruction set.
  static const Table& of([[maybe_unused]] Isa isa = current_isa()) {
#if defined(__x86_64__)
    if (isa == Isa::Avx512) return N_AVX3;
    if (isa == Isa::Avx2) return N_AVX2;
    if (isa == Isa::Sse4) return N_SSE4;
#elif defined(__aarch64__)
    if (isa == Isa::Neon) return N_NEON;
#elif defined(ZONEPLATE_WITHOUT_SCALAR_TWINS)
    return N_WASM;
#elif defined(__wasm_simd128__)
    if (isa == Isa::Wasm) return N_WASM;
#endif
    return scalar;
  }
};

#if defined(__clang__)
#pragma clang diagnostic pop
#endif

}  // namespace zoneplate
#pragma GCC visibility pop
