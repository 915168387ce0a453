// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/imaging/signal/result.h"
#include "zoneplate/sdf/field/atlas.h"

namespace zoneplate {

struct TextOptions : SignalOptions {
  std::string font, metrics, atlas;
  std::string characters;
  double px = 64;
  std::vector<int> sizes;
  bool is_exact = false;
  sdf::AtlasOptions options;
};

/// Draws text from distance fields, and prints its error against the exact coverage of its outlines.
void draw_text(const std::string& words, const TextOptions& args, Delivery& out);

/// Makes an atlas of a font's glyphs as distance fields.
void make_atlas(const TextOptions& args, Delivery& out);

}  // namespace zoneplate
