// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/imaging/signal/result.h"
#include "zoneplate/shade/texture/texture.h"

namespace zoneplate {

struct TextureLevels : SignalOptions {
  LevelOptions options;
  TexelMeaning meaning = TexelMeaning::Color;
  bool weights_by_alpha = true, shows_ripmap = false;
};

/// Prints the sizes and the memory of the levels of a texture, and shows them if there is an output.
void show_levels(const std::string& input, TextureLevels args, Delivery& out);

}  // namespace zoneplate
