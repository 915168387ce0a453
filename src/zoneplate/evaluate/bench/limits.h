// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The limits of the machine with the threads of the innermost `with_threads`, for comparison with stage times.
struct MachineLimits {
  double read_gb_s = 0, write_gb_s = 0;  ///< memory, not caches: 10^9 bytes per second, all threads together
  double clear_ms = 0;                   ///< overwriting 1920 × 1080 pixels of colour and depth, 8 bytes each
  double first_touch_ms = 0;             ///< the same bytes in newly allocated memory, including page faults
  double gather_l1_ns = 0, gather_l2_ns = 0, gather_l3_ns = 0;  ///< eight words from 8 KiB, 256 KiB, 4 MiB; one thread
};

/// Measures each limit as the best of several turns; takes some tenths of a second.
MachineLimits measure_limits();

struct LimitKernels : PerIsa<LimitKernels> {
  /// The sum of n words. Requires: n is a multiple of 32.
  std::uint32_t (*sum)(const std::uint32_t* words, std::size_t n);
  /// The sum of table[index[i]] for n indices. Requires: n is a multiple of 32.
  std::uint32_t (*gather)(const std::uint32_t* table, const std::int32_t* index, std::size_t n);
  /// The sum of `turns` times 3 values[i] for `factors` values, modulo 2^32: as many multiplications of 16-bit
  /// integers, of which pairs are added.
  std::uint32_t (*multiply)(const std::int16_t* values, std::size_t turns);
  static constexpr std::size_t factors = 384;
};

}  // namespace zoneplate
