// SPDX-License-Identifier: Apache-2.0
// EXR images that claim many pixels, tiles, parts or samples.
#include <zlib.h>

#include <cstring>

#include "appetite.h"

namespace zoneplate::appetite {
namespace {

template <class T>
void append_value(Bytes& out, T value) {
  const std::size_t at = out.size();
  out.resize(at + sizeof value);
  std::memcpy(out.data() + at, &value, sizeof value);
}

void append_text(Bytes& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
  out.push_back(0);
}

void append_attribute(Bytes& out, std::string_view name, std::string_view type, const Bytes& value) {
  append_text(out, name), append_text(out, type);
  append_value(out, static_cast<std::uint32_t>(value.size()));
  out.insert(out.end(), value.begin(), value.end());
}

Bytes text(std::string_view words) { return {words.begin(), words.end()}; }

/// Channels of half floats.
Bytes channels(const std::vector<std::string>& names) {
  Bytes out;
  for (const std::string& name : names) {
    append_text(out, name);
    for (const std::int32_t word : {1, 0, 1, 1}) append_value(out, word);  // half, not linear, each pixel
  }
  out.push_back(0);
  return out;
}

enum Compression : std::uint8_t { None = 0, Zip = 3 };
enum Flags : std::uint32_t { Tiled = 0x200, Deep = 0x800, Parts = 0x1000 };

Bytes begin_exr(std::uint32_t flags) {
  Bytes out;
  append_value(out, std::uint32_t{20000630}), append_value(out, 2 | flags);
  return out;
}

/// What every header has; the zero at its end is left to the caller.
void append_header(Bytes& out, std::int32_t width, std::int32_t height, Compression compression,
                   const Bytes& channel_list) {
  append_attribute(out, "channels", "chlist", channel_list);
  append_attribute(out, "compression", "compression", {compression});
  Bytes window;
  for (const std::int32_t v : {0, 0, width - 1, height - 1}) append_value(window, v);
  append_attribute(out, "dataWindow", "box2i", window);
  append_attribute(out, "displayWindow", "box2i", window);
  append_attribute(out, "lineOrder", "lineOrder", {0});
  Bytes one, centre;
  append_value(one, 1.0f), append_value(centre, 0.0f), append_value(centre, 0.0f);
  append_attribute(out, "pixelAspectRatio", "float", one);
  append_attribute(out, "screenWindowCenter", "v2f", centre);
  append_attribute(out, "screenWindowWidth", "float", one);
}

/// Pixels of zero, in blocks of 16 rows packed by ZIP.
Bytes zero_exr(std::int32_t side) {
  constexpr std::int32_t rows = 16;
  Bytes out = begin_exr(0);
  append_header(out, side, side, Zip, channels({"B", "G", "R"}));
  out.push_back(0);
  Bytes raw(static_cast<std::size_t>(side) * rows * 3 * 2, 128);  // the differences of zeros
  raw[0] = 0;
  Bytes packed(::compressBound(raw.size()));
  uLongf size = packed.size();
  ::compress2(packed.data(), &size, raw.data(), raw.size(), 9);
  packed.resize(size);
  const auto blocks = static_cast<std::uint64_t>(side / rows);
  const std::uint64_t first = out.size() + blocks * 8;
  for (std::uint64_t i = 0; i < blocks; ++i) append_value(out, first + i * (8 + size));
  for (std::int32_t y = 0; y < side; y += rows) {
    append_value(out, y), append_value(out, static_cast<std::uint32_t>(size));
    out.insert(out.end(), packed.begin(), packed.end());
  }
  return out;
}

Bytes claimed_exr(std::int32_t width, std::int32_t height) {
  Bytes out = begin_exr(0);
  append_header(out, width, height, None, channels({"B", "G", "R"}));
  out.push_back(0);
  return out;
}

Bytes tiled_exr(std::int32_t side) {
  Bytes out = begin_exr(Tiled), tiles;
  append_header(out, side, side, None, channels({"R"}));
  append_value(tiles, 1u), append_value(tiles, 1u), tiles.push_back(0);
  append_attribute(out, "tiles", "tiledesc", tiles);
  out.push_back(0);
  out.resize(out.size() + 4096);
  return out;
}

Bytes parted_exr(int parts) {
  Bytes out = begin_exr(Parts), chunks;
  append_value(chunks, std::int32_t{4096});
  for (int i = 0; i < parts; ++i) {
    append_header(out, 4096, 4096, None, channels({"R"}));
    append_attribute(out, "name", "string", text(std::to_string(i)));
    append_attribute(out, "type", "string", text("scanlineimage"));
    append_attribute(out, "chunkCount", "int", chunks);
    out.push_back(0);
  }
  out.push_back(0);
  return out;
}

Bytes deep_exr() {
  Bytes out = begin_exr(Deep), chunks, samples;
  append_header(out, 8192, 8192, None, channels({"A", "R", "Z"}));
  append_value(chunks, std::int32_t{8192}), append_value(samples, std::int32_t{0x7fffffff});
  append_attribute(out, "name", "string", text("deep"));
  append_attribute(out, "type", "string", text("deepscanline"));
  append_attribute(out, "version", "int", {1, 0, 0, 0});
  append_attribute(out, "maxSamplesPerPixel", "int", samples);
  append_attribute(out, "chunkCount", "int", chunks);
  out.push_back(0);
  for (std::uint64_t y = 0; y < 8192; ++y) append_value(out, out.size() + 8);
  return out;
}

Bytes many_channels() {
  std::vector<std::string> names;
  for (int i = 0; i < 50000; ++i) names.push_back("c" + std::to_string(100000 + i));
  names.push_back("d.R");
  Bytes out = begin_exr(0);
  append_header(out, 4096, 4096, Zip, channels(names));
  out.push_back(0);
  out.resize(out.size() + 4096);
  return out;
}

Bytes many_attributes() {
  Bytes out = begin_exr(0);
  append_header(out, 4, 4, None, channels({"R"}));
  for (int i = 0; i < 100000; ++i) append_attribute(out, "a" + std::to_string(i), "string", text("b"));
  out.push_back(0);
  out.resize(out.size() + 4096);
  return out;
}

}  // namespace

void add_exr(Collection& out) {
  const auto add = [&](const std::string& name, const Bytes& bytes) {
    out.add_picture("exr", name, ".exr", bytes, within_limits);
  };
  add("exr-claim", claimed_exr(1 << 23, 1 << 23));
  add("exr-claim-8k", claimed_exr(8000, 8000));
  add("exr-zeros-8k", zero_exr(8192));
  add("exr-zeros-3k", zero_exr(3200));
  add("exr-tiles", tiled_exr(8000));
  add("exr-parts", parted_exr(10000));
  add("exr-deep", deep_exr());
  add("exr-channels", many_channels());
  add("exr-attributes", many_attributes());
}

}  // namespace zoneplate::appetite
