// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/animated/gif.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/animated/canvas.h"
#include "zoneplate/codec/bitmap/bytes.h"

namespace zoneplate {
namespace {

using View = std::span<const std::uint8_t>;

constexpr std::size_t header_bytes = 13, descriptor_bytes = 10;
constexpr int max_code_bits = 12;

struct Frame {
  CanvasPart part;  ///< as stored
  FrameTime time{0, 100};
  Disposal disposal = Disposal::Keep;
  bool is_interlaced = false;
  std::optional<std::uint8_t> transparent;  ///< an index that is not drawn
  View colors;                              ///< three bytes each
  int code_bits = 0;
  std::size_t data_at = 0;  ///< the first data block
};

/// The blocks of a GIF file.
struct Blocks {
  int2 screen;
  int loops = 1;
  std::vector<Frame> frames;
  std::string flaw;  ///< why the walk ended before the trailer
};

/// Walks the blocks from the first byte after the header to the trailer, the end of the file, or the first block that
/// is not a block of GIF.
class BlockWalk {
 public:
  explicit BlockWalk(View bytes) : bytes_(bytes) {}

  Blocks walk(std::size_t max_frames) {
    if (bytes_.size() < header_bytes) return cut_off();
    out_.screen = {number(6), number(8)};
    at_ = header_bytes;
    const View colors = color_table(bytes_[10]);
    if (is_cut_off_) return cut_off();
    Frame next;
    while (at_ < bytes_.size() && out_.frames.size() < max_frames) {
      check_deadline();
      constexpr std::uint8_t extension = 0x21, image = 0x2c, trailer = 0x3b;
      const std::uint8_t kind = bytes_[at_];
      if (kind == trailer) break;
      if (kind == extension) {
        read_extension(next);
      } else if (kind == image) {
        read_image(next, colors);
        next = {};
      } else {
        out_.flaw = "an unknown block follows";
        break;
      }
      if (is_cut_off_) return cut_off();
    }
    if (out_.frames.empty() && out_.flaw.empty()) out_.flaw = "it has no image";
    if (!out_.frames.empty() && (out_.screen.x == 0 || out_.screen.y == 0)) {
      const CanvasPart& first = out_.frames[0].part;
      out_.screen = {first.x + first.width, first.y + first.height};
    }
    return std::move(out_);
  }

 private:
  Blocks cut_off() {
    out_.flaw = "is truncated";
    return std::move(out_);
  }

  int number(std::size_t at) const { return static_cast<int>(little_endian(bytes_, at, 2)); }

  View take(std::size_t size) {
    if (bytes_.size() - at_ < size) {
      is_cut_off_ = true;
      return {};
    }
    return bytes_.subspan(std::exchange(at_, at_ + size), size);
  }

  View color_table(std::uint8_t flags) {
    constexpr std::uint8_t has_table = 0x80;
    return (flags & has_table) == 0 ? View{} : take(std::size_t{3} << ((flags & 7) + 1));
  }

  /// The contents of the next data block; empty at the end of the blocks, or if it is cut off.
  View data_block() {
    const View size = take(1);
    return size.empty() || size[0] == 0 ? View{} : take(size[0]);
  }

  void read_extension(Frame& next) {
    const View start = take(2);
    if (is_cut_off_) return;
    constexpr std::uint8_t graphic_control = 0xf9, application = 0xff;
    bool is_first = true, is_netscape = false;
    for (View block = data_block(); !block.empty(); block = data_block(), is_first = false) {
      if (start[1] == graphic_control && is_first && block.size() >= 4) read_control(block, next);
      const std::string_view text(reinterpret_cast<const char*>(block.data()), block.size());
      if (start[1] == application && is_first) is_netscape = text == "NETSCAPE2.0" || text == "ANIMEXTS1.0";
      if (is_netscape && !is_first && block.size() >= 3 && block[0] == 1) {
        const int repeats = static_cast<int>(little_endian(block, 1, 2));
        out_.loops = repeats == 0 ? 0 : std::min(repeats + 1, 65535);
      }
    }
  }

  static void read_control(View block, Frame& next) {
    const int disposal = block[0] >> 2 & 7;
    next.disposal = disposal == 2 ? Disposal::Clear : disposal == 3 ? Disposal::Restore : Disposal::Keep;
    next.time.seconds = static_cast<int>(little_endian(block, 1, 2));
    if ((block[0] & 1) != 0) next.transparent = block[3];
  }

  void read_image(Frame frame, View colors) {
    const std::size_t begin = at_;
    const View descriptor = take(descriptor_bytes);
    if (is_cut_off_) return;
    frame.part = {number(begin + 1), number(begin + 3), number(begin + 5), number(begin + 7)};
    frame.is_interlaced = (descriptor[9] & 0x40) != 0;
    const View own = color_table(descriptor[9]);
    frame.colors = own.empty() ? colors : own;
    const View bits = take(1);
    if (is_cut_off_) return;
    frame.code_bits = bits[0];
    frame.data_at = at_;
    while (!data_block().empty()) {
    }
    out_.frames.push_back(std::move(frame));
  }

  const View bytes_;
  std::size_t at_ = 0;
  bool is_cut_off_ = false;
  Blocks out_;
};

/// The codes of a frame, of a growing number of bits, from its data blocks.
class Codes {
 public:
  Codes(View bytes, std::size_t at) : bytes_(bytes), at_(at) {}

  /// Nothing at the end of the data.
  std::optional<std::uint32_t> next(int size) {
    while (count_ < size) {
      if (left_ == 0) {
        if (at_ >= bytes_.size() || bytes_[at_] == 0) return std::nullopt;
        left_ = bytes_[at_++];
      }
      if (at_ >= bytes_.size()) return std::nullopt;
      bits_ |= std::uint32_t{bytes_[at_++]} << count_;
      count_ += 8, --left_;
    }
    const std::uint32_t code = bits_ & ((1u << size) - 1);
    bits_ >>= size, count_ -= size;
    return code;
  }

 private:
  View bytes_;
  std::size_t at_;
  int left_ = 0, count_ = 0;
  std::uint32_t bits_ = 0;
};

class GifReader final : public AnimationReader {
 public:
  GifReader(View bytes, const std::string& name, std::uint64_t max_pixels, Blocks blocks)
      : bytes_(bytes),
        name_(name),
        blocks_(std::move(blocks)),
        info_{checked_size(max_pixels), blocks_.frames.size(), blocks_.loops, has_alpha()},
        canvas_(info_.size) {}

  const AnimationInfo& info() const override { return info_; }

  AnimationFrame next() override {
    check_deadline();
    const Frame& frame = blocks_.frames[done_++];
    if (frame.colors.empty()) fail("has no colours");
    if (frame.code_bits < 1 || frame.code_bits > 8) fail("has codes of an invalid size");
    const CanvasPart& p = frame.part;
    const int left = std::min(p.x, info_.size.x), top = std::min(p.y, info_.size.y);
    drawn_ = {left, top, std::min(p.width, info_.size.x - left), std::min(p.height, info_.size.y - top)};
    canvas_.begin(drawn_, frame.disposal);
    x_ = 0, row_ = 0;
    decode(frame);
    return {canvas_.image(), frame.time};
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(ErrorKind::Input, fmt::format("{}: GIF: frame {} {}", name_, done_, cause));
  }

  /// The size of the screen, after that of each frame has been checked too.
  int2 checked_size(std::uint64_t max_pixels) const {
    const auto check = [&](int width, int height) {
      if (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > max_pixels)
        throw Error(ErrorKind::Input,
                    fmt::format("{}: GIF: {} x {} pixels, at most {} are allowed", name_, width, height, max_pixels));
    };
    check(blocks_.screen.x, blocks_.screen.y);
    for (const Frame& frame : blocks_.frames) check(frame.part.width, frame.part.height);
    if (blocks_.screen.x == 0 || blocks_.screen.y == 0)
      throw Error(ErrorKind::Input, name_ + ": GIF: it has no pixels");
    return blocks_.screen;
  }

  bool has_alpha() const {
    const CanvasPart& first = blocks_.frames[0].part;
    const bool covers_all =
        first.x == 0 && first.y == 0 && first.width >= blocks_.screen.x && first.height >= blocks_.screen.y;
    return !covers_all || std::ranges::any_of(blocks_.frames, [](const Frame& f) {
      return f.transparent || f.disposal != Disposal::Keep;
    });
  }

  /// LZW: each code is a string of indices, and each but the first adds the string before it with one more index.
  void decode(const Frame& frame) {
    const auto clear = 1u << frame.code_bits, end = clear + 1;
    const std::uint64_t pixels =
        static_cast<std::uint64_t>(frame.part.width) * static_cast<std::uint64_t>(frame.part.height);
    Codes codes(bytes_, frame.data_at);
    std::uint32_t free = end + 1;  // the code that is added next
    int size = frame.code_bits + 1;
    constexpr std::uint32_t none = 1u << max_code_bits;
    std::uint32_t last = none;
    for (std::uint64_t done = 0; done < pixels;) {
      const std::optional<std::uint32_t> found = codes.next(size);
      if (!found || *found == end) fail("is truncated");
      const std::uint32_t code = *found;
      if (code == clear) {
        free = end + 1, size = frame.code_bits + 1, last = none;
        continue;
      }
      if (code > free || (code > end && last == none)) fail("is corrupt");
      // The string of the code, from its last index to its first; a code that is being added is the last string with
      // its own first index behind.
      std::size_t length = 0;
      std::uint32_t at = code;
      if (code == free) ++length, at = last;
      for (; at > end; at = prefixes_[at]) string_[length++] = suffixes_[at];
      if (at >= clear) fail("is corrupt");
      const auto first = static_cast<std::uint8_t>(at);
      string_[length++] = first;
      if (code == free) string_[0] = first;
      if (last != none && free < (1u << max_code_bits)) {
        prefixes_[free] = static_cast<std::uint16_t>(last), suffixes_[free] = first;
        if (++free == 1u << size && size < max_code_bits) ++size;
      }
      last = code;
      while (length > 0 && done < pixels) put(frame, string_[--length]), ++done;
    }
  }

  void put(const Frame& frame, std::uint8_t index) {
    if (row_ < drawn_rows(frame) && x_ < drawn_.width && index != frame.transparent) {
      const std::size_t color = std::size_t{3} * index;
      if (color + 3 > frame.colors.size())
        fail(fmt::format("names colour {} of a table of {}", index, frame.colors.size() / 3));
      const int y = frame.is_interlaced ? interlaced_row(row_, frame.part.height) : row_;
      if (y < drawn_.height)
        canvas_.at(x_, y) = {frame.colors[color], frame.colors[color + 1], frame.colors[color + 2], 255};
    }
    if (++x_ == frame.part.width) {
      x_ = 0, ++row_;
      check_deadline();
    }
  }

  int drawn_rows(const Frame& frame) const { return frame.is_interlaced ? frame.part.height : drawn_.height; }

  /// Of the stored row `i`: every eighth row, every eighth from 4, every fourth from 2, every second from 1.
  static int interlaced_row(int i, int height) {
    constexpr std::array<int, 4> starts = {0, 4, 2, 1}, steps = {8, 8, 4, 2};
    for (std::size_t pass = 0; pass < 4; ++pass) {
      const int rows = (height - starts[pass] + steps[pass] - 1) / steps[pass];
      if (i < rows) return starts[pass] + i * steps[pass];
      i -= std::max(rows, 0);
    }
    return height;
  }

  const View bytes_;
  const std::string name_;
  const Blocks blocks_;
  const AnimationInfo info_;
  FrameCanvas<Rgba8> canvas_;
  CanvasPart drawn_;  ///< the part of the frame that lies on the screen
  int x_ = 0, row_ = 0;
  std::size_t done_ = 0;
  std::array<std::uint16_t, 1 << max_code_bits> prefixes_{};
  std::array<std::uint8_t, 1 << max_code_bits> suffixes_{};
  std::array<std::uint8_t, (1 << max_code_bits) + 1> string_{};
};

constexpr std::size_t all = ~std::size_t{0};

std::unique_ptr<AnimationReader> open_frames(View bytes, const std::string& name, std::uint64_t max_pixels,
                                             std::size_t max_frames) {
  if (!is_gif(bytes)) throw Error(ErrorKind::Input, name + ": not a GIF file");
  Blocks blocks = BlockWalk(bytes).walk(max_frames);
  if (!blocks.flaw.empty()) throw Error(ErrorKind::Input, name + ": GIF: " + blocks.flaw);
  return std::make_unique<GifReader>(bytes, name, max_pixels, std::move(blocks));
}

}  // namespace

bool is_gif(View bytes) {
  const std::string_view start(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 6));
  return start == "GIF87a" || start == "GIF89a";
}

std::optional<int2> find_gif_size(View bytes) {
  if (!is_gif(bytes)) return std::nullopt;
  const Blocks blocks = BlockWalk(bytes).walk(1);
  if (blocks.frames.empty() || blocks.screen.x == 0 || blocks.screen.y == 0) return std::nullopt;
  return blocks.screen;
}

std::size_t count_gif_frames(View bytes) { return is_gif(bytes) ? BlockWalk(bytes).walk(all).frames.size() : 0; }

std::unique_ptr<AnimationReader> open_gif(View bytes, const std::string& name, std::uint64_t max_pixels) {
  return open_frames(bytes, name, max_pixels, all);
}

Rgba8Image decode_gif(View bytes, const std::string& name, std::uint64_t max_pixels) {
  return open_frames(bytes, name, max_pixels, 1)->next().image.as<Rgba8>();
}

}  // namespace zoneplate
