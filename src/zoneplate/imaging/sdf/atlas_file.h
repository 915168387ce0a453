// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/formats/font/font.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/report/json.h"
#include "zoneplate/sdf/field/atlas.h"

namespace zoneplate {

/// The code points of UTF-8 text.
std::vector<char32_t> code_points(std::string_view text);

/// The atlas of these characters, without repetitions, with their kerning.
sdf::Atlas atlas_of(const Font& font, const std::vector<char32_t>& characters, const sdf::AtlasOptions& options);

/// The image of an atlas: grey for a single channel, alpha for `mtsdf`.
Rgba8Image atlas_image(const sdf::Atlas& atlas);

/// The metrics of an atlas in the form of msdf-atlas-gen: bounds in em and texels from the bottom.
///
/// Source    Viktor Chlumský, msdf-atlas-gen, its JSON specification.
Json atlas_metrics(const sdf::Atlas& atlas, const Font::Metrics& font);

/// Reads an atlas that this program or msdf-atlas-gen wrote.
///
/// Errors    ErrorKind::Input naming the file and the member.
sdf::Atlas load_atlas(const std::string& image_file, const std::string& metrics_file,
                      std::uint64_t max_pixels = std::uint64_t{1} << 26);

/// "sdf", "msdf", "mtsdf".
const char* name_of(sdf::FieldKind kind);
sdf::FieldKind parse_field_kind(const std::string& text);

}  // namespace zoneplate
