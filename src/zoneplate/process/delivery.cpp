// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/process/delivery.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/job/import_time.h"
#include "zoneplate/process/packed_plots.h"

namespace zoneplate {

ProgramLimits video_limits(const ReadingLimits& limits) {
  ProgramLimits out{.milliseconds = 3'600'000, .bytes = std::size_t{1} << 34};
  out.bytes = static_cast<std::size_t>(std::min<std::uint64_t>(out.bytes, limits.load.memory));
  if (limits.seconds * 1000 < out.milliseconds) out.milliseconds = static_cast<int>(limits.seconds * 1000) + 1;
  return out;
}

void Delivery::warn(std::string_view message) {
  if (!repeats_warnings_) {
    std::string kind(message);
    std::erase_if(kind, [](char c) { return c >= '0' && c <= '9'; });
    const bool is_new = warnings_.insert(std::move(kind)).second;
    repeated_ += !is_new;
    if (!is_new) return;
  }
  sender_.text(TextKind::Warning, message);
}

void Delivery::tell_repeated(const std::string& input) {
  if (repeated_ == 0) return;
  const std::string text = repeated_ == 1 ? "1 more warning is one of those above"
                                          : fmt::format("{} more warnings are those above", repeated_);
  sender_.text(TextKind::Warning, fmt::format("{}: {}, of other frames", input, text));
  repeated_ = 0;
}

void Delivery::warn_of_flaw(const std::string& flaw) {
  if (flaw.empty()) return;
  if (limits_.is_strict) throw Error(ErrorKind::Input, flaw);
  warn(flaw);
}

void Delivery::save(const std::string& path, std::string_view text) {
  save(path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void Delivery::save_plots(const std::string& path, std::span<const Plot> plots, int columns, const PlotSize& size) {
  sender_.plots(path, pack_plots({{plots.begin(), plots.end()}, columns, size}));
}

void Delivery::save_figure(const std::string& path, const Figure& figure, const PlotSize& size) {
  sender_.plots(path, pack_plots({.plots = {}, .size = size, .figure = figure}));
}

void Delivery::read(const std::string& input, const std::function<void()>& body) {
  sender_.begins_to_read(input);
  within_import_time(input, limits_, body);
  sender_.has_read();
}

}  // namespace zoneplate
