// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace zoneplate::cli {

enum class ProgressKind {
  None,
  Bar,   ///< one line on stderr, rewritten in place and wiped at the end
  Json,  ///< one line a step: {"stage":"render","done":0.4}
};

/// Reports the progress of a command on stderr, for people or programs.
class Progress {
 public:
  explicit Progress(ProgressKind kind) : kind_(kind) {}
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Reports that `stage` begins, with the fraction `done` of all work, in [0, 1], completed.
  void begin(std::string_view stage, double done);

 private:
  ProgressKind kind_;
};

/// The kind for a text of --progress: "auto" (a bar on a terminal, else none), "bar", "json" or "none".
ProgressKind parse_progress(const std::string& text);

}  // namespace zoneplate::cli
