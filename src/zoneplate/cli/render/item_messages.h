// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/os/library.h"

namespace zoneplate::cli {

// Messages from an item's process (item_process.h) to the parent process: a header of a fixed size, then the number of
// bytes that it states. The receiver validates all of it.

/// The sending end. Any thread may send.
class ItemSender {
 public:
  /// Takes the bytes of each message in their order.
  using Write = std::function<void(std::span<const std::uint8_t>)>;
  explicit ItemSender(Write write) : write_(std::move(write)) {}

  /// `stage` begins, when the share `done` of the whole work, in [0, 1], is behind.
  void progress(std::string_view stage, double done);
  /// The limit on the time to read no longer applies.
  void has_read();
  /// A whole file. `frame`: its number in a sequence, or -1; `layer`: its place among the data passes, or -1 for the
  /// image. The receiver makes the file's name of them.
  void file(int frame, int layer, std::span<const std::uint8_t> bytes);
  /// A frame of a film that the receiver encodes.
  void film_frame(const Rgba8Image& image);
  /// A prepared environment for the cache, by its key (environment_file.h).
  void environment(std::uint64_t key, std::span<const std::uint8_t> bytes);
  /// The end of a job: its result, an error, or the library without which it cannot go on.
  void result(std::span<const std::uint8_t> bytes);
  void failure(ErrorKind kind, const std::string& message);
  void needs_library(Library library, const std::string& message);

  /// Whether the job at work has called has_read.
  bool is_past_reading() const { return is_past_reading_; }
  void begin_job() { is_past_reading_ = false; }

 private:
  enum class Kind : std::uint8_t;
  struct Header;
  friend std::optional<std::vector<std::uint8_t>> receive_message(const std::string&, const struct ItemEvents&,
                                                                  const std::function<void(std::span<std::uint8_t>)>&);
  void send(Kind kind, int first, int second, std::span<const std::uint8_t> bytes);

  Write write_;
  std::mutex mutex_;
  bool is_past_reading_ = false;
};

/// The handlers of the receiver. A member may be null: such messages are errors of the sender, except progress, which
/// is then ignored.
struct ItemEvents {
  using Read = std::function<void(std::span<std::uint8_t>)>;  ///< fills the span with the message's next bytes
  std::function<void(std::string_view stage, double done)> progress;
  std::function<void(int frame, int layer, std::uint64_t size, const Read& read)> file;
  std::function<void(std::uint64_t size, const Read& read)> film_frame;
  std::function<void(std::uint64_t key, std::uint64_t size, const Read& read)> environment;
  std::function<void()> has_read;
  std::function<void(Library library, const std::string& message)> needs_library;
};

/// Receives one message from `source` and acts on it; the result of the job, if it was that.
///
/// Errors    the error that the message carries; ErrorKind::Failed naming `place` for bytes that are no message, and
/// for
///           results and texts past 1 GB; what `source` and the events throw.
std::optional<std::vector<std::uint8_t>> receive_message(const std::string& place, const ItemEvents& events,
                                                         const ItemEvents::Read& source);

}  // namespace zoneplate::cli
