// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/shard.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "zoneplate/base/error.h"

namespace zoneplate::cli {
namespace {

std::optional<std::uint64_t> find_whole(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, trouble] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (trouble != std::errc{} || end != text.data() + text.size() || value > 1'000'000'000) return std::nullopt;
  return value;
}

std::optional<std::uint64_t> find_variable(const char* name) {
  const char* const text = std::getenv(name);
  return text != nullptr ? find_whole(text) : std::nullopt;
}

}  // namespace

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  const std::string_view first = std::string_view(text).substr(0, slash);
  std::optional<std::uint64_t> index = find_whole(first);
  std::uint64_t count = slash == text.npos ? 0 : find_whole(std::string_view(text).substr(slash + 1)).value_or(0);
  if (first == "auto") {
    index = find_variable("SLURM_ARRAY_TASK_ID");
    if (index) *index -= std::min(*index, find_variable("SLURM_ARRAY_TASK_MIN").value_or(0));
    if (!index) index = find_variable("JOB_COMPLETION_INDEX");
    if (slash == text.npos) count = find_variable("SLURM_ARRAY_TASK_COUNT").value_or(0);
    if (!index || count == 0)
      throw Error(ErrorKind::Usage, fmt::format("'{}': neither SLURM_ARRAY_TASK_ID and SLURM_ARRAY_TASK_COUNT nor "
                                                "JOB_COMPLETION_INDEX give the index of the shard",
                                                text));
  }
  if (!index || *index >= count)
    throw Error(ErrorKind::Usage, fmt::format("'{}' is not a shard i/n with i from 0 to n - 1, nor auto", text));
  return {*index, count};
}

}  // namespace zoneplate::cli
