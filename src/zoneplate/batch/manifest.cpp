// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <span>

#include "zoneplate/base/error.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

constexpr std::size_t max_jobs = 1'000'000, max_line_bytes = std::size_t{1} << 16, block_bytes = std::size_t{1} << 20;

}  // namespace

Manifest::Manifest(const std::string& path, std::uint64_t max_bytes) : name_(path == "-" ? "standard input" : path) {
  std::uint64_t bytes = 0;
  read_parts(path, [&](std::span<const std::uint8_t> part) {
    bytes += part.size();
    if (bytes > max_bytes)
      throw Error(ErrorKind::Input, fmt::format("{}: a manifest of more than {} bytes, half of --max-memory: split it",
                                                name_, max_bytes));
    std::string_view text(reinterpret_cast<const char*>(part.data()), part.size());
    for (;;) {
      const std::size_t end = text.find('\n');
      line_ += text.substr(0, std::min(end, max_line_bytes + 1));
      if (line_.size() > max_line_bytes)
        throw Error(ErrorKind::Input, fmt::format("{}: longer than {} bytes", place_of(number_ + 1), max_line_bytes));
      if (end == text.npos) return true;
      end_line();
      text.remove_prefix(end + 1);
    }
  });
  end_line();
}

std::string Manifest::place_of(std::uint64_t number) const { return fmt::format("{}: line {}", name_, number); }

void Manifest::end_line() {
  ++number_;
  if (line_.find_first_not_of(" \t\r") != line_.npos) {
    if (lines_.size() == max_jobs)
      throw Error(ErrorKind::Input, fmt::format("{}: a manifest of more than {} jobs: split it", name_, max_jobs));
    if (blocks_.empty() || used_ + line_.size() > block_bytes) {
      blocks_.push_back(std::make_unique_for_overwrite<char[]>(block_bytes));
      used_ = 0;
    }
    char* const place = blocks_.back().get() + used_;
    std::memcpy(place, line_.data(), line_.size());
    used_ += line_.size();
    lines_.push_back({{place, line_.size()}, static_cast<std::uint32_t>(number_)});
  }
  line_.clear();
}

}  // namespace zoneplate
