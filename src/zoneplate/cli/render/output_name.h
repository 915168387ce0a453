// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "zoneplate/cli/render/args.h"

namespace zoneplate::cli {

/// True if the name has a placeholder for its input: {model}, {ext}, {dir} or {index}, or names a folder by a '/' at
/// its end.
bool names_input(const std::string& output);

/// Replaces the placeholders of an output's name by what they stand for:
///
///     {model}           the input's file name without its extension: "chair" of "shop/chair.glb"
///     {ext}             its extension without the dot: "glb"
///     {dir}             its folder: "shop", or "." for an input without a folder
///     {index} {index:4} its number in the batch from 0, and the same with leading zeros
///
/// "thumbs/" stands for "thumbs/{model}.png". Placeholders of the frame number (frame_name.h) remain.
/// Errors    ErrorKind::Usage naming a placeholder that does not exist.
std::string output_name(const std::string& output, const std::string& input, std::uint64_t index);

/// Finds items of a batch that would write the same file.
class OutputNames {
 public:
  /// Adds an item; `name` is its name for messages.
  ///
  /// Errors    ErrorKind::Usage naming both items if an earlier one has the same output.
  void add(const RenderArgs& args, const std::string& name);

 private:
  std::map<std::string, std::string> owner_;
};

}  // namespace zoneplate::cli
