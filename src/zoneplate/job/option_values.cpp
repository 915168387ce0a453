// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/spec.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {
namespace {

struct MipFilterRow {
  std::string_view name;
  std::span<const Param> params;
  MipFilter filter;
};

}  // namespace

float3 linear_color(const std::string& text) {
  const float4 code = parse_color(text);
  return {decode_srgb(code.x), decode_srgb(code.y), decode_srgb(code.z)};
}

float3 parse_radiance(const std::string& text) {
  constexpr std::string_view linear = "linear:";
  return text.starts_with(linear) ? narrowed(parse_triple(text.substr(linear.size()))) : linear_color(text);
}

float3 parse_up(const std::string& text) {
  constexpr float3 axes[] = {{0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}};
  const std::string signed_text = text.size() == 1 ? '+' + text : text;
  return axes[parse_choice(signed_text, {"+Y", "-Y", "+Z", "-Z", "+X", "-X"})];
}

Crop parse_crop(const std::string& text) {
  std::vector<int> numbers;
  for (const std::string& number : split_list(text)) numbers.push_back(parse_whole(number, 0, max_side));
  if (numbers.size() != 4 || numbers[2] == 0 || numbers[3] == 0)
    throw Error(ErrorKind::Usage, fmt::format("'{}' is not a rectangle x,y,width,height", text));
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

Choices stdout_formats() { return {"png", "jpg", "webp", "exr", "pfm", "rgba"}; }

// A number is what --quality means in other programs.
int parse_quality(const std::string& text) {
  if (!text.empty() && text.find_first_not_of("0123456789") == text.npos)
    throw Error(ErrorKind::Usage,
                fmt::format("'{}' is not one of fast, default, best; did you mean --jpeg-quality {} or "
                            "--webp-quality {}?",
                            text, text, text));
  return static_cast<int>(parse_choice(text, {"fast", "default", "best"}));
}

std::span<const Method> method_catalogue() { return antialias::methods(); }

Choices method_names() {
  std::vector<std::string_view> names;
  for (const Method& method : antialias::methods()) names.push_back(method.name);
  return names;
}

Choices upscaler_names() {
  Choices names;
  for (const Upscaler& upscaler : upscale::upscalers()) names.push_back(upscaler.name);
  return names;
}

Choices aov_names() {
  std::vector<std::string_view> names;
  for (const Aov& aov : aovs()) names.push_back(aov.name);
  return names;
}

std::vector<const Aov*> parse_aovs(const std::string& text) {
  const std::vector<std::string_view> names = aov_names();
  std::vector<const Aov*> found;
  for (const std::string& name : split_list(text)) {
    if (name == "all" || name == "light") {
      for (const Aov& aov : aovs()) {
        Planes planes;
        planes.*aov.plane = true;
        const bool is_special = planes.motion || planes.flow || planes.error;
        if (name == "light" ? planes.any_light() : !planes.any_light() && !is_special) found.push_back(&aov);
      }
    } else {
      found.push_back(&aovs()[parse_choice(name, names)]);
    }
  }
  return found;
}

double parse_render_scale(const std::string& text) {
  constexpr std::pair<std::string_view, double> presets[] = {
      {"ultra-quality", 1.3}, {"quality", 1.5}, {"balanced", 1.7}, {"performance", 2}, {"ultra-performance", 3}};
  for (const auto& [name, scale] : presets)
    if (text == name) return scale;
  return parse_number(text, scale_param.low, scale_param.high);
}

Choices texture_filter_list() {
  std::vector<std::string_view> names;
  for (const TextureFilterEntry& entry : texture_filters()) names.push_back(entry.name);
  return names;
}

std::string texture_filter_names() { return fmt::format("{}", fmt::join(texture_filter_list(), ", ")); }

void set_mip_filter(const std::string& text, MipOptions& mips) {
  static constexpr std::string_view alphas[] = {"average", "coverage"}, colors[] = {"weighted", "straight"};
  static constexpr Param params[] = {
      {.name = "alpha", .meaning = "of alpha-tested textures", .names = alphas},
      {.name = "color", .meaning = "of textures with alpha: weighted by it, or not", .names = colors}};
  static constexpr MipFilterRow rows[] = {
      {"box", params, MipFilter::Box}, {"kaiser", params, MipFilter::Kaiser}, {"lanczos", params, MipFilter::Lanczos}};
  const auto spec = parse_spec<MipFilterRow>("mip filter", rows, text);
  mips.filter = spec.row.filter;
  mips.keeps_coverage = spec.settings.chosen("alpha") == "coverage";
  mips.weights_by_alpha = spec.settings.chosen("color") == "weighted";
}

ShutterFilter parse_shutter_filter(const std::string& text) {
  if (text == "box") return ShutterFilter::Box;
  if (text == "triangle") return ShutterFilter::Triangle;
  if (text == "gaussian") return ShutterFilter::Gaussian;
  throw Error(ErrorKind::Usage, fmt::format("'{}' is not box, triangle or gaussian", text));
}

}  // namespace zoneplate
