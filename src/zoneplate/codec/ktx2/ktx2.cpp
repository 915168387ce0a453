// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/ktx2/ktx2.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "zoneplate/codec/ktx2/bc.h"
#include "zoneplate/codec/ktx2/etc1s.h"
#include "zoneplate/codec/ktx2/uastc.h"
#include "zoneplate/os/library.h"

namespace zoneplate {
namespace {

constexpr std::uint8_t identifier[12] = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
constexpr std::size_t header_bytes = 80;  // to the level index
constexpr std::size_t global_header_bytes = 20, image_bytes = 20;
enum Supercompression : std::uint32_t { none = 0, basis_lz = 1, zstandard = 2 };
enum ColorModel : std::uint32_t { etc1s = 163, uastc = 166 };

/// Little-endian numbers of a file.
struct Fields {
  std::span<const std::uint8_t> bytes;
  ktx2::Place place;

  std::uint64_t number(std::uint64_t at, std::uint64_t size) const {
    if (at > bytes.size() || bytes.size() - at < size) place.fail("it ends early");
    std::uint64_t value = 0;
    for (std::uint64_t i = 0; i < size; ++i) value |= std::uint64_t{bytes[static_cast<std::size_t>(at + i)]} << (8 * i);
    return value;
  }
  std::uint32_t word(std::uint64_t at) const { return static_cast<std::uint32_t>(number(at, 4)); }
  std::uint64_t wide(std::uint64_t at) const { return number(at, 8); }
  std::span<const std::uint8_t> part(std::uint64_t at, std::uint64_t size) const {
    if (at > bytes.size() || bytes.size() - at < size) place.fail("a part lies outside of the file");
    return bytes.subspan(static_cast<std::size_t>(at), static_cast<std::size_t>(size));
  }
};

/// What the header and the data format descriptor state.
struct Header {
  std::uint32_t width, height, levels, supercompression, model;
  std::optional<ktx2::BlockFormat> format;  ///< none: Basis Universal
  std::uint64_t globals_at, globals_size;
  std::uint64_t level_at, level_size, level_unpacked;  ///< of level 0
  std::uint64_t blocks() const { return (std::uint64_t{width} + 3) / 4 * ((std::uint64_t{height} + 3) / 4); }
};

Header read_header(const Fields& f) {
  Header h{};
  const std::uint32_t format = f.word(12), depth = f.word(28), layers = f.word(32), faces = f.word(36);
  h.width = f.word(20), h.height = f.word(24), h.levels = std::max(f.word(40), 1u), h.supercompression = f.word(44);
  const std::uint32_t descriptor_at = f.word(48), descriptor_size = f.word(52);
  h.globals_at = f.wide(64), h.globals_size = f.wide(72);
  if (h.width == 0 || h.height == 0) f.place.fail("it has no size");
  if (depth != 0 || layers > 1 || faces != 1) f.place.fail("it is a volume, an array or a cube, expected one image");
  if (h.levels > 32) f.place.fail(fmt::format("it has {} levels", h.levels));
  if (descriptor_size < 44) f.place.fail("its data format descriptor is too short");
  f.part(descriptor_at, descriptor_size);
  h.model = static_cast<std::uint32_t>(f.number(std::uint64_t{descriptor_at} + 12, 1));
  h.format = ktx2::block_format_of(format);
  const bool has_blocks = h.supercompression == none || h.supercompression == zstandard;
  const bool is_basis =
      format == 0 && ((h.model == etc1s && h.supercompression == basis_lz) || (h.model == uastc && has_blocks));
  if (!is_basis && !(h.format && has_blocks))
    throw Error(ErrorKind::Input,
                fmt::format("{}: is a KTX2 image of format {}, model {} and supercompression {}, expected Basis "
                            "Universal (ETC1S or UASTC), or BC1 to BC5 or BC7 of unsigned values",
                            f.place.name, format, h.model, h.supercompression));
  h.level_at = f.wide(header_bytes), h.level_size = f.wide(header_bytes + 8);
  h.level_unpacked = f.wide(header_bytes + 16);
  return h;
}

void decode_basis_lz(const Fields& f, const Header& h, Rgba8Image& image) {
  const Fields g{f.part(h.globals_at, h.globals_size), f.place};
  const std::uint64_t endpoints = g.word(4), selectors = g.word(8), tables = g.word(12);
  const std::uint64_t at = global_header_bytes + std::uint64_t{h.levels} * image_bytes;
  const ktx2::BasisGlobals globals = ktx2::read_basis_globals(
      {static_cast<std::uint32_t>(g.number(0, 2)), static_cast<std::uint32_t>(g.number(2, 2)), g.part(at, endpoints),
       g.part(at + endpoints, selectors), g.part(at + endpoints + selectors, tables)},
      f.place);
  // The first description is that of level 0.
  const Fields level{f.part(h.level_at, h.level_size), f.place};
  const auto slice = [&](std::uint64_t from) { return level.part(g.word(from), g.word(from + 4)); };
  if ((g.word(global_header_bytes) & 2) != 0) f.place.fail("it is a frame of a video");
  ktx2::decode_etc1s(globals, slice(global_header_bytes + 4), false, f.place, image);
  if (g.word(global_header_bytes + 16) > 0)
    ktx2::decode_etc1s(globals, slice(global_header_bytes + 12), true, f.place, image);
}

std::vector<std::uint8_t> unpacked(std::span<const std::uint8_t> packed, std::uint64_t size, const ktx2::Place& place) {
  decltype(&ZSTD_decompress) decompress = nullptr;
  decltype(&ZSTD_isError) is_error = nullptr;
  const SharedLibrary library(Library::Zstd, place.name);
  library.find(decompress, "ZSTD_decompress"), library.find(is_error, "ZSTD_isError");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  const std::size_t count = decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
  if (is_error(count) != 0 || count != bytes.size()) place.fail("its Zstandard data are damaged");
  return bytes;
}

void decode_block_level(const Fields& f, const Header& h, Rgba8Image& image) {
  const std::uint64_t size = h.blocks() * (h.format ? ktx2::block_bytes(*h.format) : ktx2::uastc_block_bytes);
  const auto decode = [&](std::span<const std::uint8_t> blocks) {
    if (h.format) return ktx2::decode_blocks(*h.format, blocks, f.place, image);
    ktx2::decode_uastc(blocks, f.place, image);
  };
  const std::span<const std::uint8_t> level = f.part(h.level_at, h.level_size);
  if (h.supercompression == zstandard) {
    if (h.level_unpacked != size) f.place.fail("level 0 has not the size of its blocks");
    return decode(unpacked(level, size, f.place));
  }
  if (level.size() != size) f.place.fail("level 0 has not the size of its blocks");
  decode(level);
}

}  // namespace

bool is_ktx2(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= std::size(identifier) &&
         std::equal(std::begin(identifier), std::end(identifier), bytes.begin());
}

std::optional<int2> find_ktx2_size(std::span<const std::uint8_t> bytes) {
  if (!is_ktx2(bytes) || bytes.size() < header_bytes) return std::nullopt;
  const std::string name;
  const Fields f{bytes, {name}};
  const auto side = [&](std::uint64_t at) {
    return static_cast<int>(std::min(f.word(at), static_cast<std::uint32_t>(std::numeric_limits<int>::max())));
  };
  return int2{side(20), side(24)};
}

std::uint64_t ktx2_working_memory(std::span<const std::uint8_t> bytes) {
  const std::optional<int2> size = find_ktx2_size(bytes);
  if (!size) return 0;
  // The unpacked blocks, a byte a texel, and code books of at most 2^16 entries each, with their Huffman codes.
  constexpr std::uint64_t books = std::uint64_t{1} << 20;
  return (static_cast<std::uint64_t>(size->x) + 3) * (static_cast<std::uint64_t>(size->y) + 3) + books;
}

Rgba8Image decode_ktx2(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  const Fields f{bytes, {name}};
  const Header h = read_header(f);
  constexpr std::uint32_t most = std::numeric_limits<int>::max() / 4;
  if (h.width > most || h.height > most || std::uint64_t{h.width} * h.height > max_pixels)
    throw Error(ErrorKind::Input, fmt::format("{}: has {} x {} pixels, more than the limit of {} (--max-pixels)", name,
                                              h.width, h.height, max_pixels));
  Rgba8Image image(static_cast<int>(h.width), static_cast<int>(h.height));
  if (h.supercompression == basis_lz)
    decode_basis_lz(f, h, image);
  else
    decode_block_level(f, h, image);
  return image;
}

}  // namespace zoneplate
