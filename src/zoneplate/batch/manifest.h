// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace zoneplate {

/// The jobs of a manifest: the lines of a file, or of stdin for "-", that are not blank.
///
/// It takes the memory of their text and 24 bytes a line. A file has at most 1,000,000 jobs, 64 KB a line, and the
/// given size in all.
/// Errors    ErrorKind::Input naming the file, the line, the limit and what to do about it.
class Manifest {
 public:
  Manifest(const std::string& path, std::uint64_t max_bytes);

  std::uint64_t size() const { return lines_.size(); }
  std::string_view text(std::uint64_t i) const { return lines_[i].text; }
  /// Its name for messages: "jobs.jsonl: line 7".
  std::string place(std::uint64_t i) const { return place_of(lines_[i].number); }

 private:
  struct Line {
    std::string_view text;  ///< in `blocks_`
    std::uint32_t number = 0;
  };
  std::string place_of(std::uint64_t number) const;
  void end_line();

  std::string name_, line_;
  std::uint64_t number_ = 0;
  std::vector<Line> lines_;
  std::vector<std::unique_ptr<char[]>> blocks_;
  std::size_t used_ = 0;  ///< of the last block
};

}  // namespace zoneplate
