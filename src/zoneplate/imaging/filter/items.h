// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace zoneplate {

/// An image to filter.
struct FilterItem {
  std::string input, output;
  std::optional<std::uint64_t> frame = {};  ///< its number, in a sequence
  bool is_in_folder = false;                ///< only the folder of `output` is given
};

/// True for the ending of a format of scene-linear light that is written: .exr or .pfm.
bool is_linear_file(const std::string& path);

/// The images of the operand, and the output file of each: `output` itself for one file, unless it is a folder or ends
/// with '/'; for several a name with a placeholder for the frame number, as render has it, or else a folder.
///
/// Errors    ErrorKind::Usage if images without numbers have to be numbered.
std::vector<FilterItem> plan_items(const std::string& operand, const std::string& output);

/// Requires that each image has its own output file, which is none of those that are kept. Links and other spellings
/// of a name are the same file.
///
/// Errors    ErrorKind::Usage naming the files.
void check_outputs(std::span<const FilterItem> items, std::span<const std::string> kept);

/// The files of other passes of a sequence, by pass; each operand names a sequence or is empty.
struct FramePasses {
  std::vector<std::string> depth, motion;  ///< one for each item, or none
};

/// Finds the files with the depth and the motion of each frame, by the numbers of the frames, or by their order where
/// one of the operands has no numbers. Of a single item, which may be an animation, all files are returned.
///
/// Errors    ErrorKind::Input naming every frame that one of the sequences lacks.
FramePasses find_passes(const std::string& operand, std::span<const FilterItem> items, const std::string& depth,
                        const std::string& motion);

/// Requires a file of a pass for each of `frames` frames.
///
/// Errors    ErrorKind::Input with `name`, the pass, in front.
void check_count(const std::string& name, std::size_t files, std::size_t frames);

/// The numbers that a sequence omits between its first and its last one, as text: "3, 7-9"; empty if its steps are
/// equal.
std::string gaps_in(std::span<const FilterItem> items);

}  // namespace zoneplate
