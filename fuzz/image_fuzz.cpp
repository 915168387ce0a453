// SPDX-License-Identifier: Apache-2.0
// A fuzz target of libFuzzer: bytes that pretend to be an image.
//
// The codecs are libraries without sanitizers; what is watched is what we do with them. Checksums of a PNG's chunks are
// put right first, since a wrong one ends the reading before anything else is seen.
#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/animated/animation_reader.h"
#include "zoneplate/codec/color/icc.h"
#include "zoneplate/codec/exr/exr_dwa.h"
#include "zoneplate/codec/exr/exr_header.h"
#include "zoneplate/codec/exr/exr_layer.h"
#include "zoneplate/codec/exr/exr_replace.h"
#include "zoneplate/codec/inspect/color_space.h"
#include "zoneplate/codec/inspect/image_format.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/formats/import/image_file.h"

namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::uint64_t max_pixels = 1 << 20;

std::uint32_t word_at(const Bytes& bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word = word << 8 | bytes[at + i];
  return word;
}

void put_checksums_right(Bytes& png) {
  for (std::size_t at = 8; at + 12 <= png.size();) {
    const std::size_t size = word_at(png, at);
    if (size > png.size() - at - 12) return;
    const auto sum = static_cast<std::uint32_t>(crc32(0, &png[at + 4], static_cast<uInt>(size + 4)));
    for (std::size_t i = 0; i < 4; ++i) png[at + 8 + size + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
    at += 12 + size;
  }
}

/// The bytes as a chunk that DWA packs, of every kind of channel.
void unpack_dwa(const Bytes& packed) {
  using enum zoneplate::ExrType;
  static const zoneplate::DwaDecoder decoder;
  const zoneplate::DwaChannel channels[] = {
      {"A", Half, 19, 11},  {"B", Half, 19, 11},    {"G", Half, 19, 11},    {"R", Half, 19, 11},
      {"Z", Float, 19, 11}, {"id", Number, 19, 11}, {"v.Y", Float, 19, 11}, {"w.Y", Half, 10, 6, 2, true}};
  Bytes out(19 * 11 * (4 * 2 + 3 * 4) + 10 * 6 * 2);
  decoder.unpack(packed, channels, 0, out);
}

/// The image of an EXR in its own place, and another one.
void replace_layer(const Bytes& exr) {
  constexpr std::uint64_t few_pixels = 1 << 12;
  for (const zoneplate::ExrArea area : {zoneplate::ExrArea::Display, zoneplate::ExrArea::Whole}) {
    const zoneplate::ExrChoice choice{.area = area};
    const zoneplate::LinearImage image = zoneplate::decode_exr_as_stored(exr, "image", few_pixels, choice);
    const Bytes same = zoneplate::replace_exr_layer(exr, "image", choice, image).bytes;
    if (zoneplate::read_exr_parts(same).empty()) std::abort();
    zoneplate::replace_exr_layer(exr, "image", choice, zoneplate::LinearImage(3, 2));
    zoneplate::replace_exr_layer(exr, "image", choice, image, {.is_converted = true});
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, data + size);
  const std::string_view format = ZONEPLATE_FUZZ_FORMAT;
  if (format == "png" || format == "apng") put_checksums_right(bytes);
  try {
    zoneplate::color_space_of(bytes);
    const zoneplate::FileColor color = zoneplate::read_file_color(bytes);
    zoneplate::make_rgb_space(color.profile);
    if (!color.profile.icc.empty()) zoneplate::read_icc_space(color.profile.icc, color.is_grey);
  } catch (const zoneplate::Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  zoneplate::count_frames(bytes);
  zoneplate::exr_layers(zoneplate::read_exr_parts(bytes));
  if (std::string_view(ZONEPLATE_FUZZ_FORMAT) == "exr") unpack_dwa(bytes);
  try {
    const std::string name = "image";
    if (const auto animation = zoneplate::open_animation(bytes, name, max_pixels)) {
      constexpr std::size_t max_frames = 20;
      const auto info = animation->info();
      for (std::size_t i = 0; i < std::min(info.frames, max_frames); ++i) {
        const zoneplate::TexelImage frame = animation->next().image;
        if (frame.width() != info.size.x || frame.height() != info.size.y) std::abort();
      }
    }
    if (format == "pfm") {
      zoneplate::decode_pfm(bytes, "image", max_pixels);  // no texture is one
      return 0;
    }
    const auto stated = zoneplate::find_image_size(bytes);
    if (format == "exr") replace_layer(bytes);
    const zoneplate::TexelImage image = zoneplate::decode_image(bytes, "image", max_pixels).texels;
    // The budget of an import is asked by what the header states.
    if (!stated || stated->x < image.width() || stated->y < image.height()) std::abort();
  } catch (const zoneplate::Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
