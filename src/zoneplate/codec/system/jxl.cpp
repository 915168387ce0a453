// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/system/jxl.h"
#include "zoneplate/codec/system/owned.h"

#include <fmt/format.h>
#include <jxl/decode.h>
#include <jxl/encode.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/color/icc.h"
#include "zoneplate/codec/system/boxes.h"
#include "zoneplate/codec/system/in_child.h"

namespace zoneplate {
namespace {

using View = std::span<const std::uint8_t>;

/// The functions of libjxl.
struct JxlLibrary {
  SharedLibrary library;
  decltype(&JxlDecoderCreate) make_decoder = library.find("JxlDecoderCreate");
  decltype(&JxlDecoderDestroy) free_decoder = library.find("JxlDecoderDestroy");
  decltype(&JxlDecoderSubscribeEvents) subscribe = library.find("JxlDecoderSubscribeEvents");
  decltype(&JxlDecoderSetKeepOrientation) keep_orientation = library.find("JxlDecoderSetKeepOrientation");
  decltype(&JxlDecoderSetUnpremultiplyAlpha) unpremultiply = library.find("JxlDecoderSetUnpremultiplyAlpha");
  decltype(&JxlDecoderSetInput) set_input = library.find("JxlDecoderSetInput");
  decltype(&JxlDecoderCloseInput) close_input = library.find("JxlDecoderCloseInput");
  decltype(&JxlDecoderProcessInput) process = library.find("JxlDecoderProcessInput");
  decltype(&JxlDecoderGetBasicInfo) basic_info = library.find("JxlDecoderGetBasicInfo");
  decltype(&JxlDecoderSetPreferredColorProfile) prefer_profile = library.find("JxlDecoderSetPreferredColorProfile");
  decltype(&JxlDecoderGetColorAsEncodedProfile) profile = library.find("JxlDecoderGetColorAsEncodedProfile");
  decltype(&JxlDecoderGetICCProfileSize) icc_size = library.find("JxlDecoderGetICCProfileSize");
  decltype(&JxlDecoderGetColorAsICCProfile) icc = library.find("JxlDecoderGetColorAsICCProfile");
  decltype(&JxlDecoderSetImageOutBuffer) set_output = library.find("JxlDecoderSetImageOutBuffer");
  decltype(&JxlColorEncodingSetToSRGB) set_srgb = library.find("JxlColorEncodingSetToSRGB");
  decltype(&JxlColorEncodingSetToLinearSRGB) set_linear = library.find("JxlColorEncodingSetToLinearSRGB");
  decltype(&JxlEncoderCreate) make_encoder = library.find("JxlEncoderCreate");
  decltype(&JxlEncoderDestroy) free_encoder = library.find("JxlEncoderDestroy");
  decltype(&JxlEncoderInitBasicInfo) init_info = library.find("JxlEncoderInitBasicInfo");
  decltype(&JxlEncoderSetBasicInfo) set_info = library.find("JxlEncoderSetBasicInfo");
  decltype(&JxlEncoderSetColorEncoding) set_color = library.find("JxlEncoderSetColorEncoding");
  decltype(&JxlEncoderFrameSettingsCreate) make_settings = library.find("JxlEncoderFrameSettingsCreate");
  decltype(&JxlEncoderSetFrameLossless) set_lossless = library.find("JxlEncoderSetFrameLossless");
  decltype(&JxlEncoderFrameSettingsSetOption) set_option = library.find("JxlEncoderFrameSettingsSetOption");
  decltype(&JxlEncoderAddImageFrame) add_frame = library.find("JxlEncoderAddImageFrame");
  decltype(&JxlEncoderCloseInput) close_frames = library.find("JxlEncoderCloseInput");
  decltype(&JxlEncoderProcessOutput) process_output = library.find("JxlEncoderProcessOutput");

  explicit JxlLibrary(const std::string& place) : library(Library::Jxl, place) {}
};

class JxlReader {
 public:
  JxlReader(View bytes, const std::string& name, std::uint64_t max_pixels)
      : name_(name),
        max_pixels_(max_pixels),
        library_(name + ": a JPEG XL image"),
        decoder_(owned(library_.make_decoder(nullptr), library_.free_decoder)) {
    check(library_.subscribe(decoder_.get(), JXL_DEC_BASIC_INFO | JXL_DEC_COLOR_ENCODING | JXL_DEC_FULL_IMAGE));
    check(library_.keep_orientation(decoder_.get(), JXL_TRUE));
    check(library_.unpremultiply(decoder_.get(), JXL_TRUE));
    check(library_.set_input(decoder_.get(), bytes.data(), bytes.size()));
    library_.close_input(decoder_.get());
  }

  StoredImage read() {
    StoredImage out;
    for (;;) {
      check_deadline();
      switch (library_.process(decoder_.get())) {
        case JXL_DEC_BASIC_INFO:
          read_info();
          out.orientation = static_cast<int>(info_.orientation);
          break;
        case JXL_DEC_COLOR_ENCODING:
          choose_colors();
          break;
        case JXL_DEC_NEED_IMAGE_OUT_BUFFER:
          if (is_light_)
            out.pixels = buffer<Linear>(JXL_TYPE_FLOAT);
          else if (info_.bits_per_sample > 8)
            out.pixels = buffer<Rgba16>(JXL_TYPE_UINT16);
          else
            out.pixels = buffer<Rgba8>(JXL_TYPE_UINT8);
          std::visit([&](auto& pixels) { set_output(pixels); }, out.pixels);
          break;
        case JXL_DEC_FULL_IMAGE:
          if (is_light_)
            for (Linear& c : std::get<LinearImage>(out.pixels).values()) c = {c.r * c.a, c.g * c.a, c.b * c.a, c.a};
          out.profile = std::move(profile_);
          return out;
        default:
          fail("is corrupt or truncated");
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(ErrorKind::Input, fmt::format("{}: JPEG XL: {}", name_, cause));
  }
  void check(JxlDecoderStatus status) const {
    if (status != JXL_DEC_SUCCESS) fail("is corrupt or truncated");
  }
  void read_info() {
    check(library_.basic_info(decoder_.get(), &info_));
    if (info_.xsize == 0 || info_.ysize == 0 || std::uint64_t{info_.xsize} * info_.ysize > max_pixels_)
      fail(fmt::format("{} x {} pixels, at most {} are allowed", info_.xsize, info_.ysize, max_pixels_));
  }

  /// Floats are light if they are linear; codes of another transfer function are display-referred, whatever their type.
  void choose_colors() {
    const JXL_BOOL is_grey = info_.num_color_channels == 1 ? JXL_TRUE : JXL_FALSE;
    const bool are_floats = info_.exponent_bits_per_sample > 0;
    JxlColorEncoding wanted{}, found{};
    are_floats ? library_.set_linear(&wanted, is_grey) : library_.set_srgb(&wanted, is_grey);
    // This has an effect on XYB alone; codes of other spaces are returned as they are stored.
    static_cast<void>(library_.prefer_profile(decoder_.get(), &wanted));
    const bool is_known =
        library_.profile(decoder_.get(), nullptr, JXL_COLOR_PROFILE_TARGET_DATA, &found) == JXL_DEC_SUCCESS;
    const bool has_primaries = is_grey == JXL_TRUE || found.primaries == JXL_PRIMARIES_SRGB;
    const bool is_rec709 = is_known && found.white_point == JXL_WHITE_POINT_D65 && has_primaries;
    is_light_ = are_floats && (!is_known || found.transfer_function == JXL_TRANSFER_FUNCTION_LINEAR);
    if (is_light_ && !is_rec709) fail("its floats are in another space than linear Rec.709");
    const bool is_srgb = is_rec709 && found.transfer_function == JXL_TRANSFER_FUNCTION_SRGB;
    if (!is_light_ && !is_srgb) read_profile();
  }

  /// The profile of the codes; of an unknown space there is none.
  void read_profile() {
    std::size_t size = 0;
    constexpr auto codes = JXL_COLOR_PROFILE_TARGET_DATA;
    if (library_.icc_size(decoder_.get(), nullptr, codes, &size) != JXL_DEC_SUCCESS) return;
    if (size > max_icc_bytes)
      fail(fmt::format("its ICC profile has {} bytes, at most {} are read", size, max_icc_bytes));
    profile_.resize(size);
    check(library_.icc(decoder_.get(), nullptr, codes, profile_.data(), size));
  }

  template <class Pixel>
  Plane<Pixel> buffer(JxlDataType type) {
    format_ = {4, type, JXL_NATIVE_ENDIAN, 0};
    return Plane<Pixel>(static_cast<int>(info_.xsize), static_cast<int>(info_.ysize));
  }
  template <class Pixel>
  void set_output(Plane<Pixel>& pixels) {
    check(library_.set_output(decoder_.get(), &format_, pixels.values().data(), pixels.values().size_bytes()));
  }

  const std::string& name_;
  const std::uint64_t max_pixels_;
  const JxlLibrary library_;
  const std::unique_ptr<JxlDecoder, decltype(JxlLibrary::free_decoder)> decoder_;
  JxlBasicInfo info_{};
  JxlPixelFormat format_{};
  bool is_light_ = false;
  std::vector<std::uint8_t> profile_;
};

constexpr std::string_view container("\0\0\0\x0cJXL \r\n\x87\n", 12);

/// The first bytes of the codestream; empty without one.
View codestream_of(View bytes) {
  if (bytes[0] == 0xff) return bytes;
  View found;
  for_boxes(bytes, [&](std::string_view name, View box) {
    if (name == "jxlc") found = box;
    if (name == "jxlp" && box.size() > 4) found = box.subspan(4);  // behind the number of the part
    return found.empty();
  });
  return found;
}

/// The bits of the headers of a codestream, from its signature on.
///
/// Source    JPEG XL, ISO/IEC 18181-1, annex D: SizeHeader, ImageMetadata.
class HeaderBits {
 public:
  explicit HeaderBits(View stream) : stream_(stream) {}

  std::optional<int2> read_size() {
    const bool is_small = take(1) == 1;
    const auto side = [&] {
      if (is_small) return 8 * (take(5) + 1);
      constexpr std::array<int, 4> sizes = {9, 13, 18, 30};
      return take(sizes[static_cast<std::size_t>(take(2))]) + 1;
    };
    const std::uint64_t height = side(), ratio = take(3);
    constexpr std::array<std::uint64_t, 8> above = {0, 1, 12, 4, 3, 16, 5, 2}, below = {1, 1, 10, 3, 2, 9, 4, 1};
    const std::uint64_t width = ratio == 0 ? side() : height * above[ratio] / below[ratio];
    if (at_ > 8 * stream_.size() || width == 0 || width > 0x7fffffff) return std::nullopt;
    return int2{static_cast<int>(width), static_cast<int>(height)};
  }

  /// The image's metadata, which follow its size, up to whether it is an animation.
  bool read_is_animated() {
    const bool is_default = take(1) == 1;
    if (is_default || take(1) == 0) return false;      // no further fields
    take(3);                                           // orientation
    if (take(1) == 1) static_cast<void>(read_size());  // as which it is to be displayed
    if (take(1) == 1) read_preview_size();
    return take(1) == 1;
  }

 private:
  void read_preview_size() {
    const bool is_div8 = take(1) == 1;
    const auto side = [&] {
      constexpr std::array<int, 4> sizes = {0, 0, 5, 9}, sizes_of_pixels = {6, 8, 10, 12};
      take((is_div8 ? sizes : sizes_of_pixels)[static_cast<std::size_t>(take(2))]);
    };
    side();
    if (take(3) == 0) side();
  }
  std::uint64_t take(int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i, ++at_)
      if (at_ / 8 < stream_.size()) value |= std::uint64_t{stream_[at_ / 8] >> (at_ % 8) & 1u} << i;
    return value;
  }

  View stream_;
  std::size_t at_ = 16;  // behind the signature
};

}  // namespace

bool is_jxl(View bytes) {
  if (bytes.size() >= 2 && bytes[0] == 0xff && bytes[1] == 0x0a) return true;
  return std::string_view(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), container.size())) ==
         container;
}

std::optional<int2> find_jxl_size(View bytes) {
  return is_jxl(bytes) ? HeaderBits(codestream_of(bytes)).read_size() : std::nullopt;
}

bool is_animated_jxl(View bytes) {
  if (!is_jxl(bytes)) return false;
  HeaderBits header(codestream_of(bytes));
  return header.read_size() && header.read_is_animated();
}

StoredImage decode_jxl(View bytes, const std::string& name, std::uint64_t max_pixels) {
  const std::optional<int2> size = find_jxl_size(bytes);
  if (!size) throw Error(ErrorKind::Input, name + ": JPEG XL: is truncated");
  const std::uint64_t pixels = static_cast<std::uint64_t>(size->x) * static_cast<std::uint64_t>(size->y);
  if (pixels > max_pixels)
    throw Error(ErrorKind::Input,
                fmt::format("{}: JPEG XL: {} x {} pixels, at most {} are allowed", name, size->x, size->y, max_pixels));
  // Floats of each channel, several times in the library, and a fixed overhead.
  const std::uint64_t memory = 200 * pixels + 2 * bytes.size() + (std::uint64_t{128} << 20);
  return decode_in_child(name + ": JPEG XL", Library::Jxl, memory, pixels,
                         [&] { return JxlReader(bytes, name, pixels).read(); });
}

std::vector<std::uint8_t> encode_jxl(const Rgba8Image& image, bool has_alpha) {
  const JxlLibrary library("a JPEG XL image cannot be written");
  const auto check = [&](JxlEncoderStatus status) {
    if (status != JXL_ENC_SUCCESS)
      throw Error(ErrorKind::Failed, fmt::format("an image of {} x {} pixels cannot be encoded as JPEG XL",
                                                 image.width(), image.height()));
  };
  const auto encoder = owned(library.make_encoder(nullptr), library.free_encoder);
  JxlBasicInfo info;
  library.init_info(&info);
  info.xsize = static_cast<std::uint32_t>(image.width()), info.ysize = static_cast<std::uint32_t>(image.height());
  info.bits_per_sample = 8;
  info.uses_original_profile = JXL_TRUE;  // the codes themselves, not XYB
  info.num_extra_channels = has_alpha ? 1 : 0;
  info.alpha_bits = has_alpha ? 8 : 0;
  check(library.set_info(encoder.get(), &info));
  JxlColorEncoding color{};
  library.set_srgb(&color, JXL_FALSE);
  check(library.set_color(encoder.get(), &color));
  JxlEncoderFrameSettings* const settings = library.make_settings(encoder.get(), nullptr);
  constexpr int effort = 4;  // of 1 to 9; the default, 7, takes ten times longer for files a twentieth smaller
  check(library.set_lossless(settings, JXL_TRUE));
  check(library.set_option(settings, JXL_ENC_FRAME_SETTING_EFFORT, effort));
  std::vector<std::uint8_t> codes;
  const std::uint32_t channels = has_alpha ? 4 : 3;
  codes.reserve(image.values().size() * channels);
  for (const Rgba8 c : image.values()) {
    codes.insert(codes.end(), {c.r, c.g, c.b});
    if (has_alpha) codes.push_back(c.a);
  }
  const JxlPixelFormat format{channels, JXL_TYPE_UINT8, JXL_NATIVE_ENDIAN, 0};
  check(library.add_frame(settings, &format, codes.data(), codes.size()));
  library.close_frames(encoder.get());
  std::vector<std::uint8_t> out(std::size_t{1} << 16);
  for (std::size_t written = 0;;) {
    std::uint8_t* next = out.data() + written;
    std::size_t left = out.size() - written;
    const JxlEncoderStatus status = library.process_output(encoder.get(), &next, &left);
    written = out.size() - left;
    if (status == JXL_ENC_NEED_MORE_OUTPUT) {
      out.resize(2 * out.size());
      continue;
    }
    check(status);
    out.resize(written);
    return out;
  }
}

}  // namespace zoneplate
