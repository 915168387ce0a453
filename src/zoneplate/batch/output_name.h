// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "zoneplate/job/output/frame_name.h"

namespace zoneplate {

/// True if the name has a placeholder for its input: {model}, {ext}, {dir} or {index}, or names a folder by a '/' at
/// its end.
bool names_input(const std::string& output);

/// The name of an item's image, or of the images of its frames.
struct OutputName {
  std::string text;
  std::optional<FramePlace> frame;  ///< where `text` has the number of a frame
};

/// Replaces the placeholders of an output's name by what they stand for:
///
///     {model}           the input's file name without its extension: "chair" of "shop/chair.glb"
///     {ext}             its extension without the dot: "glb"
///     {dir}             its folder: "shop", or "." for an input without a folder
///     {index} {index:4} its number in the batch from 0, and the same with leading zeros
///
/// "thumbs/" stands for "thumbs/{model}.png", and for "thumbs/{model}.####.png" in a sequence. The frame number is that
/// of `output`: what the input's name puts there is none.
///
/// No value leads out of the folder that `output` names: {model} is never "." or "..", and {dir} is the normal form of
/// the folder without "/" and ".." at its beginning: "models" of "../models/chair.glb". Only in "{dir}/..."
/// at the beginning of `output`, where it names the folder of the input itself, {dir} is the folder as it is.
/// Errors    ErrorKind::Usage naming a placeholder that does not exist, or a digit that a value puts directly after the
///           frame number.
OutputName output_name(const std::string& output, const std::string& input, std::uint64_t index,
                       bool is_sequence = false);

}  // namespace zoneplate
