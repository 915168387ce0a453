// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace zoneplate {

/// A frame of a GIF file: indices of colours, row by row.
struct GifFrameForTest {
  int x = 0, y = 0, width = 0, height = 0;
  std::vector<std::uint8_t> indices = {};
  int delay = 0, disposal = 0, transparent = -1;
  bool is_interlaced = false;
  std::vector<std::uint8_t> colors = {};  ///< three bytes each, a power of two of them; empty: those of the file
};

/// Makes GIF files, with a graphic control extension for each frame.
class GifMaker {
 public:
  using Bytes = std::vector<std::uint8_t>;

  /// `loops` is the number of a NETSCAPE2.0 block; negative: there is none.
  GifMaker(int width, int height, const Bytes& colors, int loops = -1) {
    for (const char c : std::string("GIF89a")) out_.push_back(static_cast<std::uint8_t>(c));
    word(width), word(height);
    out_.insert(out_.end(), {static_cast<std::uint8_t>(colors.empty() ? 0 : 0x80 | size_of(colors)), 0, 0});
    out_.insert(out_.end(), colors.begin(), colors.end());
    if (loops < 0) return;
    out_.insert(out_.end(), {0x21, 0xff, 11});
    for (const char c : std::string("NETSCAPE2.0")) out_.push_back(static_cast<std::uint8_t>(c));
    out_.insert(out_.end(), {3, 1}), word(loops), out_.push_back(0);
  }

  GifMaker& frame(const GifFrameForTest& f, int code_bits = 2) {
    out_.insert(out_.end(), {0x21, 0xf9, 4, static_cast<std::uint8_t>(f.disposal << 2 | (f.transparent >= 0 ? 1 : 0))});
    word(f.delay);
    out_.insert(out_.end(), {static_cast<std::uint8_t>(f.transparent < 0 ? 0 : f.transparent), 0, 0x2c});
    for (const int v : {f.x, f.y, f.width, f.height}) word(v);
    out_.push_back(
        static_cast<std::uint8_t>((f.colors.empty() ? 0 : 0x80 | size_of(f.colors)) | (f.is_interlaced ? 0x40 : 0)));
    out_.insert(out_.end(), f.colors.begin(), f.colors.end());
    out_.push_back(static_cast<std::uint8_t>(code_bits));
    const Bytes packed = lzw(f.indices, code_bits);
    for (std::size_t at = 0; at < packed.size(); at += 255) {
      const std::size_t n = std::min<std::size_t>(255, packed.size() - at);
      out_.push_back(static_cast<std::uint8_t>(n));
      const auto begin = packed.begin() + static_cast<std::ptrdiff_t>(at);
      out_.insert(out_.end(), begin, begin + static_cast<std::ptrdiff_t>(n));
    }
    out_.push_back(0);
    return *this;
  }

  Bytes end() {
    out_.push_back(0x3b);
    return out_;
  }

  /// Source    GIF89a specification, appendix F.
  static Bytes lzw(const Bytes& indices, int code_bits) {
    const std::uint32_t clear = 1u << code_bits, end = clear + 1;
    std::map<std::string, std::uint32_t> codes;
    int size = 0;
    Bytes out;
    std::uint32_t bits = 0;
    int count = 0;
    const auto put = [&](std::uint32_t code) {
      bits |= code << count, count += size;
      for (; count >= 8; count -= 8, bits >>= 8) out.push_back(static_cast<std::uint8_t>(bits));
    };
    const auto reset = [&] {
      codes.clear();
      for (std::uint32_t i = 0; i < clear; ++i) codes[std::string(1, static_cast<char>(i))] = i;
      size = code_bits + 1;
    };
    reset(), put(clear);
    std::uint32_t free = end + 1;
    std::string text;
    for (const std::uint8_t index : indices) {
      const std::string longer = text + static_cast<char>(index);
      if (codes.contains(longer)) {
        text = longer;
        continue;
      }
      put(codes.at(text));
      if (free == 4096) {
        put(clear), reset(), free = end + 1;
      } else {
        if (free == 1u << size) ++size;
        codes[longer] = free++;
      }
      text = std::string(1, static_cast<char>(index));
    }
    if (!text.empty()) put(codes.at(text));
    put(end);
    if (count > 0) out.push_back(static_cast<std::uint8_t>(bits));
    return out;
  }

 private:
  static int size_of(const Bytes& colors) {
    int size = 0;
    while (std::size_t{3} << (size + 1) < colors.size()) ++size;
    return size;
  }
  void word(int value) {
    out_.insert(out_.end(), {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8)});
  }
  Bytes out_;
};

}  // namespace zoneplate
