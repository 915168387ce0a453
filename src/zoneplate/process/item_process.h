// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/base/clock.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/os/limited_child.h"
#include "zoneplate/process/item_messages.h"

namespace zoneplate {

/// The limits of an item's process.
struct ItemLimits {
  std::string name;                                          ///< the item's model, the prefix of error messages
  LoadLimits load;                                           ///< its memory limit applies to all work of the item
  double seconds = std::numeric_limits<double>::infinity();  ///< elapsed time limit of the whole item
  bool is_sandboxed = true;                                  ///< if the kernel supports sandboxes
  std::optional<std::vector<std::string>> readable = {};     ///< files and folders; nothing: every file
  bool ignores_termination = false;                          ///< SIGTERM ends it only with the program
  LimitedChildren* siblings = nullptr;                       ///< the processes that work at the same time
  std::function<void()> open = {};                           ///< runs in the process before it is confined
  bool names_errors = true;                                  ///< errors begin with `name`
  const char* work = "drawing it";                           ///< after reading, in messages about memory
};

/// Runs the work of one item, or of several items with one model, in a separate process: a sandboxed fork of this one
/// (os/limited_child.h) with limits of memory and time.
///
/// A crash of that process does not affect this one. It writes no files itself: they arrive here as bytes. If it needs
/// a library, that is opened here, and the job is restarted.
class ItemProcess {
 public:
  /// Runs job `i` and returns its result.
  using Work = std::function<std::vector<std::uint8_t>(std::size_t job, ItemSender& sender)>;

  ItemProcess(ItemLimits limits, std::size_t jobs, Work work);
  ~ItemProcess();

  /// Starts the process of the first job, if possible; otherwise `next` starts it and reports the error.
  void start_ahead() noexcept;
  /// Whether a process is at work whose answers are not yet complete in memory.
  bool is_working() const { return child_ && !child_->has_ended(); }

  /// The result of the next job. The first call starts the process if it does not run yet. The handlers has_read and
  /// needs_library are added here.
  ///
  /// Errors    exceptions of the job; if its process runs out of memory or time or is ended by a signal, an ItemError
  ///           with that cause, of ErrorKind::Input while it reads its model and ErrorKind::Failed after that;
  ///           exceptions of the handlers.
  ///           The next call continues with the following job, in a new process.
  std::vector<std::uint8_t> next(ItemEvents events);

 private:
  void start(std::size_t first);
  void work_on(std::size_t first, ChildAnswer& answer);
  void begin_again_with(Library library, const std::string& message);
  void read(std::span<std::uint8_t> out);
  void check_time() const;

  ItemLimits limits_;
  std::size_t jobs_;
  Work work_;
  std::string memory_limit_;  ///< for messages
  std::size_t next_ = 0;
  std::string input_;  ///< the file that is read, or was read last
  std::unique_ptr<LimitedChild> child_;
  Stopwatch watch_, reading_;
  bool has_read_ = false;
};

/// The message about an item that takes longer than its time limit.
std::string late_item(const std::string& name, double seconds);

/// Whether items are sandboxed. Calls `warn` with a message, once per process, if they are and a part of the sandbox is
/// missing here.
bool uses_sandbox(bool is_requested, const std::function<void(const std::string&)>& warn);

}  // namespace zoneplate
