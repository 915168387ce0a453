// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/ktx2/ktx2.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "zoneplate/codec/ktx2/bc.h"
#include "zoneplate/codec/ktx2/bc6h.h"
#include "zoneplate/codec/ktx2/etc1s.h"
#include "zoneplate/codec/ktx2/uastc.h"
#include "zoneplate/codec/ktx2/uncompressed.h"
#include "zoneplate/os/library.h"

namespace zoneplate {
namespace {

constexpr std::uint8_t identifier[12] = {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
constexpr std::size_t header_bytes = 80;  // to the level index
constexpr std::size_t global_header_bytes = 20, image_bytes = 20;
enum Supercompression : std::uint32_t { none = 0, basis_lz = 1, zstandard = 2 };
enum ColorModel : std::uint32_t { etc1s = 163, uastc = 166 };
constexpr std::uint32_t bc6h_unsigned = 143, bc6h_signed = 144;  // numbers of Vulkan's formats

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
  std::uint32_t width, height, levels, supercompression, format, model;
  std::optional<ktx2::BlockFormat> blocks_of_codes;
  std::optional<ktx2::UncompressedFormat> uncompressed;
  bool is_bc6h() const { return format == bc6h_unsigned || format == bc6h_signed; }
  std::uint64_t globals_at, globals_size;
  std::uint64_t level_at, level_size, level_unpacked;  ///< of level 0

  /// The size of level 0 in a format with texels or blocks of a fixed size.
  std::uint64_t level_bytes() const {
    if (uncompressed) return std::uint64_t{width} * height * ktx2::texel_bytes(*uncompressed);
    const std::uint64_t blocks = (std::uint64_t{width} + 3) / 4 * ((std::uint64_t{height} + 3) / 4);
    if (is_bc6h()) return blocks * ktx2::bc6h_block_bytes;
    return blocks * (blocks_of_codes ? ktx2::block_bytes(*blocks_of_codes) : ktx2::uastc_block_bytes);
  }
};

Header read_header(const Fields& f) {
  Header h{};
  const std::uint32_t depth = f.word(28), layers = f.word(32), faces = f.word(36);
  h.format = f.word(12);
  h.width = f.word(20), h.height = f.word(24), h.levels = std::max(f.word(40), 1u), h.supercompression = f.word(44);
  const std::uint32_t descriptor_at = f.word(48), descriptor_size = f.word(52);
  h.globals_at = f.wide(64), h.globals_size = f.wide(72);
  if (h.width == 0 || h.height == 0) f.place.fail("it has no size");
  if (depth != 0 || layers > 1 || faces != 1) f.place.fail("it is a volume, an array or a cube, expected one image");
  if (h.levels > 32) f.place.fail(fmt::format("it has {} levels", h.levels));
  if (descriptor_size < 44) f.place.fail("its data format descriptor is too short");
  f.part(descriptor_at, descriptor_size);
  h.model = static_cast<std::uint32_t>(f.number(std::uint64_t{descriptor_at} + 12, 1));
  h.blocks_of_codes = ktx2::block_format_of(h.format), h.uncompressed = ktx2::uncompressed_format_of(h.format);
  const bool has_level = h.supercompression == none || h.supercompression == zstandard;
  const bool is_basis =
      h.format == 0 && ((h.model == etc1s && h.supercompression == basis_lz) || (h.model == uastc && has_level));
  if (!is_basis && !((h.blocks_of_codes || h.uncompressed || h.is_bc6h()) && has_level))
    throw Error(ErrorKind::Input,
                fmt::format("{}: is a KTX2 image of format {}, model {} and supercompression {}, expected Basis "
                            "Universal (ETC1S or UASTC), BC1 to BC5 or BC7 of unsigned values, BC6H, or uncompressed "
                            "texels",
                            f.place.name, h.format, h.model, h.supercompression));
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
  const SharedLibrary library(Library::Zstd, place.name);
  decltype(&ZSTD_decompress) decompress = library.find("ZSTD_decompress");
  decltype(&ZSTD_isError) is_error = library.find("ZSTD_isError");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  const std::size_t count = decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
  if (is_error(count) != 0 || count != bytes.size()) place.fail("its Zstandard data are damaged");
  return bytes;
}

TexelImage decode_level(const Header& h, std::span<const std::uint8_t> level, const ktx2::Place& place) {
  const int width = static_cast<int>(h.width), height = static_cast<int>(h.height);
  if (h.uncompressed) return ktx2::decode_uncompressed(*h.uncompressed, level, width, height);
  if (h.is_bc6h()) {
    Plane<float4> image(width, height);
    ktx2::decode_bc6h(level, h.format == bc6h_signed, place, image);
    return image;
  }
  Rgba8Image image(width, height);
  if (h.blocks_of_codes)
    ktx2::decode_blocks(*h.blocks_of_codes, level, place, image);
  else
    ktx2::decode_uastc(level, place, image);
  return image;
}

/// Level 0 of a format with texels or blocks of a fixed size.
TexelImage decode_whole_level(const Fields& f, const Header& h) {
  const std::uint64_t size = h.level_bytes();
  const std::span<const std::uint8_t> level = f.part(h.level_at, h.level_size);
  if ((h.supercompression == zstandard ? h.level_unpacked : h.level_size) != size)
    f.place.fail("level 0 has not the size of its texels");
  if (h.supercompression == zstandard) return decode_level(h, unpacked(level, size, f.place), f.place);
  return decode_level(h, level, f.place);
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

std::uint64_t ktx2_texel_memory(std::span<const std::uint8_t> bytes) {
  if (!is_ktx2(bytes) || bytes.size() < header_bytes) return sizeof(Rgba8);
  const std::string name;
  const std::uint32_t format = Fields{bytes, {name}}.word(12);
  if (format == bc6h_unsigned || format == bc6h_signed) return sizeof(float4);
  const std::optional<ktx2::UncompressedFormat> uncompressed = ktx2::uncompressed_format_of(format);
  if (!uncompressed || uncompressed->type == ktx2::ChannelType::Unorm8) return sizeof(Rgba8);
  return uncompressed->type == ktx2::ChannelType::Unorm16 ? sizeof(Rgba16) : sizeof(float4);
}

std::uint64_t ktx2_working_memory(std::span<const std::uint8_t> bytes) {
  const std::optional<int2> size = find_ktx2_size(bytes);
  if (!size) return 0;
  const std::string name;
  const auto uncompressed = ktx2::uncompressed_format_of(Fields{bytes, {name}}.word(12));
  // The unpacked level, at most a byte a texel in blocks, and code books of at most 2^16 entries each, with their
  // Huffman codes.
  constexpr std::uint64_t books = std::uint64_t{1} << 20;
  const std::uint64_t texel = uncompressed ? ktx2::texel_bytes(*uncompressed) : 1;
  return (static_cast<std::uint64_t>(size->x) + 3) * (static_cast<std::uint64_t>(size->y) + 3) * texel + books;
}

TexelImage decode_ktx2(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  const Fields f{bytes, {name}};
  const Header h = read_header(f);
  constexpr std::uint32_t most = std::numeric_limits<int>::max() / 4;
  if (h.width > most || h.height > most || std::uint64_t{h.width} * h.height > max_pixels)
    throw Error(ErrorKind::Input, fmt::format("{}: has {} x {} pixels, more than the limit of {} (--max-pixels)", name,
                                              h.width, h.height, max_pixels));
  if (h.supercompression != basis_lz) return decode_whole_level(f, h);
  Rgba8Image image(static_cast<int>(h.width), static_cast<int>(h.height));
  decode_basis_lz(f, h, image);
  return image;
}

}  // namespace zoneplate
