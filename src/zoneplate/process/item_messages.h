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
#include "zoneplate/job/job_sink.h"
#include "zoneplate/os/library.h"
#include "zoneplate/process/item_error.h"

namespace zoneplate {

// Messages from an item's process (item_process.h) to the parent process: a header of fixed size, followed by the
// number of bytes that it states. The receiver does not trust them.

/// How a text is printed (cli/log.h): `print`, `print_report` to stdout or to stderr, `say_warning`.
enum class TextKind : std::uint8_t { Output, Report, Aside, Warning };

/// The sender of messages; thread-safe.
class ItemSender final : public JobSink {
 public:
  /// Writes the bytes of each message, in order.
  using Write = std::function<void(std::span<const std::uint8_t>)>;
  explicit ItemSender(Write write) : write_(std::move(write)) {}

  /// From now on progress is not sent.
  void mute_progress() { sends_progress_ = false; }
  /// Reports that `stage` begins when the fraction `done` of the whole work, in [0, 1], is complete.
  void progress(std::string_view stage, double done) override;
  /// Reports that reading is complete, so that its time limit no longer applies; or that the next file is read, for
  /// which the limit begins anew. A job begins by reading.
  /// `input` is the file's name in messages about limits from now on; empty: that of the item.
  void has_read() override;
  void begins_to_read(const std::string& input) override;
  /// Sends a whole file. `frame` is its number in a sequence; `layer` is its index among the data passes, or -1
  /// for the image. The receiver determines the file's name from both.
  void file(int frame, int layer, std::span<const std::uint8_t> bytes) override;
  /// Sends a whole file by its name, or the plots of one, which the receiver has drawn (packed_plots.h).
  void named_file(const std::string& name, std::span<const std::uint8_t> bytes);
  void plots(const std::string& name, std::span<const std::uint8_t> bytes);
  /// Sends text that the receiver prints.
  void text(TextKind kind, std::string_view text);
  /// A function that sends the progress of a stage which begins at `from` and ends at `to`, in whole per cents that
  /// only rise; any thread may call it with the fraction of the stage that is complete.
  std::function<void(double)> progress_of(std::string stage, double from, double to) override;
  /// Sends a frame of a film that the receiver encodes.
  void film_frame(const Rgba8Image& image) override;
  /// A prepared environment for the cache, by its key (environment_file.h).
  void environment(std::uint64_t key, std::span<const std::uint8_t> bytes) override;
  /// The end of a job: its result, an error, or the library without which it cannot go on.
  void result(std::span<const std::uint8_t> bytes);
  void failure(ErrorKind kind, const std::string& message, ItemCause cause = ItemCause::Other);
  void needs_library(Library library, const std::string& message);

  /// Whether the current job does not read.
  bool is_past_reading() const { return is_past_reading_; }
  /// The input that is read, or was read last; empty: that of the item.
  const std::string& input() const { return input_; }
  void begin_job() { is_past_reading_ = false, input_.clear(); }

 private:
  enum class Kind : std::uint8_t;
  struct Header;
  friend std::optional<std::vector<std::uint8_t>> receive_message(const std::string&, const struct ItemEvents&,
                                                                  const std::function<void(std::span<std::uint8_t>)>&);
  void send(Kind kind, int first, int second, std::span<const std::uint8_t> bytes);
  void send_named(Kind kind, std::string_view name, std::span<const std::uint8_t> bytes);

  Write write_;
  std::mutex mutex_;
  std::string input_;
  bool is_past_reading_ = false, sends_progress_ = true;
};

/// The handlers of the receiver. A member may be null: such messages are then errors of the sender, except progress,
/// which is ignored.
struct ItemEvents {
  using Read = std::function<void(std::span<std::uint8_t>)>;  ///< fills the span with the message's next bytes
  std::function<void(std::string_view stage, double done)> progress;
  std::function<void(int frame, int layer, std::uint64_t size, const Read& read)> file;
  std::function<void(std::uint64_t size, const Read& read)> film_frame;
  std::function<void(std::uint64_t key, std::uint64_t size, const Read& read)> environment;
  std::function<void(const std::string& name, std::uint64_t size, const Read& read)> named_file;
  std::function<void(const std::string& name, std::uint64_t size, const Read& read)> plots;
  std::function<void(TextKind kind, const std::string& text)> text;
  std::function<void()> has_read;
  std::function<void(const std::string& input)> begins_to_read;
  std::function<void(Library library, const std::string& message)> needs_library;
};

/// Receives one message from `source` and calls its handler. Returns the result of the job if the message is one.
///
/// Errors    the error in the message, an ItemError; ErrorKind::Failed naming `place` for invalid messages, and for results and texts
///           larger than 1 GB; exceptions of `source` and the handlers.
std::optional<std::vector<std::uint8_t>> receive_message(const std::string& place, const ItemEvents& events,
                                                         const ItemEvents::Read& source);

}  // namespace zoneplate
