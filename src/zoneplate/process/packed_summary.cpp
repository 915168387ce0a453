// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/process/packed_summary.h"

#include "zoneplate/process/packed.h"

namespace zoneplate {

std::vector<std::uint8_t> pack_summary(const Summary& summary) {
  Packer out;
  out.value(summary.width), out.value(summary.height), out.value(summary.threads), out.value(summary.frames),
      out.value(summary.exposure);
  out.value(summary.counts);
  out.value(summary.peak_memory);
  out.value(std::uint64_t{summary.times.size()});
  for (const auto& [name, ms] : summary.times) out.text(name), out.value(ms);
  out.value(std::uint64_t{summary.warnings.size()});
  for (const std::string& warning : summary.warnings) out.text(warning);
  return std::move(out).bytes();
}

Summary unpack_summary(std::span<const std::uint8_t> bytes) {
  Unpacker in(bytes);
  Summary out;
  out.width = in.value<int>(), out.height = in.value<int>(), out.threads = in.value<int>();
  out.frames = in.value<int>();
  out.exposure = in.value<float>();
  out.counts = in.value<RenderCounts>();
  out.peak_memory = in.value<std::uint64_t>();
  for (auto n = in.value<std::uint64_t>(); n > 0; --n) {
    std::string name = in.text();
    out.times.emplace_back(std::move(name), in.value<double>());
  }
  for (auto n = in.value<std::uint64_t>(); n > 0; --n) out.warnings.push_back(in.text());
  return out;
}

}  // namespace zoneplate
