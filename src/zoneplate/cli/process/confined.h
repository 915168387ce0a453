// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/cli/args.h"
#include "zoneplate/cli/process/item_messages.h"
#include "zoneplate/cli/progress.h"
#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/os/run_program.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/report/plot.h"

namespace zoneplate::cli {

/// The limits of a verb's process, which reads files from outside.
struct ReadingLimits {
  LoadLimits load;                                           ///< its memory limit applies to all work
  double seconds = std::numeric_limits<double>::infinity();  ///< elapsed time limit of all work
  bool is_sandboxed = true;                                  ///< if the kernel supports sandboxes
};

/// The options --max-memory, --max-pixels, --max-import-seconds, --max-seconds, --sandbox and --no-sandbox of a verb;
/// `subject` is what the limits apply to: "an item", "the run".
std::vector<Option> limit_options(LoadLimits& load, double& seconds, bool& is_sandboxed, const std::string& group,
                                  const std::string& subject);
inline std::vector<Option> limit_options(ReadingLimits& limits, const std::string& subject = "the run") {
  return limit_options(limits.load, limits.seconds, limits.is_sandboxed, "Limits", subject);
}
/// The limits of a program that decodes or encodes a video.
ProgramLimits video_limits(const ReadingLimits& limits);

/// The way by which the work of a confined process leaves it: the program itself prints and saves, in the same order.
class Delivery {
 public:
  Delivery(ItemSender& sender, const LoadLimits& limits) : sender_(sender), limits_(limits) {}

  const LoadLimits& limits() const { return limits_; }
  ItemSender& sender() { return sender_; }

  /// As the functions of cli/log.h.
  void print(std::string_view text) { sender_.text(TextKind::Output, text); }
  void print_report(std::string_view text, bool is_stdout_taken = false) {
    sender_.text(is_stdout_taken ? TextKind::Aside : TextKind::Report, text);
  }
  void warn(std::string_view message);
  /// From now on, of warnings that differ in numbers alone, as those of the frames of a sequence do, only the first is
  /// printed, and tell_repeated counts the others.
  void repeat_no_warnings() { repeats_warnings_ = false; }
  void tell_repeated(const std::string& input);
  /// Warns of damage of an image that its decoder passed over. An empty text means none.
  ///
  /// Errors    ErrorKind::Input with the text if the limits are strict.
  void warn_of_flaw(const std::string& flaw);
  void progress(std::string_view stage, double done) { sender_.progress(stage, done); }

  /// Saves a file, whole or not at all.
  void save(const std::string& path, std::span<const std::uint8_t> bytes) { sender_.named_file(path, bytes); }
  void save(const std::string& path, std::string_view text);
  /// Saves plots (report/plot.h) in the format of the path's ending, .svg or PNG.
  void save_plots(const std::string& path, std::span<const Plot> plots, int columns, const PlotSize& size);
  /// Saves a figure as PNG, after the plots of its panels have been drawn in this size.
  void save_figure(const std::string& path, const Figure& figure, const PlotSize& size);

  /// Reads an input within the limit of import time; messages about limits name it meanwhile, and afterwards.
  void read(const std::string& input, const std::function<void()>& body);

  /// The result of run_confined.
  void set_result(std::vector<std::uint8_t> bytes) { result_ = std::move(bytes); }
  const std::vector<std::uint8_t>& result() const { return result_; }

 private:
  ItemSender& sender_;
  const LoadLimits& limits_;
  std::vector<std::uint8_t> result_;
  bool repeats_warnings_ = true;
  std::set<std::string> warnings_;  ///< without numbers
  std::size_t repeated_ = 0;
};

/// What a confined process may do, and where its files go.
struct ConfinedRun {
  std::string name;  ///< the input, the prefix of messages about limits
  ReadingLimits limits;
  std::vector<std::string> readable;  ///< files and folders
  std::vector<std::string> outputs;   ///< the files that it may save
  Progress* progress = nullptr;       ///< where it reports its progress
  std::function<void()> open = {};    ///< runs in the process before it is confined
  /// Takes the files of other names than `outputs`; throws for a name that it does not accept. Null: there are none.
  std::function<void(const std::string& name, std::vector<std::uint8_t> bytes)> take = {};
  /// Takes prepared environments for the cache. Null: there are none.
  std::function<void(std::uint64_t key, std::vector<std::uint8_t> bytes)> take_environment = {};
};

/// Runs `work` in a process with these limits (item_process.h), prints and saves what it delivers, and returns its
/// result.
///
/// If the work needs a library, that is opened here, and the work is restarted.
/// Errors    those of `work`, also PartialFailure and Difference; of its limits as those of ItemProcess::next; those of
///           printing and saving; ErrorKind::Failed for a file that it may not save.
std::vector<std::uint8_t> run_confined(const ConfinedRun& run, const std::function<void(Delivery&)>& work);

}  // namespace zoneplate::cli
