// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/system/avif.h"

#include <avif/avif.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/system/boxes.h"
#include "zoneplate/codec/system/in_child.h"
#include "zoneplate/codec/system/owned.h"

namespace zoneplate {
namespace {

using View = std::span<const std::uint8_t>;

/// The functions of libavif.
struct AvifLibrary {
  SharedLibrary library;
  decltype(&avifResultToString) result_text = library.find("avifResultToString");
  decltype(&avifDecoderCreate) make_decoder = library.find("avifDecoderCreate");
  decltype(&avifDecoderDestroy) free_decoder = library.find("avifDecoderDestroy");
  decltype(&avifDecoderSetIOMemory) set_input = library.find("avifDecoderSetIOMemory");
  decltype(&avifDecoderParse) parse = library.find("avifDecoderParse");
  decltype(&avifDecoderNextImage) next_image = library.find("avifDecoderNextImage");
  decltype(&avifRGBImageSetDefaults) set_defaults = library.find("avifRGBImageSetDefaults");
  decltype(&avifImageYUVToRGB) to_rgb = library.find("avifImageYUVToRGB");
  decltype(&avifImageCreate) make_image = library.find("avifImageCreate");
  decltype(&avifImageDestroy) free_image = library.find("avifImageDestroy");
  decltype(&avifImageRGBToYUV) from_rgb = library.find("avifImageRGBToYUV");
  decltype(&avifEncoderCreate) make_encoder = library.find("avifEncoderCreate");
  decltype(&avifEncoderDestroy) free_encoder = library.find("avifEncoderDestroy");
  decltype(&avifEncoderWrite) write = library.find("avifEncoderWrite");
  decltype(&avifRWDataFree) free_data = library.find("avifRWDataFree");

  explicit AvifLibrary(const std::string& place) : library(Library::Avif, place) {}
};

/// The orientation of Exif that a rotation, anticlockwise in quarter turns, and a mirror after it stand for.
///
/// Source    MIAF (ISO/IEC 23000-22), 7.3.6.7: the order of the transformations.
int orientation_of(const avifImage& image) {
  const bool is_turned = (image.transformFlags & AVIF_TRANSFORM_IROT) != 0;
  const bool is_mirrored = (image.transformFlags & AVIF_TRANSFORM_IMIR) != 0;
  const std::size_t turn = is_turned ? image.irot.angle & 3u : 0u;
  constexpr int turned[] = {1, 8, 3, 6}, upside_down[] = {4, 5, 2, 7}, left_right[] = {2, 7, 4, 5};
  if (!is_mirrored) return turned[turn];
  return image.imir.mode == 0 ? upside_down[turn] : left_right[turn];
}

template <class Pixel>
Plane<Pixel> decode_pixels(const AvifLibrary& library, const avifImage& image, const std::string& name) {
  avifRGBImage rgb;
  library.set_defaults(&rgb, &image);
  Plane<Pixel> out(static_cast<int>(image.width), static_cast<int>(image.height));
  rgb.depth = 8 * sizeof(decltype(Pixel::r));
  rgb.format = AVIF_RGB_FORMAT_RGBA;
  // The library's own conversion, which is exact and does not depend on the processor.
  rgb.avoidLibYUV = AVIF_TRUE;
  rgb.chromaUpsampling = AVIF_CHROMA_UPSAMPLING_BILINEAR;
  rgb.pixels = reinterpret_cast<std::uint8_t*>(out.values().data());
  rgb.rowBytes = static_cast<std::uint32_t>(sizeof(Pixel)) * image.width;
  if (const avifResult result = library.to_rgb(&image, &rgb); result != AVIF_RESULT_OK)
    throw Error(ErrorKind::Input, fmt::format("{}: AVIF: {}", name, library.result_text(result)));
  return out;
}

StoredImage decode(View bytes, const std::string& name, std::uint64_t max_pixels) {
  const AvifLibrary library(name + ": an AVIF image");
  const auto decoder = owned(library.make_decoder(), library.free_decoder);
  const auto check = [&](avifResult result) {
    if (result != AVIF_RESULT_OK)
      throw Error(ErrorKind::Input,
                  fmt::format("{}: AVIF: is corrupt or truncated: {}", name, library.result_text(result)));
  };
  decoder->maxThreads = 1;
  decoder->ignoreExif = decoder->ignoreXMP = AVIF_TRUE;
  decoder->imageSizeLimit =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(max_pixels, AVIF_DEFAULT_IMAGE_SIZE_LIMIT));
  decoder->imageDimensionLimit = 65536;
  // Files of older programs lack the box pixi, or have a clean aperture that the standard rejects.
  decoder->strictFlags = AVIF_STRICT_DISABLED;
  check(library.set_input(decoder.get(), bytes.data(), bytes.size()));
  check(library.parse(decoder.get()));
  check(library.next_image(decoder.get()));
  const avifImage& image = *decoder->image;
  if (image.width == 0 || image.height == 0 || std::uint64_t{image.width} * image.height > max_pixels)
    throw Error(ErrorKind::Input, fmt::format("{}: AVIF: {} x {} pixels, at most {} are allowed", name, image.width,
                                              image.height, max_pixels));
  StoredImage out{.pixels = {}, .orientation = orientation_of(image)};
  if (image.depth == 8)
    out.pixels = decode_pixels<Rgba8>(library, image, name);
  else
    out.pixels = decode_pixels<Rgba16>(library, image, name);
  return out;
}

/// What the properties of items, and the descriptions of tracks, state.
struct Properties {
  int2 greatest{0, 0};
  std::size_t frames = 0;
  ColorTags colors;

  void take_size(std::uint64_t width, std::uint64_t height) {
    constexpr std::uint64_t most = 0x7fffffff;
    if (width == 0 || height == 0 || width > most || height > most) return;
    greatest = {std::max(greatest.x, static_cast<int>(width)), std::max(greatest.y, static_cast<int>(height))};
  }
  void take_colors(View box) {
    const std::string_view kind(reinterpret_cast<const char*>(box.data()), 4);
    if ((kind == "prof" || kind == "rICC") && colors.profile.empty()) colors.profile = box.subspan(4);
    if (kind == "nclx" && box.size() >= 8 && !colors.cicp && box[4] == 0 && box[6] == 0) colors.cicp = {box[5], box[7]};
  }
};

/// Boxes in boxes down to `depth` levels, of which AVIF has five.
void read_properties(View bytes, Properties& out, int depth = 6) {
  if (depth == 0) return;
  for_boxes(bytes, [&](std::string_view name, View box) {
    constexpr std::size_t version_and_flags = 4;
    if (name == "meta" && box.size() > version_and_flags)
      read_properties(box.subspan(version_and_flags), out, depth - 1);
    if (name == "iprp" || name == "ipco" || name == "moov" || name == "trak" || name == "mdia" || name == "minf" ||
        name == "stbl")
      read_properties(box, out, depth - 1);
    if (name == "colr" && box.size() >= 4) out.take_colors(box);
    if (name == "ispe" && box.size() >= 12) out.take_size(big_endian(box, 4, 4), big_endian(box, 8, 4));
    // The sizes of the samples of a track, which are its frames.
    if (name == "stsz" && box.size() >= 12)
      out.frames = std::max(out.frames, static_cast<std::size_t>(big_endian(box, 8, 4)));
    // The sample description, whose first entry states the size of its images.
    if (name == "stsd" && box.size() >= 8 + 8 + 28)
      out.take_size(big_endian(box, 8 + 8 + 24, 2), big_endian(box, 8 + 8 + 26, 2));
    return true;
  });
}

}  // namespace

bool is_avif(View bytes) {
  if (bytes.size() < 12) return false;
  const std::string_view start(reinterpret_cast<const char*>(bytes.data()) + 4, 8);
  if (start == "ftypavif" || start == "ftypavis") return true;
  if (!start.starts_with("ftypmif1") && !start.starts_with("ftypmsf1")) return false;
  // A file of the general brand may be AVIF among others: the compatible brands state it.
  const std::size_t end = std::min<std::size_t>(bytes.size(), static_cast<std::size_t>(big_endian(bytes, 0, 4)));
  for (std::size_t at = 16; at + 4 <= end; at += 4) {
    const std::string_view brand(reinterpret_cast<const char*>(bytes.data()) + at, 4);
    if (brand == "avif" || brand == "avis") return true;
  }
  return false;
}

std::optional<int2> find_avif_size(View bytes) {
  if (!is_avif(bytes)) return std::nullopt;
  Properties properties;
  read_properties(bytes, properties);
  return properties.greatest.x > 0 ? std::optional(properties.greatest) : std::nullopt;
}

std::size_t count_avif_frames(View bytes) {
  Properties properties;
  if (is_avif(bytes)) read_properties(bytes, properties);
  return properties.frames;
}

ColorTags find_avif_colors(View bytes) {
  Properties properties;
  if (is_avif(bytes)) read_properties(bytes, properties);
  return properties.colors;
}

StoredImage decode_avif(View bytes, const std::string& name, std::uint64_t max_pixels) {
  const std::optional<int2> size = find_avif_size(bytes);
  if (!size) throw Error(ErrorKind::Input, name + ": AVIF: it states no size");
  const std::uint64_t pixels = static_cast<std::uint64_t>(size->x) * static_cast<std::uint64_t>(size->y);
  if (pixels > max_pixels)
    throw Error(ErrorKind::Input,
                fmt::format("{}: AVIF: {} x {} pixels, at most {} are allowed", name, size->x, size->y, max_pixels));
  // Planes of 16 bits in the library and in its AV1 decoder with the images that it refers to, and a fixed overhead.
  const std::uint64_t memory = 160 * pixels + 2 * bytes.size() + (std::uint64_t{128} << 20);
  return decode_in_child(name + ": AVIF", Library::Avif, memory, pixels, [&] { return decode(bytes, name, pixels); });
}

std::vector<std::uint8_t> encode_avif(const Rgba8Image& image, bool has_alpha) {
  const AvifLibrary library("an AVIF image cannot be written");
  const auto check = [&](avifResult result) {
    if (result != AVIF_RESULT_OK)
      throw Error(ErrorKind::Failed, fmt::format("an image of {} x {} pixels cannot be encoded as AVIF: {}",
                                                 image.width(), image.height(), library.result_text(result)));
  };
  const auto width = static_cast<std::uint32_t>(image.width()), height = static_cast<std::uint32_t>(image.height());
  const auto yuv = owned(library.make_image(width, height, 8, AVIF_PIXEL_FORMAT_YUV444), library.free_image);
  // The identity as the matrix stores green, blue and red themselves.
  yuv->yuvRange = AVIF_RANGE_FULL;
  yuv->colorPrimaries = AVIF_COLOR_PRIMARIES_BT709;
  yuv->transferCharacteristics = AVIF_TRANSFER_CHARACTERISTICS_SRGB;
  yuv->matrixCoefficients = AVIF_MATRIX_COEFFICIENTS_IDENTITY;
  avifRGBImage rgb;
  library.set_defaults(&rgb, yuv.get());
  rgb.format = AVIF_RGB_FORMAT_RGBA;
  rgb.ignoreAlpha = has_alpha ? AVIF_FALSE : AVIF_TRUE;
  rgb.avoidLibYUV = AVIF_TRUE;
  rgb.pixels = const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(image.values().data()));
  rgb.rowBytes = 4 * static_cast<std::uint32_t>(image.width());
  check(library.from_rgb(yuv.get(), &rgb));

  const auto encoder = owned(library.make_encoder(), library.free_encoder);
  constexpr int speed = 6;  // of 0 to 10, from small files to fast encoding
  encoder->codecChoice = AVIF_CODEC_CHOICE_AOM;
  encoder->speed = speed;
  encoder->maxThreads = 1;  // so that the bytes do not depend on the number of processors
  encoder->minQuantizer = encoder->maxQuantizer = AVIF_QUANTIZER_LOSSLESS;
  encoder->minQuantizerAlpha = encoder->maxQuantizerAlpha = AVIF_QUANTIZER_LOSSLESS;
  avifRWData data = AVIF_DATA_EMPTY;
  const std::unique_ptr<avifRWData, decltype(library.free_data)> owner(&data, library.free_data);
  check(library.write(encoder.get(), yuv.get(), &data));
  return {data.data, data.data + data.size};
}

}  // namespace zoneplate
