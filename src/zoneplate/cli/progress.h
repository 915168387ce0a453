#pragma once

#include <string>
#include <string_view>

namespace zoneplate::cli {

enum class ProgressKind {
  None,
  Bar,   ///< one line on stderr, rewritten in place and wiped at the end
  Json,  ///< one line a step: {"stage":"render","done":0.4}
};

/// Tells people or programs how far a command has come, on stderr.
class Progress {
 public:
  explicit Progress(ProgressKind kind) : kind_(kind) {}
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `stage` begins, when the share `done` of the whole work, in [0, 1], is behind.
  void begin(std::string_view stage, double done);

 private:
  ProgressKind kind_;
};

/// The kind for a text of --progress: "auto" (a bar on a terminal, else none), "bar", "json" or "none".
ProgressKind parse_progress(const std::string& text);

}  // namespace zoneplate::cli
