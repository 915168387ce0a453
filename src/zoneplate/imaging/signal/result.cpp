// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "zoneplate/codec/png.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/imaging/filter/color.h"
#include "zoneplate/imaging/filter/items.h"
#include "zoneplate/imaging/signal/show.h"
#include "zoneplate/process/exr_layer.h"
#include "zoneplate/report/report_version.h"

namespace zoneplate {
namespace {

void save_values(const std::string& path, const Signal& values, Delivery& out) {
  const metrics::ImageFile& file = values.origin.file;
  const ExrStorage storage{.type = ExrType::Float, .is_converted = is_converted(values)};
  warn_of_left_out(path, file.name, save_light(path, values.image, file, storage, out), out);
}

}  // namespace

SignalChoice signal_choice(const SignalOptions& args, bool keeps_size) {
  return {args.uses_codes, {args.layer, area_for(args.output, keeps_size)}};
}

void save_picture(const std::string& path, const Rgba8Image& picture, Delivery& out, const ColorProfile& profile) {
  const bool is_opaque =
      std::all_of(picture.values().begin(), picture.values().end(), [](Rgba8 c) { return c.a == 255; });
  out.save(path, encode_png(picture, {.has_alpha = !is_opaque, .profile = profile}));
}

void save_result(const std::string& path, const LinearImage& values, const std::function<Rgba8Image()>& picture,
                 Delivery& out) {
  save_signal(path, {values}, out, picture);
}

void save_signal(const std::string& path, const Signal& values, Delivery& out,
                 const std::function<Rgba8Image()>& picture) {
  const RgbSpacePtr &space = values.meaning.space, &original = values.origin.space;
  const bool are_codes = values.meaning.are_codes, is_light_file = is_linear_file(path);
  if (picture && !is_light_file) return save_picture(path, picture(), out);
  const std::string ending = is_light_file ? extension_of(path) : ".png";
  const bool is_stated = space && can_hold(ending, space->profile);
  const bool is_kept = is_stated || (is_light_file && are_codes && space);
  if (original && !original->is_standard && !is_kept)
    warn_of_conversion(values.origin.file.name, *original,
                       can_hold(ending, original->profile)
                           ? "gives light but no codes"
                           : fmt::format("{} cannot state", path == "-" ? "a PNG" : path),
                       !is_light_file ? clamped_srgb
                       : are_codes    ? "sRGB codes"
                                      : rec709_light,
                       out);
  if (is_light_file) return save_values(path, is_kept ? values : in_rec709(values), out);
  if (!is_stated) return save_picture(path, shown(in_rec709(values).image, are_codes), out);
  const Rgba8Image codes =
      are_codes || space->is_standard ? shown(values.image, are_codes) : quantize8(codes_of(values.image, *space));
  save_picture(path, codes, out, space->profile);
}

void print_result(const SignalOptions& args, const std::string& text, const Json::Object& json, Delivery& out) {
  Json::Object report{{"format", args.report}, {"version", report_version}};
  report.insert(report.end(), json.begin(), json.end());
  const std::string line = args.prints_json ? Json(std::move(report)).text() + '\n' : text;
  if (args.output != "-" || args.prints_json) out.print_report(line, args.output == "-");
}

}  // namespace zoneplate
