// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/size_text.h"
#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The remaining limits of one import, and the name of its file for error messages. Bytes are charged before they are
/// allocated.
class ImportBudget {
 public:
  ImportBudget(const std::string& file, const LoadLimits& limits)
      : file_(file), limits_(limits), left_(limits.memory) {}

  const std::string& file() const { return file_; }
  const LoadLimits& limits() const { return limits_; }
  std::uint64_t memory_left() const { return left_; }

  /// Errors    ErrorKind::Input if fewer than `bytes` are left, and in all later calls.
  void take(std::uint64_t bytes) {
    is_spent_ = is_spent_ || bytes > left_;
    if (is_spent_)
      throw Error(ErrorKind::Input,
                  file_ + ": needs more than the limit of " + size_text(limits_.memory) + " (--max-memory)");
    left_ -= bytes;
  }
  /// Returns bytes that were taken and freed.
  void give_back(std::uint64_t bytes) { left_ += bytes; }

  /// Resets the budget to `left` bytes and restarts the time, for another import from the same open file.
  void restart(std::uint64_t left) { left_ = left, is_spent_ = false, clock_ = Stopwatch(); }

  bool has_time() const { return clock_.ms() <= limits_.seconds * 1000; }
  /// Errors    ErrorKind::Input if the time limit is exceeded; those of base/deadline.h.
  void check_time() const {
    check_deadline();
    if (!has_time())
      throw Error(ErrorKind::Input, file_ + ": takes longer to load than the limit of " +
                                        std::to_string(static_cast<std::int64_t>(limits_.seconds * 1000)) +
                                        " ms (--max-import-seconds)");
  }

  /// Warns of an invalid part that is left out.
  ///
  /// Errors    ErrorKind::Input with the warning's text if the limits are strict.
  void warn_of_flaw(std::vector<std::string>& warnings, std::string text) const {
    if (limits_.is_strict) throw Error(ErrorKind::Input, text);
    warnings.push_back(std::move(text));
  }

  /// The error about a file of which nothing is left to draw: its first warning, or `cause`, as "holds no vertices".
  Error nothing_to_draw(const std::vector<std::string>& warnings, const std::string& cause) const {
    return {ErrorKind::Input, warnings.empty() ? file_ + ": " + cause : warnings.front() + "; nothing is left to draw"};
  }

 private:
  std::string file_;
  LoadLimits limits_;
  std::uint64_t left_;
  bool is_spent_ = false;
  Stopwatch clock_;
};

/// Appends to an array whose memory is charged to the budget.
template <class T>
void append_charged(std::vector<T>& values, T value, ImportBudget& budget) {
  if (values.size() == values.capacity()) {
    const std::size_t old = values.capacity(), grown = old < 8 ? 16 : 2 * old;
    budget.take(grown * sizeof(T));
    values.reserve(grown);
    budget.give_back(old * sizeof(T));
  }
  values.push_back(std::move(value));
}

}  // namespace zoneplate
