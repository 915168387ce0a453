#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/limited_child.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/scene/load.h"

namespace zoneplate::cli {

/// What the process of an item may have.
struct ItemLimits {
  std::string name;                                          ///< of the item's model, which begins errors
  LoadLimits load;                                           ///< memory holds for all of the item's work
  double seconds = std::numeric_limits<double>::infinity();  ///< for the whole item, on the wall clock
  bool is_sandboxed = true;                                  ///< where the kernel has sandboxes
  std::optional<std::vector<std::string>> readable = {};     ///< files and folders; nothing: every file
};

/// The end of the pipe in the item's process: sends what the item makes, while it is made. Any thread may send.
class ItemSender {
 public:
  explicit ItemSender(ChildAnswer& pipe) : pipe_(pipe) {}

  /// `stage` begins, when the share `done` of the whole work, in [0, 1], is behind.
  void progress(std::string_view stage, double done);
  /// The limit on the time to read no longer applies.
  void has_read();
  /// A whole file. `frame`: its number in a sequence, or -1; `layer`: its place among the data passes, or -1 for the
  /// picture. The receiver makes the file's name of them.
  void file(int frame, int layer, std::span<const std::uint8_t> bytes);
  /// A frame of a film that the receiver encodes.
  void film_frame(const Rgba8Image& image);

 private:
  friend class ItemProcess;
  struct Header;
  enum class Kind : std::uint8_t;
  void send(Kind kind, int frame, int layer, std::span<const std::uint8_t> bytes);

  ChildAnswer& pipe_;
  std::mutex mutex_;
  bool has_read_ = false;  ///< the job at work
};

/// What is done, in the program's own process, with what an item sends. Each member may be null.
struct ItemEvents {
  using Read = std::function<void(std::span<std::uint8_t>)>;  ///< fills the span with the next bytes
  std::function<void(std::string_view stage, double done)> progress;
  std::function<void(int frame, int layer, std::uint64_t size, const Read& read)> file;
  std::function<void(std::uint64_t size, const Read& read)> film_frame;
};

/// Does the work of one item, or of several with one model, in a process of its own: a sandboxed copy of this one
/// (base/limited_child.h) with a limit on its memory and its time.
///
/// Whatever happens to that process, this one goes on. It writes nothing itself: files arrive here as bytes. A library
/// that turns out to be needed is opened here, and the job begins again.
class ItemProcess {
 public:
  /// Does job `i` and returns its result.
  using Work = std::function<std::vector<std::uint8_t>(std::size_t job, ItemSender& sender)>;

  ItemProcess(ItemLimits limits, std::size_t jobs, Work work);
  ~ItemProcess();

  /// The result of the next job. The first call starts the process.
  ///
  /// Errors    what the job throws; Trouble::Input before it has read its model, and Trouble::Failed after that, where
  ///           its process ran out of memory or time or was ended by a signal; what the events throw. The next call
  ///           goes on with the job after it, in a new process.
  std::vector<std::uint8_t> next(const ItemEvents& events);

 private:
  void start(std::size_t first);
  void work_on(std::size_t first, ChildAnswer& answer);
  std::optional<std::vector<std::uint8_t>> receive(const ItemEvents& events);
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
/// Errors    Trouble::Input naming the model and the option when the time is up; what `read` throws.
void within_import_time(const std::string& name, const LoadLimits& limits, const std::function<void()>& read);

/// Warns, once a process, where files are read without a sandbox because the kernel has none, and returns whether items
/// are to be sandboxed.
bool wants_sandbox(bool is_asked_for);

}  // namespace zoneplate::cli
