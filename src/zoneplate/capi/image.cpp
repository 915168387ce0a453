// SPDX-License-Identifier: Apache-2.0
// Images: their arrays, and files of them.
#include <algorithm>
#include <cstdint>

#include "zoneplate/capi/arrays.h"
#include "zoneplate/capi/handles.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/os/file.h"

using namespace zoneplate;
using namespace zoneplate::capi;

namespace zoneplate::capi {
namespace {

zoneplate_type type_of(const Rgba8Image&) { return ZONEPLATE_UINT8; }
zoneplate_type type_of(const Rgba16Image&) { return ZONEPLATE_UINT16; }
zoneplate_type type_of(const LinearImage&) { return ZONEPLATE_FLOAT32; }
zoneplate_type type_of(std::monostate) { throw Error(ErrorKind::Usage, "the image has no array 'color'"); }

[[noreturn]] void refuse_format(const std::string& format, const char* formats) {
  throw Error(ErrorKind::Usage, fmt::format("'{}' is not a format of this image; there are {}", format, formats));
}

std::vector<std::uint8_t> encode(const LinearImage& image, bool has_alpha, const std::string& format,
                                 const std::string& name) {
  if (has_alpha) check_alpha('.' + format, name);
  if (format == "pfm") return encode_pfm(image);
  if (format != "exr") refuse_format(format, "exr and pfm");
  return encode_exr(image.width(), image.height(), rgba_channels(image));
}
std::vector<std::uint8_t> encode(const Rgba8Image& image, bool has_alpha, const std::string& format,
                                 const std::string& name) {
  return encode_codes(image, has_alpha, '.' + format, name);
}
std::vector<std::uint8_t> encode(const Rgba16Image& image, bool has_alpha, const std::string& format,
                                 const std::string&) {
  if (format != "png") refuse_format(format, "png");
  return encode_png(image, {.has_alpha = has_alpha});
}
std::vector<std::uint8_t> encode(std::monostate color, bool, const std::string&, const std::string&) {
  static_cast<void>(type_of(color));
  return {};
}

/// `name` is for messages.
std::vector<std::uint8_t> encode(const zoneplate_image& image, const std::string& format, const std::string& name) {
  return std::visit([&](const auto& color) { return encode(color, image.has_alpha(), format, name); }, image.color());
}

/// Whether alpha is less than its maximum anywhere.
template <class Pixel>
bool is_clear_anywhere(const Plane<Pixel>& image) {
  return std::ranges::any_of(image.values(), [](const Pixel& c) { return c.a < Pixel{}.a; });
}

}  // namespace
}  // namespace zoneplate::capi

zoneplate_image::zoneplate_image(Color color, bool has_alpha) : color_(std::move(color)), has_alpha_(has_alpha) {
  std::visit(
      [&](const auto& plane) {
        const zoneplate_type type = type_of(plane);
        if constexpr (!std::is_same_v<const std::monostate&, decltype(plane)>)
          arrays_.emplace_back("color", array_of(plane.values().data(), type, {plane.height(), plane.width(), 4}));
      },
      color_);
}

void zoneplate_image::add(std::string name, const zoneplate_array& array, std::shared_ptr<const void> owner) {
  arrays_.emplace_back(std::move(name), array);
  memory_.push_back(std::move(owner));
}

void zoneplate_image::add(std::string name, Plane<float> plane) {
  const auto kept = std::make_shared<const Plane<float>>(std::move(plane));
  add(std::move(name), array_of(kept->values().data(), ZONEPLATE_FLOAT32, {kept->height(), kept->width()}), kept);
}

void zoneplate_image::add(std::string name, std::vector<double> values) {
  const auto kept = std::make_shared<const std::vector<double>>(std::move(values));
  add(std::move(name), array_of(kept->data(), ZONEPLATE_FLOAT64, {std::ssize(*kept)}), kept);
}

size_t zoneplate_image_count(const zoneplate_image* image) { return image == nullptr ? 0 : image->arrays().size(); }

const char* zoneplate_image_name(const zoneplate_image* image, size_t index) {
  return index < zoneplate_image_count(image) ? image->arrays()[index].first.c_str() : nullptr;
}

zoneplate_status zoneplate_image_array(const zoneplate_image* image, const char* name, zoneplate_array* array) {
  return guarded([&] {
    const std::string wanted = &required(name, "name");
    std::string names;
    for (const auto& [found, view] : required(image, "image").arrays()) {
      if (found == wanted) {
        required(array, "array") = view;
        return;
      }
      names += (names.empty() ? "" : ", ") + found;
    }
    throw Error(ErrorKind::Usage, fmt::format("the image has no array '{}'; there are {}", wanted, names));
  });
}

zoneplate_status zoneplate_image_encode(const zoneplate_image* image, const char* format, zoneplate_image** bytes) {
  return guarded([&] {
    const std::string ending = &required(format, "format");
    const auto file = std::make_shared<const std::vector<std::uint8_t>>(
        encode(required(image, "image"), ending, fmt::format("'{}'", ending)));
    auto out = std::make_unique<zoneplate_image>();
    out->add("bytes", array_of(file->data(), ZONEPLATE_UINT8, {std::ssize(*file)}), file);
    required(bytes, "bytes") = out.release();
  });
}

zoneplate_status zoneplate_image_save(const zoneplate_image* image, const char* path) {
  return guarded([&] {
    const std::string file = &required(path, "path");
    const std::string extension = extension_of(file);
    save_bytes(file, encode(required(image, "image"), extension.empty() ? extension : extension.substr(1), file));
  });
}

void zoneplate_image_free(zoneplate_image* image) { delete image; }

zoneplate_status zoneplate_image_new(const zoneplate_array* pixels, zoneplate_image** image) {
  return guarded([&] {
    const TexelImage texels = texels_of(required(pixels, "pixels"), "pixels");
    std::unique_ptr<zoneplate_image> out = texels.visit([](const auto& plane) {
      if constexpr (std::is_same_v<decltype(plane), const Plane<float4>&>) {
        LinearImage light(plane.width(), plane.height());
        std::ranges::transform(plane.values(), light.values().begin(), [](float4 c) {
          return Linear{c.x, c.y, c.z, c.w};
        });
        const bool has_alpha = is_clear_anywhere(light);
        return std::make_unique<zoneplate_image>(std::move(light), has_alpha);
      } else {
        return std::make_unique<zoneplate_image>(plane, is_clear_anywhere(plane));
      }
    });
    required(image, "image") = out.release();
  });
}

zoneplate_status zoneplate_image_load(const char* path, zoneplate_image** image) {
  return guarded([&] {
    metrics::Picture picture = metrics::load_picture(&required(path, "path"));
    if (!picture.flaw.empty()) throw Error(ErrorKind::Input, picture.flaw);
    const bool has_alpha = is_clear_anywhere(picture.linear);
    std::unique_ptr<zoneplate_image> out;
    if (picture.is_scene_linear)
      out = std::make_unique<zoneplate_image>(std::move(picture.linear), has_alpha);
    else
      out = std::make_unique<zoneplate_image>(quantize8(picture.display), has_alpha);
    required(image, "image") = out.release();
  });
}
