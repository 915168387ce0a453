// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/save.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/base/lower_case.h"
#include "zoneplate/codec/color/icc.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/system/avif.h"
#include "zoneplate/codec/system/jxl.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/os/file.h"

namespace zoneplate {

std::string extension_of(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string());
}

void check_alpha(std::string_view extension, const std::string& name) {
  struct Format {
    std::string_view extension, name, with_alpha;
  };
  constexpr std::string_view images = "a .png or a .webp", videos = "a .webm, .webp or .apng";
  static constexpr Format formats[] = {{".jpg", "JPEG", images},        {".jpeg", "JPEG", images},
                                       {".pfm", "PFM", "an .exr"},      {".mp4", "H.264 video", videos},
                                       {".mov", "H.264 video", videos}, {".mkv", "H.264 video", videos}};
  const auto found = std::ranges::find(formats, extension, &Format::extension);
  if (found == std::end(formats)) return;
  throw Error(ErrorKind::Usage,
              fmt::format("{}: the image is not opaque, and {} has no alpha: write {}, or give it a background", name,
                          found->name, found->with_alpha));
}

std::vector<std::uint8_t> encode_image(const std::string& path, const Rgba8Image& image, const ColorProfile& profile) {
  const bool has_alpha = std::ranges::any_of(image.values(), [](Rgba8 c) { return c.a != 255; });
  return encode_codes(image, has_alpha, extension_of(path), path, profile);
}

std::vector<std::uint8_t> encode_codes(const Rgba8Image& image, bool has_alpha, std::string_view extension,
                                       const std::string& name, const ColorProfile& profile) {
  if (has_alpha) check_alpha(extension, name);
  if (extension == ".png") return encode_png(image, {.has_alpha = has_alpha, .profile = profile});
  if (extension == ".jpg" || extension == ".jpeg") return encode_jpeg(image, default_jpeg_quality, profile.icc);
  if (extension == ".webp") return encode_webp(image, has_alpha, std::nullopt, profile.icc);
  if (extension == ".avif") return encode_avif(image, has_alpha);
  if (extension == ".jxl") return encode_jxl(image, has_alpha);
  throw Error(ErrorKind::Usage,
              name + ": display-referred images are saved as .png, .jpg, .jpeg, .webp, .avif or .jxl");
}

std::vector<std::uint8_t> encode_image(const std::string& path, const LinearImage& image, const ColorProfile& profile) {
  const std::string extension = extension_of(path);
  // The sums of filters round. Alpha of 0 everywhere is that of values without it, such as derivatives.
  constexpr float rounding = 0.5f / 255;
  const auto has = [&](const auto& alpha) { return std::ranges::any_of(image.values(), alpha, &Linear::a); };
  if (has([](float a) { return a < 1 - rounding; }) && has([](float a) { return a > rounding; }))
    check_alpha(extension, path);
  if (extension == ".pfm") return encode_pfm(image);
  if (extension != ".exr") throw Error(ErrorKind::Usage, path + ": scene-linear images are saved as .exr or .pfm");
  ExrAttributes attributes;
  if (profile.chromaticities) attributes.emplace_back("chromaticities", *profile.chromaticities);
  return encode_exr(image.width(), image.height(), rgba_channels(image), attributes);
}

bool can_hold(std::string_view extension, const ColorProfile& profile) {
  const bool is_light = extension == ".exr" || extension == ".pfm";
  if (profile.chromaticities || is_light) return profile.chromaticities && extension == ".exr";
  if (!profile.icc.empty() && icc_pixels(profile.icc) != "RGB ") return false;
  const bool holds_icc = extension == ".jpg" || extension == ".jpeg" || extension == ".webp";
  return extension == ".png" || (holds_icc && !profile.icc.empty() && !profile.cicp);
}

void save_image(const std::string& path, const Rgba8Image& image) { save_bytes(path, encode_image(path, image)); }
void save_image(const std::string& path, const LinearImage& image) { save_bytes(path, encode_image(path, image)); }

}  // namespace zoneplate
