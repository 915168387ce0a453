// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "zoneplate/base/clock.h"

namespace zoneplate::cli {

enum class ProgressKind {
  None,
  Bar,   ///< one line on stderr, updated in place and cleared at the end
  Json,  ///< one line per step: {"stage":"render","done":0.4}
};

/// Reports the progress of a command on stderr, for people or programs.
class Progress {
 public:
  explicit Progress(ProgressKind kind) : kind_(kind) {}
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Reports that `stage` begins, when the fraction `done` of all work, in [0, 1], is complete.
  /// After two seconds the bar also shows the time that is left if the rest is as fast.
  void begin(std::string_view stage, double done);

  bool is_shown() const { return kind_ != ProgressKind::None; }

  /// Clears the bar, so that other lines can be printed.
  void clear();

 private:
  ProgressKind kind_;
  Stopwatch watch_;
};

/// Parses the value of --progress: "auto" (a bar on a terminal, else none), "bar", "json" or "none".
ProgressKind parse_progress(const std::string& text);

}  // namespace zoneplate::cli
