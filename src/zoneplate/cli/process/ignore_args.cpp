// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/process/ignore_args.h"

#include <algorithm>
#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/job/values.h"
#include "zoneplate/metrics/file/picture_file.h"

namespace zoneplate::cli {
namespace {

constexpr int most_side = 1 << 20;

/// The rectangle of "x,y,width,height".
metrics::IgnoredRegions::Rectangle parse_rectangle(const std::string& text) {
  std::vector<std::string> parts{""};
  for (const char c : text) c == ',' ? static_cast<void>(parts.emplace_back()) : parts.back().push_back(c);
  if (parts.size() != 4) throw Error(ErrorKind::Usage, text + ": expected x,y,width,height or an image file");
  return {parse_whole(parts[0], 0, most_side), parse_whole(parts[1], 0, most_side), parse_whole(parts[2], 1, most_side),
          parse_whole(parts[3], 1, most_side)};
}

void add(const std::string& text, IgnoreArgs& args) {
  std::error_code ignored;
  if (std::filesystem::exists(text, ignored))
    args.masks.push_back(text);
  else if (text.find_first_not_of("0123456789,") == std::string::npos)
    args.rectangles.push_back(parse_rectangle(text));
  else
    throw Error(ErrorKind::Input, text + ": no such file, and not x,y,width,height");
  args.texts.push_back(text);
}

}  // namespace

Option ignore_option(IgnoreArgs& args, const std::string& group) {
  return {
      "--ignore",
      "REGION",
      "Do not compare this region: x,y,width,height in pixels from the top left, or an image whose pixels above half "
      "of white are ignored; may be repeated",
      group,
      true,
      [&](auto& text) { add(text, args); }};
}

metrics::IgnoredRegions read_ignored(const IgnoreArgs& args, Delivery& out) {
  metrics::IgnoredRegions regions{.rectangles = args.rectangles};
  for (const std::string& path : args.masks)
    out.read(path, [&] { regions.masks.emplace_back(path, metrics::load_picture(path, out.limits().pixels)); });
  return regions;
}

}  // namespace zoneplate::cli
