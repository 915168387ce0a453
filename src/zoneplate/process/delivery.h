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

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/os/run_program.h"
#include "zoneplate/process/item_messages.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/report/plot.h"

namespace zoneplate {

/// The limits of a verb's process, which reads files from outside.
struct ReadingLimits {
  LoadLimits load;                                           ///< its memory limit applies to all work
  double seconds = std::numeric_limits<double>::infinity();  ///< elapsed time limit of all work
  bool is_sandboxed = true;                                  ///< if the kernel supports sandboxes
};

/// The limits of a program that decodes or encodes a video.
ProgramLimits video_limits(const ReadingLimits& limits);

/// The way by which the work of a confined process leaves it: the program itself prints and saves, in the same order.
class Delivery {
 public:
  Delivery(ItemSender& sender, const LoadLimits& limits) : sender_(sender), limits_(limits) {}

  const LoadLimits& limits() const { return limits_; }
  ItemSender& sender() { return sender_; }

  /// Text for stdout; the report of a run that makes files, for stderr where stdout is the image (cli/log.h).
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

  /// The result of the work, for the program.
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

}  // namespace zoneplate
