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
#include "zoneplate/cli/render/item_messages.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/os/limited_child.h"

namespace zoneplate::cli {

/// The limits of an item's process.
struct ItemLimits {
  std::string name;                                          ///< of the item's model, which begins errors
  LoadLimits load;                                           ///< memory holds for all of the item's work
  double seconds = std::numeric_limits<double>::infinity();  ///< for the whole item, on the wall clock
  bool is_sandboxed = true;                                  ///< where the kernel has sandboxes
  std::optional<std::vector<std::string>> readable = {};     ///< files and folders; nothing: every file
};

/// Does the work of one item, or of several with one model, in a process of its own: a sandboxed copy of this one
/// (os/limited_child.h) with a limit on its memory and its time.
///
/// Whatever happens to that process, this one goes on. It writes nothing itself: files arrive here as bytes. A library
/// that turns out to be needed is opened here, and the job begins again.
class ItemProcess {
 public:
  /// Does job `i` and returns its result.
  using Work = std::function<std::vector<std::uint8_t>(std::size_t job, ItemSender& sender)>;

  ItemProcess(ItemLimits limits, std::size_t jobs, Work work);
  ~ItemProcess();

  /// The result of the next job. The first call starts the process. The events has_read and needs_library are added
  /// here.
  ///
  /// Errors    what the job throws; ErrorKind::Input before it has read its model, and ErrorKind::Failed after that,
  /// where
  ///           its process ran out of memory or time or was ended by a signal; what the events throw. The next call
  ///           goes on with the job after it, in a new process.
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
  std::size_t next_ = 0;
  std::unique_ptr<LimitedChild> child_;
  Stopwatch watch_;
  bool has_read_ = false;
};

/// Reads a model within the limit on the time to read one. Of an item's process.
///
/// Errors    ErrorKind::Input naming the model and the option when the time is up; what `read` throws.
void within_import_time(const std::string& name, const LoadLimits& limits, const std::function<void()>& read);

/// Warns, once a process, where files are read without a sandbox because the kernel has none, and returns whether items
/// are to be sandboxed.
bool uses_sandbox(bool is_requested);

}  // namespace zoneplate::cli
