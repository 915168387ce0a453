// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "zoneplate/evaluate/compare/trial.h"
#include "zoneplate/evaluate/ignored_regions.h"
#include "zoneplate/job/job.h"
#include "zoneplate/os/output_paths.h"
#include "zoneplate/process/delivery.h"

namespace zoneplate {

/// What is compared, and how it is reported.
struct CompareOptions {
  std::vector<std::string> scenes, command;
  IgnoredInputs ignored;
  std::string layer;  ///< of the reference, if it is an EXR image
  std::string page;   ///< a page for a browser; empty: none
  int frames = 1;
  bool prints_json = false, is_quiet = false;
};

/// Renders the scenes with the methods of the options, as the job says, and delivers the files of its output, a folder,
/// and the page. Runs in a confined process, whose result is the text to print.
void compare_all(const CompareOptions& args, const Job& job, TrialOptions options, const MemoryFiles& memory,
                 Delivery& out);

/// The files of a comparison, in memory until all of them are there.
class ComparedFiles {
 public:
  ComparedFiles(const CompareOptions& args, const Job& job) : args_(args), job_(job) {}

  /// Takes a file of the folder, or the page.
  ///
  /// Errors    ErrorKind::Failed for any other file, or if they need more memory than the job's limit.
  void take(const std::string& path, std::vector<std::uint8_t> bytes);
  void save(const EarlierFiles& earlier) const;

 private:
  const CompareOptions& args_;
  const Job& job_;
  std::vector<OutputFile> files_;
  std::vector<std::uint8_t> page_;
  std::uint64_t size_ = 0;
};

}  // namespace zoneplate
