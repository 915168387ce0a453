// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/filter/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/output/film.h"
#include "zoneplate/job/output/frame_name.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

/// The name under which the confined process hands over an APNG for ffmpeg.
constexpr const char* ffmpeg_input = "frames for ffmpeg";

/// Whether the frames are written as images: to a name with a place for a number, or to a folder.
bool writes_images(const FilterItem& item) {
  return item.is_in_folder || find_frame_place(fs::path(item.output).filename().string());
}

bool is_own_film(const std::string& output) {
  const std::string ending = extension_of(output);
  return ending == ".apng" || ending == ".png" || ending == ".webp";
}

/// Repeats the last column and row of an odd side, for codecs that require even ones.
Rgba8Image with_even_sides(Rgba8Image image) {
  const int width = image.width() + image.width() % 2, height = image.height() + image.height() % 2;
  if (width == image.width() && height == image.height()) return image;
  Rgba8Image out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out(x, y) = image(std::min(x, image.width() - 1), std::min(y, image.height() - 1));
  return out;
}

}  // namespace

std::string frame_output(const FilterItem& item, std::size_t i) {
  const fs::path path(item.output);
  std::string name = path.filename().string();
  if (item.is_in_folder) name = path.stem().string() + ".####" + path.extension().string();
  return (path.parent_path() / frame_name(name, *find_frame_place(name), static_cast<int>(i))).string();
}

FrameSink::FrameSink(const FilterItem& item, const metrics::PictureSet& frames, int bit_depth, Delivery& out)
    : item_(item), bit_depth_(bit_depth), out_(out) {
  const bool has_images = writes_images(item);
  if (!has_images && !is_own_film(item.output) && !is_encoded_by_ffmpeg(item.output))
    throw Error(ErrorKind::Usage,
                fmt::format("{}: is an animation of {} frames, and {} is one image: write an animation (.apng, .png, "
                            ".webp, .gif, .mp4, .mov, .mkv or .webm), or images, as f.####.png or to a folder",
                            item.input, frames.names.size(), item.output));
  if (is_linear_file(item.output))
    throw Error(ErrorKind::Usage, fmt::format("{}: is a display-referred image, and {} is scene-linear: write a .png",
                                              item.input, item.output));
  if (has_images) return;
  if (bit_depth == 16)
    throw Error(ErrorKind::Usage, "--bit-depth 16: animations have 8 bits; write images, as f.####.png");
  // ffmpeg gets the frames as an APNG, which keeps their times and alpha.
  const std::string format = is_encoded_by_ffmpeg(item.output) ? ".apng" : item.output;
  film_ = make_film_encoder(format, {.loops = frames.loops, .has_alpha = frames.has_alpha});
}

void FrameSink::add(const DisplayImage& image, FrameTime time) {
  const std::size_t i = done_++;
  if (film_) return add_to_film(quantize8(image), time);
  const std::string name = frame_output(item_, i);
  if (bit_depth_ == 8) return out_.save(name, encode_image(name, quantize8(image)));
  out_.save(name, encode_png(quantize16(image)));
}

void FrameSink::add_to_film(Rgba8Image image, FrameTime time) {
  if (std::ranges::any_of(image.values(), [](Rgba8 c) { return c.a != 255; }))
    check_alpha(extension_of(item_.output), item_.output);
  if (has_even_sides(item_.output)) image = with_even_sides(std::move(image));
  begin_ += static_cast<double>(time.seconds) / time.per;
  if (extension_of(item_.output) == ".gif" && time.seconds > 0) {
    // A GIF has hundredths of a second, and browsers show delays below two of them as ten: a frame that would be
    // shorter is left out, and its time goes to the next one.
    constexpr std::int64_t least = 2;
    const std::int64_t end = std::llround(100 * begin_);
    if (end - gif_begin_ < least) return;
    time = FrameTime::of_milliseconds(10 * (end - std::exchange(gif_begin_, end)));
  }
  film_->add(std::make_shared<const Rgba8Image>(std::move(image)), time)();
}

void FrameSink::finish() {
  if (!film_) return;
  const std::vector<std::uint8_t> film = film_->finish();
  out_.save(is_encoded_by_ffmpeg(item_.output) ? ffmpeg_input : item_.output, film);
}

void FrameReceiver::take(const std::string& name, std::span<const std::uint8_t> bytes) {
  if (!writes_images(item_) && name == ffmpeg_input)
    return save_bytes(item_.output, encode_film(item_.output, bytes, encoder_));
  if (!writes_images(item_) || name != frame_output(item_, done_))
    throw Error(ErrorKind::Failed, item_.input + ": its process sent a file that is not expected");
  ++done_;
  check_outputs(std::span<const FilterItem>(std::vector<FilterItem>{{.input = item_.input, .output = name}}), kept_);
  save_bytes(name, bytes);
}

}  // namespace zoneplate
