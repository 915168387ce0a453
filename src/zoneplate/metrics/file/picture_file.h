// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/metrics/file/stored.h"
#include "zoneplate/metrics/picture.h"
#include "zoneplate/scene/texel_image.h"

namespace zoneplate::metrics {

/// The endings of the image files that are found in folders: ".png, .jpg ... or .tga".
std::string image_endings();

/// Opens an image file; "-" is stdin.
///
/// Errors    ErrorKind::Input naming the file and the cause.
ImageFile open_image(const std::string& path);

/// Decodes an image from a PNG (8 or 16 bits), JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, HDR, EXR, PFM, BMP or TGA file,
/// recognised by its first bytes, or the frame of an animation, as sRGB. Of a damaged JPEG what can be decoded is kept,
/// with a flaw. Of an animation without `decode_frame` the first frame is decoded.
///
/// HDR, EXR, PFM, and TIFF and JPEG XL of floats contain unbounded linear light, which is kept as it is stored, with
/// NaN and infinities; their display-referred values are clamped. Values stay as they are stored, in the colour space
/// of the file, and the image is turned as its orientation (of Exif, TIFF, AVIF or JPEG XL) says.
/// Errors    ErrorKind::Input naming the file and the cause, also for more than `max_pixels`.
Picture decode_file(const ImageFile& file, std::uint64_t max_pixels = std::uint64_t{1} << 28);

/// The same from the bytes of a file; `name` is for messages, `exr` chooses the image of an EXR.
Picture decode_picture(std::span<const std::uint8_t> bytes, const std::string& name,
                       std::uint64_t max_pixels = std::uint64_t{1} << 28, const ExrChoice& exr = {});

/// The same image in sRGB codes, or light of Rec.709 primaries. Display-referred colours outside sRGB are clamped.
Picture in_srgb(Picture picture);

/// Loads an image in sRGB, or light of Rec.709 primaries.
Picture load_picture(const std::string& path, std::uint64_t max_pixels = std::uint64_t{1} << 28);

/// A display-referred picture of codes, which has their values exactly.
Picture picture_of(const TexelImage& codes);

/// True if a path names a directory that can be seen.
bool is_directory(const std::string& path);

/// The image files of one operand, in order.
struct PictureFiles {
  std::vector<std::string> paths;
  std::vector<std::uint64_t> numbers = {};  ///< ascending: of the frames of a pattern, or of a folder with one sequence
};

/// Lists the files of one operand, in order.
///
/// A directory: its files with the endings of image formats (image_endings) in natural order (9 before 10), without
/// subfolders. A name whose last component contains `####` or `%04d`: the files with a number in its place, in
/// the order of the numbers. Any other operand: that file.
///
/// Errors    ErrorKind::Input if a directory or a pattern matches no image.
PictureFiles list_pictures(const std::string& operand);

/// Whether a directory has an image that list_pictures lists.
bool has_pictures(const std::string& directory);

/// Lists the images of a directory and of its subfolders, in natural order of their paths.
///
/// Errors    ErrorKind::Input if there is none, or a folder cannot be read.
std::vector<std::string> list_pictures_below(const std::string& directory);

/// The names of a directory's files, below it too, that end as images or films that list_pictures omits.
std::vector<std::string> list_other_images(const std::string& directory);

/// True if the names differ only by numbers, as those of the frames of a sequence do.
bool are_frames(const std::vector<std::string>& paths);

}  // namespace zoneplate::metrics
