// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "zoneplate/job/output/frame_name.h"

namespace zoneplate {

/// The numbers first, first + jump, ... up to `last`.
struct FrameNumbers {
  std::int64_t first = 0, last = 0, jump = 1;
};

/// The files that the items of a batch write, to find two items that write the same one, or one that another reads.
///
/// Names are compared as the files that they become: folders and existing links are resolved, and the names of frames
/// are compared number by number, whatever the placeholder is.
class OutputFiles {
 public:
  /// Adds a file that an item writes, or one that it reads.
  void add(const std::string& path, std::uint64_t item, bool is_read = false);
  /// Adds the files of frames that an item writes. `path` has the frame number at `place`.
  void add(const std::string& path, const FramePlace& place, const FrameNumbers& frames, std::uint64_t item);

  /// Two items with one file, and its name.
  struct Collision {
    std::uint64_t first = 0, second = 0;
    bool is_read = false;  ///< the second reads what the first writes
    std::string path;      ///< relative to the working folder, if it is in there
  };
  /// Finds two such items. Names of frames with their numbers in different places, as `1_#.png` and `#_1.png`, are
  /// taken for the same file.
  ///
  /// Cost      sorting the files, whatever the number of frames.
  std::optional<Collision> find_collision();

 private:
  struct Files {
    std::uint32_t folder = 0;             ///< index of the resolved folder
    bool is_read = false;                 ///< by the item, which does not write it
    int digits = 0;                       ///< minimum of the frame number; 0 for one file
    std::string before = {}, after = {};  ///< the name around the frame number; the name of one file, and nothing
    FrameNumbers frames = {};
    std::uint64_t item = 0;
  };
  struct Pattern;

  std::uint32_t folder_of(const std::string& path);
  Collision collision(const Files& a, const Files& b) const;
  std::vector<Pattern> patterns() const;
  /// The patterns with this name around the number.
  static std::span<const Pattern> with_name(std::span<const Pattern> all, std::uint32_t folder, std::string_view before,
                                            std::string_view after);
  std::optional<Collision> of_patterns(std::span<const Pattern> all) const;
  std::optional<Collision> of_places(std::span<const Pattern> all) const;
  std::optional<Collision> of_file(const Files& file, std::span<const Pattern> all) const;

  std::unordered_map<std::string, std::uint32_t> written_folders_;   ///< indices of folders as they are written
  std::unordered_map<std::string, std::uint32_t> resolved_folders_;  ///< and of resolved ones
  std::vector<std::string> folder_names_;                            ///< resolved
  std::vector<Files> files_, frames_;
};

}  // namespace zoneplate
