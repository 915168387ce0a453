// SPDX-License-Identifier: Apache-2.0
// What the readers of models need of libraries of codecs, in a page: images are decoded by the browser.
#include <emscripten/emscripten.h>
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "../no_system.h"
#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/codec/bitmap/tga.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/codec/ktx2/ktx2.h"
#include "zoneplate/formats/3mf/3mf.h"
#include "zoneplate/formats/amf/amf.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/formats/import/scene_bytes.h"
#include "zoneplate/formats/meshopt/meshopt.h"
#include "zoneplate/formats/zip/zip.h"
#include "zoneplate/job/import_time.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/library.h"

// Module.images: the decoded images, { bytes, width, height, depth, data }, where data is null for one that the browser
// cannot decode. Module.missing: the bytes of those that a reader met and that are not decoded.
// clang-format off
EM_JS(int, find_image, (const std::uint8_t* bytes, std::size_t size), {
  const own = HEAPU8.subarray(bytes, bytes + size);
  const found = Module.images.findIndex((image) => image.bytes.length === size && image.bytes.every((byte, i) => byte === own[i]));
  if (found < 0) Module.missing.push(own.slice());
  return found;
});
EM_JS(int, image_value, (int image, int which), {
  const { width, height, depth, data } = Module.images[image];
  return data ? [width, height, depth][which] : 0;
});
EM_JS(void, copy_image, (int image, void* to), {
  const { data } = Module.images[image];
  HEAPU8.set(new Uint8Array(data.buffer, data.byteOffset, data.byteLength), to);
});
// clang-format on

namespace zoneplate {

const std::string_view this_door = "this page";

/// Why the page does not decode an image that the program does; empty for others.
static std::string_view reason_of(std::span<const std::uint8_t> bytes) {
  const std::string_view start(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 4));
  if (start == "\x76\x2f\x31\x01") return "OpenEXR images are read by the program, not by this page";
  return "";
}

std::optional<int2> find_image_size(std::span<const std::uint8_t> bytes) {
  if (is_hdr(bytes)) return find_hdr_size(bytes);
  if (is_ktx2(bytes)) return find_ktx2_size(bytes);
  if (is_tga(bytes)) return find_tga_size(bytes);
  if (!reason_of(bytes).empty()) return std::nullopt;
  const int image = find_image(bytes.data(), bytes.size());
  if (image < 0 || image_value(image, 0) == 0) return std::nullopt;
  return int2{image_value(image, 0), image_value(image, 1)};
}

std::uint64_t decoded_image_memory(std::span<const std::uint8_t> bytes) {
  const std::optional<int2> size = find_image_size(bytes);
  if (!size) return 0;
  const std::uint64_t texel = is_hdr(bytes)    ? sizeof(float4)
                              : is_ktx2(bytes) ? ktx2_texel_memory(bytes)
                                               : sizeof(Rgba16);
  return texel * static_cast<std::uint64_t>(size->x) * static_cast<std::uint64_t>(size->y);
}
std::uint64_t image_working_memory(std::span<const std::uint8_t> bytes) { return ktx2_working_memory(bytes); }

template <class Texel>
static Plane<Texel> image_of(int image) {
  Plane<Texel> out(image_value(image, 0), image_value(image, 1));
  copy_image(image, out.values().data());
  return out;
}

DecodedImage decode_image(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
                          const std::string& /*layer*/) {
  if (const std::string_view reason = reason_of(bytes); !reason.empty())
    throw Error(ErrorKind::Input, fmt::format("{}: {}", name, reason));
  if (is_hdr(bytes)) return {decode_hdr_rgba(bytes, name, max_pixels)};
  if (is_ktx2(bytes)) return {decode_ktx2(bytes, name, max_pixels)};
  if (is_tga(bytes)) return {decode_tga(bytes, name, max_pixels)};
  const std::optional<int2> size = find_image_size(bytes);
  if (!size) throw Error(ErrorKind::Input, name + ": the browser does not decode this image");
  if (static_cast<std::uint64_t>(size->x) * static_cast<std::uint64_t>(size->y) > max_pixels)
    throw Error(ErrorKind::Input, name + ": too many pixels");
  const int image = find_image(bytes.data(), bytes.size());
  if (image_value(image, 2) == 16) return {image_of<Rgba16>(image)};
  return {image_of<Rgba8>(image)};
}

std::optional<std::string> size_warning(const TextureImage&) { return std::nullopt; }

bool open_library(Library) { return false; }
SharedLibrary::SharedLibrary(Library library, const std::string& place) : library_(library), place_(place) {
  refuse(place, "data packed by Zstandard are read by");
}
SharedLibrary::Found SharedLibrary::find(const char*) const { return Found(nullptr); }

std::vector<std::uint8_t> decode_meshopt(const JsonView& json, std::span<const std::uint8_t>, ImportBudget&) {
  json.fail("data packed by meshoptimizer are read by the program, not by this page");
}

bool is_zip(std::span<const std::uint8_t>) { return false; }
Scene load_3mf(const std::string& path, const LoadLimits&) { refuse(path, "3MF models are read by"); }
Scene load_amf(const std::string& path, const LoadLimits&) { refuse(path, "AMF models are read by"); }

// Scenes are read in no child process.
void write_scene(const Scene&, const ByteSink&) {}
Scene read_scene(const ByteSource&, ImportBudget&) { return {}; }

std::string late_reading(const std::string& name, const LoadLimits& limits) {
  return fmt::format("{}: takes longer to load than the limit of {:.6g} s (--max-import-seconds)", name,
                     limits.seconds);
}
// Files and decoded images are those of the module's first thread.
void within_import_time(const std::string& name, const LoadLimits& limits, const std::function<void()>& read) {
  with_deadline(limits.seconds, ErrorKind::Input, late_reading(name, limits), [&] { with_threads(1, read); });
}

}  // namespace zoneplate
