// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/jpeg.h"

#include <csetjmp>
#include <cstddef>
#include <cstdio>

#include <jpeglib.h>

#include <jerror.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "zoneplate/base/callback_error.h"
#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

static_assert(sizeof(Rgba8) == 4, "rows are handed to libjpeg as they lie");

/// libjpeg's error manager, with the longjmp target and the error message, or the exception of a callback, and the
/// first warning.
struct Report {
  jpeg_error_mgr manager{};
  std::jmp_buf place;
  CallbackError error;
  std::array<char, JMSG_LENGTH_MAX> message{}, warning{};
};

[[noreturn]] void jump_back(j_common_ptr jpeg) {
  auto* report = reinterpret_cast<Report*>(jpeg->err);
  jpeg->err->format_message(jpeg, report->message.data());
  std::longjmp(report->place, 1);
}

/// libjpeg conceals damage and warns. The first warning is kept, unless it concerns neither pixels nor the file's end:
/// bytes too many before a marker are skipped, and no pixel is missing.
void keep_warning(j_common_ptr jpeg, int level) {
  auto* report = reinterpret_cast<Report*>(jpeg->err);
  const int code = jpeg->err->msg_code;
  const bool is_harmless =
      level >= 0 || code == JWRN_EXTRANEOUS_DATA || code == JWRN_ADOBE_XFORM || code == JWRN_BOGUS_ICC;
  if (!is_harmless && report->warning[0] == '\0') jpeg->err->format_message(jpeg, report->warning.data());
}

/// The limit of scans: a small file can contain very many scans of a large image. Encoders write about ten. The limit
/// is 200, reduced for large images to 2^31 pixels in total, but not below 32.
int max_scans(const jpeg_decompress_struct& jpeg) {
  constexpr std::uint64_t max_pixels = std::uint64_t{1} << 31, least = 32, most = 200;
  const std::uint64_t pixels = std::max<std::uint64_t>(std::uint64_t{jpeg.image_width} * jpeg.image_height, 1);
  return static_cast<int>(std::clamp(max_pixels / pixels, least, most));
}

/// libjpeg's progress monitor, called between rows of blocks while scans are read and pixels are decoded.
///
/// It does not throw, because exceptions must not unwind libjpeg's frames: it jumps, and `check` throws.
void check_progress(j_common_ptr jpeg) {
  const auto* const decoder = reinterpret_cast<j_decompress_ptr>(jpeg);
  auto* report = reinterpret_cast<Report*>(jpeg->err);
  const bool has_time = report->error.guarded(false, [] {
    check_deadline();
    return true;
  });
  if (has_time && decoder->input_scan_number <= max_scans(*decoder)) return;
  std::snprintf(report->message.data(), report->message.size(), "more than %d scans of %u x %u pixels",
                max_scans(*decoder), decoder->image_width, decoder->image_height);
  std::longjmp(report->place, 1);
}

class Reader {
 public:
  Reader(std::span<const std::uint8_t> bytes, const std::string& name) : bytes_(bytes), name_(name) {
    jpeg_.err = jpeg_std_error(&report_.manager);
    report_.manager.error_exit = jump_back;
    report_.manager.emit_message = keep_warning;
    check(guarded([this] { jpeg_create_decompress(&jpeg_); }));
    progress_.progress_monitor = check_progress;
    jpeg_.progress = &progress_;
  }
  ~Reader() { jpeg_destroy_decompress(&jpeg_); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  std::optional<JpegFrame> frame() {
    if (!read_header()) return std::nullopt;
    JpegFrame frame{.size = {static_cast<int>(jpeg_.image_width), static_cast<int>(jpeg_.image_height)},
                    .pixels = static_cast<std::uint64_t>(jpeg_.max_h_samp_factor) *
                              static_cast<std::uint64_t>(jpeg_.max_v_samp_factor)};
    for (const jpeg_component_info& component :
         std::span(jpeg_.comp_info, static_cast<std::size_t>(jpeg_.num_components)))
      frame.samples +=
          static_cast<std::uint64_t>(component.h_samp_factor) * static_cast<std::uint64_t>(component.v_samp_factor);
    return frame;
  }

  JpegImage decode(std::uint64_t max_pixels) {
    check(read_header());
    check_size(max_pixels);
    check_data();
    const bool is_cmyk = jpeg_.jpeg_color_space == JCS_CMYK || jpeg_.jpeg_color_space == JCS_YCCK;
    jpeg_.out_color_space = is_cmyk ? JCS_CMYK : JCS_EXT_RGBA;
    // The exact integer transform gives the same codes on every machine.
    jpeg_.dct_method = JDCT_ISLOW;
    jpeg_.do_block_smoothing = FALSE;

    Rgba8Image image(static_cast<int>(jpeg_.image_width), static_cast<int>(jpeg_.image_height));
    read_rows(image);
    if (is_cmyk) mix_inks(image);
    std::string flaw = report_.warning[0] == '\0' ? "" : name_ + ": JPEG: " + report_.warning.data();
    return {std::move(image), std::move(flaw)};
  }

 private:
  /// Runs `body`, which must not need destructors; false if libjpeg reported an error.
  template <class Body>
  bool guarded(Body body) {
    if (setjmp(report_.place) != 0) return false;
    body();
    return true;
  }

  bool read_header() {
    return guarded([this] {
      jpeg_mem_src(&jpeg_, bytes_.data(), bytes_.size());
      jpeg_read_header(&jpeg_, TRUE);
    });
  }

  void check(bool is_well) {
    if (is_well) return;
    report_.error.rethrow();
    throw Error(ErrorKind::Input, name_ + ": JPEG: " + report_.message.data());
  }

  void check_size(std::uint64_t max_pixels) const {
    const std::uint64_t pixels = std::uint64_t{jpeg_.image_width} * jpeg_.image_height;
    if (pixels > max_pixels) {
      throw Error(ErrorKind::Input, name_ + ": JPEG: " + std::to_string(jpeg_.image_width) + " x " +
                                        std::to_string(jpeg_.image_height) + " pixels, at most " +
                                        std::to_string(max_pixels) + " are allowed");
    }
    // A Huffman code takes at least one bit per block of 8 x 8 pixels, so that a file with far fewer bytes is
    // truncated.
    if (!jpeg_.arith_code && pixels / 1024 > bytes_.size()) throw Error(ErrorKind::Input, name_ + ": JPEG: truncated");
  }

  /// Throws if a marker follows the header of the first scan at once: then nothing of the image can be decoded.
  void check_data() const {
    const std::span<const JOCTET> data(jpeg_.src->next_input_byte, jpeg_.src->bytes_in_buffer);
    if (data.empty() || (data[0] == 0xff && (data.size() < 2 || data[1] != 0)))
      throw Error(ErrorKind::Input, name_ + ": JPEG: has no data of its pixels");
  }

  void read_rows(Rgba8Image& image) {
    auto* pixels = reinterpret_cast<JSAMPROW>(image.values().data());
    const std::size_t stride = image.row(0).size_bytes();
    check(guarded([this, pixels, stride] {
      jpeg_start_decompress(&jpeg_);
      while (jpeg_.output_scanline < jpeg_.output_height) {
        JSAMPROW row = pixels + jpeg_.output_scanline * stride;
        jpeg_read_scanlines(&jpeg_, &row, 1);
      }
      jpeg_finish_decompress(&jpeg_);
    }));
  }

  /// Converts CMYK to RGB: each ink transmits light, and the transmittances are multiplied. Files with Adobe's marker
  /// store transmittance, others store ink.
  void mix_inks(Rgba8Image& image) const {
    const bool is_light = jpeg_.saw_Adobe_marker;
    const auto light = [&](int code) { return is_light ? code : 255 - code; };
    for (Rgba8& c : image.values()) {
      const int k = light(c.a);
      const auto mixed = [&](int code) { return static_cast<std::uint8_t>((light(code) * k + 127) / 255); };
      c = {mixed(c.r), mixed(c.g), mixed(c.b), 255};
    }
  }

  Report report_;
  jpeg_progress_mgr progress_{};
  jpeg_decompress_struct jpeg_{};
  std::span<const std::uint8_t> bytes_;
  const std::string& name_;
};

}  // namespace

bool is_jpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

std::optional<JpegFrame> read_jpeg_frame(std::span<const std::uint8_t> bytes) {
  const std::string no_name;
  return is_jpeg(bytes) ? Reader(bytes, no_name).frame() : std::nullopt;
}

JpegImage decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  if (!is_jpeg(bytes)) throw Error(ErrorKind::Input, name + ": not a JPEG file");
  return Reader(bytes, name).decode(max_pixels);
}

}  // namespace zoneplate
