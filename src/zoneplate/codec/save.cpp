// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/save.h"

#include <algorithm>
#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/base/lower_case.h"
#include "zoneplate/codec/exr_encode.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
std::string extension_of(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string());
}

std::vector<std::uint8_t> encode_image(const std::string& path, const Rgba8Image& image) {
  const std::string extension = extension_of(path);
  const bool has_alpha = std::ranges::any_of(image.values(), [](Rgba8 c) { return c.a != 255; });
  if (extension == ".png") return encode_png(image, {.has_alpha = has_alpha});
  if (extension == ".jpg" || extension == ".jpeg") return encode_jpeg(image);
  if (extension == ".webp") return encode_webp(image, has_alpha);
  throw Error(ErrorKind::Usage, path + ": display-referred images are saved as .png, .jpg, .jpeg or .webp");
}

std::vector<std::uint8_t> encode_image(const std::string& path, const LinearImage& image) {
  const std::string extension = extension_of(path);
  if (extension == ".pfm") return encode_pfm(image);
  if (extension != ".exr") throw Error(ErrorKind::Usage, path + ": scene-linear images are saved as .exr or .pfm");
  return encode_exr(image.width(), image.height(), rgba_channels(image));
}

void save_image(const std::string& path, const Rgba8Image& image) { save_bytes(path, encode_image(path, image)); }
void save_image(const std::string& path, const LinearImage& image) { save_bytes(path, encode_image(path, image)); }

}  // namespace zoneplate
