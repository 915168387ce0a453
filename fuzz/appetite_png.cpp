// SPDX-License-Identifier: Apache-2.0
// PNG images of many pixels in few bytes.
#include <zlib.h>

#include <array>

#include "appetite.h"

namespace zoneplate::appetite {
namespace {

void append_u32(Bytes& out, std::uint64_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(v >> shift));
}

void append_chunk(Bytes& out, std::string_view type, const Bytes& data) {
  append_u32(out, data.size());
  const std::size_t checked = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  append_u32(out, ::crc32_z(0, out.data() + checked, out.size() - checked));
}

/// A part of a DEFLATE stream that holds so many zeros, needs nothing before it and ends at a byte's boundary.
Bytes deflated_zeros(std::size_t count, bool is_last) {
  const Bytes zeros(count);
  z_stream stream{};
  ::deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
  Bytes out(::deflateBound(&stream, count) + 16);
  stream.next_in = const_cast<Bytef*>(zeros.data());
  stream.avail_in = static_cast<uInt>(count);
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  ::deflate(&stream, is_last ? Z_FINISH : Z_FULL_FLUSH);
  out.resize(stream.total_out);
  ::deflateEnd(&stream);
  return out;
}

/// A zlib stream of `count` zeros: a part of 1 MiB again and again.
Bytes zlib_zeros(std::uint64_t count) {
  constexpr std::uint64_t part = 1 << 20;
  Bytes out{0x78, 0xda};
  const Bytes repeated = deflated_zeros(part, false);
  for (std::uint64_t i = 0; i < count / part; ++i) out.insert(out.end(), repeated.begin(), repeated.end());
  const Bytes rest = deflated_zeros(static_cast<std::size_t>(count % part), true);
  out.insert(out.end(), rest.begin(), rest.end());
  append_u32(out, (count % 65521) << 16 | 1);  // Adler's sums: of zeros the first stays 1, the second counts
  return out;
}

enum class Color : std::uint8_t { Grey = 0, Rgb = 2, Palette = 3, Rgba = 6 };

struct Header {
  std::uint32_t width, height;
  std::uint8_t bits;
  Color color;
  bool is_interlaced = false;
};

/// The bytes of the rows, each with that of its filter.
std::uint64_t raw_size(const Header& h) {
  const std::uint64_t channels = h.color == Color::Rgba ? 4 : h.color == Color::Rgb ? 3 : 1;
  const auto rows = [&](std::uint64_t width, std::uint64_t height) {
    return width == 0 ? 0 : height * (1 + (width * channels * h.bits + 7) / 8);
  };
  if (!h.is_interlaced) return rows(h.width, h.height);
  static constexpr std::array<std::array<unsigned, 4>, 7> passes = {
      {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4}, {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}};
  std::uint64_t all = 0;
  for (const auto& [x, y, dx, dy] : passes) all += rows((h.width + dx - 1 - x) / dx, (h.height + dy - 1 - y) / dy);
  return all;
}

Bytes begin_png(const Header& h) {
  Bytes out{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, header;
  append_u32(header, h.width), append_u32(header, h.height);
  header.insert(header.end(), {h.bits, static_cast<std::uint8_t>(h.color), 0, 0, h.is_interlaced});
  append_chunk(out, "IHDR", header);
  if (h.color == Color::Palette) append_chunk(out, "PLTE", {10, 20, 30, 200, 100, 50});
  if (h.color == Color::Palette) append_chunk(out, "tRNS", {128, 255});
  return out;
}

Bytes zero_png(const Header& h) {
  Bytes out = begin_png(h);
  append_chunk(out, "IDAT", zlib_zeros(raw_size(h)));
  append_chunk(out, "IEND", {});
  return out;
}

/// A small image with chunks before its rows.
Bytes png_with(std::string_view type, const Bytes& data, int count) {
  const Header small{8, 8, 8, Color::Rgb};
  Bytes out = begin_png(small);
  for (int i = 0; i < count; ++i) append_chunk(out, type, data);
  append_chunk(out, "IDAT", zlib_zeros(raw_size(small)));
  append_chunk(out, "IEND", {});
  return out;
}

Bytes named(std::string_view name, const Bytes& packed) {
  Bytes out(name.begin(), name.end());
  out.insert(out.end(), {0, 0});  // the end of the name, and the method of compression
  out.insert(out.end(), packed.begin(), packed.end());
  return out;
}

}  // namespace

void add_png(Collection& out) {
  const auto add = [&](const char* kind, const std::string& name, const Bytes& bytes) {
    out.add_picture(kind, name, ".png", bytes, within_limits);
  };
  Bytes claim = begin_png({0x7fffffff, 0x7fffffff, 8, Color::Rgba});
  append_chunk(claim, "IDAT", zlib_zeros(100));
  add("png-claims", "png-claim", claim);
  add("png-claims", "png-wide", zero_png({1 << 28, 1, 8, Color::Grey}));
  add("png-claims", "png-high", zero_png({1, 1 << 27, 8, Color::Grey}));
  add("png-zeros", "png-rgba-16000", zero_png({16000, 16000, 8, Color::Rgba}));
  add("png-zeros", "png-rgb-8000", zero_png({8000, 8000, 8, Color::Rgb}));
  add("png-zeros", "png-grey-16000", zero_png({16000, 16000, 1, Color::Grey}));
  add("png-palette", "png-palette-16000", zero_png({16000, 16000, 1, Color::Palette}));
  add("png-palette", "png-palette-6000", zero_png({6000, 6000, 8, Color::Palette}));
  add("png-interlace", "png-interlaced-16000", zero_png({16000, 16000, 1, Color::Palette, true}));
  add("png-interlace", "png-interlaced-5000", zero_png({5000, 5000, 8, Color::Rgba, true}));
  add("png-deep", "png-16-bit-10000", zero_png({10000, 10000, 16, Color::Rgba}));
  add("png-deep", "png-16-bit-4000", zero_png({4000, 4000, 16, Color::Rgb, true}));
  add("png-chunks", "png-chunks", png_with("zzZz", {}, 400000));
  add("png-chunks", "png-texts", png_with("zTXt", named("Comment", zlib_zeros(200 << 20)), 20));
  add("png-chunks", "png-profile", png_with("iCCP", named("profile", zlib_zeros(500 << 20)), 1));
}

}  // namespace zoneplate::appetite
