// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/animated/apng_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/animated/canvas.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/png/png_chunk.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

constexpr std::uint8_t signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t header_bytes = 13, control_bytes = 26, sequence_bytes = 4;

std::uint16_t half_word(View bytes) { return static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]); }

struct Frame {
  CanvasPart part;
  FrameTime time;
  Disposal disposal = Disposal::Keep;
  bool is_blended = false;
  std::vector<View> data;  ///< of its IDAT or fdAT chunks, without the sequence numbers
};

/// The chunks of an animated PNG.
class Chunks {
 public:
  Chunks(View bytes, const std::string& name, std::uint64_t max_pixels) : name_(name), max_pixels_(max_pixels) {
    bool is_complete = false;
    for_png_chunks(bytes, [&](std::string_view chunk, View data) {
      check_deadline();
      if (get_png_word({data.data() + data.size(), 4}) != checksum(chunk, data)) fail("a checksum is wrong");
      add(chunk, data);
      is_complete = chunk == "IEND";
      return !is_complete;
    });
    if (!is_complete) fail("is truncated");
    if (frames_.empty()) fail("has no frames");
    for (const Frame& frame : frames_)
      if (frame.data.empty()) fail("a frame has no data");
    if (frames_.size() != stated_frames_)
      fail(fmt::format("has {} frames, and states {}", frames_.size(), stated_frames_));
  }

  int2 size() const { return size_; }
  int loops() const { return loops_; }
  const std::vector<Frame>& frames() const { return frames_; }
  bool has_16_bits() const { return header_[8] == 16; }
  bool has_alpha() const {
    constexpr std::uint8_t alpha = 4;  // of the colour types
    // A first frame that is a part of the canvas leaves the rest transparent.
    const bool covers_all = frames_[0].part.width == size_.x && frames_[0].part.height == size_.y;
    return (header_[9] & alpha) != 0 || transparency_.data() != nullptr || !covers_all ||
           std::ranges::any_of(frames_, [](const Frame& f) { return f.disposal == Disposal::Clear; });
  }

  /// A frame as a PNG file of its own, with the palette and the transparent colour of the whole.
  Bytes png_of(const Frame& frame) const {
    Bytes out(std::begin(signature), std::end(signature)), header;
    put_png_word(header, static_cast<std::uint32_t>(frame.part.width));
    put_png_word(header, static_cast<std::uint32_t>(frame.part.height));
    header.insert(header.end(), header_.begin() + 8, header_.end());
    put_png_chunk(out, "IHDR", header);
    if (palette_.data() != nullptr) put_png_chunk(out, "PLTE", palette_);
    if (transparency_.data() != nullptr) put_png_chunk(out, "tRNS", transparency_);
    for (const View data : frame.data) put_png_chunk(out, "IDAT", data);
    put_png_chunk(out, "IEND", {});
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const { throw Error(ErrorKind::Input, name_ + ": APNG: " + cause); }

  static std::uint32_t checksum(std::string_view name, View data) {
    return png_checksum(png_checksum(0, {reinterpret_cast<const std::uint8_t*>(name.data()), name.size()}), data);
  }

  void add(std::string_view chunk, View data) {
    if (header_.empty() != (chunk == "IHDR")) fail("its header is not the first chunk");
    if (chunk == "IHDR") read_header(data);
    if (chunk == "PLTE") palette_ = data;
    if (chunk == "tRNS") transparency_ = data;
    if (chunk == "acTL") {
      if (data.size() != 8) fail("the chunk acTL has another size");
      stated_frames_ = get_png_word(data);
      loops_ = static_cast<int>(std::min(get_png_word(data.subspan(4)), std::uint32_t{65535}));
    }
    if (chunk == "fcTL") read_control(data);
    if (chunk == "IDAT") {
      is_in_data_ = true;
      if (!frames_.empty()) frames_.front().data.push_back(data);
    }
    if (chunk == "fdAT") {
      if (data.size() < sequence_bytes || frames_.empty() || !is_in_data_) fail("the chunk fdAT has no frame");
      check_sequence(data);
      frames_.back().data.push_back(data.subspan(sequence_bytes));
    }
  }

  void read_header(View data) {
    if (data.size() != header_bytes) fail("its header has another size");
    header_ = data;
    const std::uint64_t width = get_png_word(data), height = get_png_word(data.subspan(4));
    if (width == 0 || height == 0 || width > 0x7fffffff || height > 0x7fffffff) fail("it has no size");
    if (width * height > max_pixels_)
      fail(fmt::format("{} x {} pixels, at most {} are allowed", width, height, max_pixels_));
    size_ = {static_cast<int>(width), static_cast<int>(height)};
  }

  void read_control(View data) {
    if (data.size() != control_bytes) fail("the chunk fcTL has another size");
    check_sequence(data);
    const std::uint64_t width = get_png_word(data.subspan(4)), height = get_png_word(data.subspan(8)),
                        x = get_png_word(data.subspan(12)), y = get_png_word(data.subspan(16));
    const auto whole_width = static_cast<std::uint64_t>(size_.x), whole_height = static_cast<std::uint64_t>(size_.y);
    if (width == 0 || height == 0 || x + width > whole_width || y + height > whole_height)
      fail("a frame lies outside of the image");
    if (!is_in_data_ && (!frames_.empty() || width != whole_width || height != whole_height))
      fail("its first frame is not the whole image");
    constexpr std::uint16_t hundredths = 100;
    Frame frame;
    frame.part = {static_cast<int>(x), static_cast<int>(y), static_cast<int>(width), static_cast<int>(height)};
    frame.time = {half_word(data.subspan(20)), half_word(data.subspan(22))};
    if (frame.time.per == 0) frame.time.per = hundredths;
    if (data[24] > 2 || data[25] > 1) fail("a frame is disposed of or blended in an unknown way");
    frame.disposal = data[24] == 0                      ? Disposal::Keep
                     : data[24] == 1 || frames_.empty() ? Disposal::Clear
                                                        : Disposal::Restore;
    frame.is_blended = data[25] == 1;
    frames_.push_back(std::move(frame));
  }

  void check_sequence(View data) {
    if (get_png_word(data) != sequence_++) fail("its frames are not in order");
  }

  std::string name_;
  const std::uint64_t max_pixels_;
  int2 size_;
  View header_, palette_, transparency_;
  std::uint32_t stated_frames_ = 0, sequence_ = 0;
  int loops_ = 0;
  bool is_in_data_ = false;
  std::vector<Frame> frames_;
};

/// Source over destination, with straight alpha.
template <class Pixel>
Pixel over(const Pixel& top, const Pixel& below) {
  using Code = decltype(Pixel::a);
  constexpr std::uint64_t most = std::numeric_limits<Code>::max();
  if (top.a == 0) return below;
  if (top.a == most || below.a == 0) return top;
  // Weights in 1 / most²; their sum is the alpha of the result.
  const std::uint64_t a = top.a * most, b = below.a * (most - top.a), sum = a + b;
  const auto mix = [&](Code u, Code v) { return static_cast<Code>((u * a + v * b + sum / 2) / sum); };
  return {mix(top.r, below.r), mix(top.g, below.g), mix(top.b, below.b), static_cast<Code>((sum + most / 2) / most)};
}

template <class Pixel>
class ApngReader final : public AnimationReader {
 public:
  ApngReader(Chunks chunks, const std::string& name)
      : name_(name),
        chunks_(std::move(chunks)),
        info_{chunks_.size(), chunks_.frames().size(), chunks_.loops(), chunks_.has_alpha()},
        canvas_(chunks_.size()) {}

  const AnimationInfo& info() const override { return info_; }

  AnimationFrame next() override {
    check_deadline();
    const Frame& frame = chunks_.frames()[done_++];
    const CanvasPart& part = frame.part;
    const PngImage png =
        decode_png_as_stored(chunks_.png_of(frame), fmt::format("{}, frame {}", name_, done_),
                             static_cast<std::uint64_t>(part.width) * static_cast<std::uint64_t>(part.height));
    canvas_.begin(part, frame.disposal);
    for (int y = 0; y < part.height; ++y)
      for (int x = 0; x < part.width; ++x) {
        const Pixel& drawn = pixels_of(png)(x, y);
        Pixel& out = canvas_.at(x, y);
        out = frame.is_blended ? over(drawn, out) : drawn;
      }
    return {canvas_.image(), frame.time};
  }

 private:
  static const Plane<Pixel>& pixels_of(const PngImage& png) {
    if constexpr (std::is_same_v<Pixel, Rgba16>)
      return png.pixels16;
    else
      return png.pixels;
  }

  const std::string name_;
  const Chunks chunks_;
  const AnimationInfo info_;
  FrameCanvas<Pixel> canvas_;
  std::size_t done_ = 0;
};

}  // namespace

std::size_t count_apng_frames(View bytes) {
  std::size_t frames = 0;
  if (is_png(bytes))
    for_png_chunks(bytes, [&](std::string_view name, View data) {
      if (name == "acTL" && data.size() >= 4) frames = get_png_word(data);
      return name != "IDAT";
    });
  return frames;
}

std::unique_ptr<AnimationReader> open_apng(View bytes, const std::string& name, std::uint64_t max_pixels) {
  Chunks chunks(bytes, name, max_pixels);
  if (chunks.has_16_bits()) return std::make_unique<ApngReader<Rgba16>>(std::move(chunks), name);
  return std::make_unique<ApngReader<Rgba8>>(std::move(chunks), name);
}

}  // namespace zoneplate
