// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/size_text.h"

#include <fmt/format.h>

namespace zoneplate {

std::string size_text(std::uint64_t bytes) {
  constexpr std::uint64_t unit = 1024;
  if (bytes < unit) return fmt::format("{} byte{}", bytes, bytes == 1 ? "" : "s");
  double number = static_cast<double>(bytes) / unit;
  const char* name = "kB";
  for (const char* larger : {"MB", "GB"})
    if (number >= unit) number /= unit, name = larger;
  // Four digits, without zeros at the end; a whole number is not rounded.
  return number < 1000 ? fmt::format("{:.4g} {}", number, name) : fmt::format("{:.0f} {}", number, name);
}

}  // namespace zoneplate
