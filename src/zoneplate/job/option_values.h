// SPDX-License-Identifier: Apache-2.0
// The values of render's options: parsers, and the names that options take.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/job/job.h"
#include "zoneplate/job/option/option.h"
#include "zoneplate/render/method.h"

namespace zoneplate {

Choices stdout_formats();
/// The antialiasing methods.
std::span<const Method> method_catalogue();
Choices method_names();
Choices upscaler_names();
Choices aov_names();
Choices texture_filter_list();
std::string texture_filter_names();  ///< the same, separated by commas

// The parsers throw ErrorKind::Usage for other texts.

/// A colour as parse_color reads it, in linear light.
float3 linear_color(const std::string& text);
/// A radiance: a colour as parse_color reads it, in linear light, or "linear:R,G,B".
float3 parse_radiance(const std::string& text);
/// "+Y", "Y", "-Z" and so on, as a unit vector.
float3 parse_up(const std::string& text);
/// "x,y,width,height", in pixels.
Crop parse_crop(const std::string& text);
/// "fast", "default" and "best" as 0, 1, 2. A number is an error that names the options which mean that.
int parse_quality(const std::string& text);
/// Data passes by their names, and the groups "all" and "light".
std::vector<const Aov*> parse_aovs(const std::string& text);
/// The image's side over the frame's, or the name of a preset.
double parse_render_scale(const std::string& text);
ShutterFilter parse_shutter_filter(const std::string& text);
/// "box", "kaiser" or "lanczos", with its parameters.
void set_mip_filter(const std::string& text, MipOptions& mips);

}  // namespace zoneplate
