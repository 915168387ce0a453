// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr_encode.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <string_view>

#include "zoneplate/base/parallel.h"
#include "zoneplate/codec/png/deflate.h"
#include "zoneplate/codec/png/png_rows.h"
#include "zoneplate/image/half.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

static_assert(std::endian::native == std::endian::little, "words are written as they are");

constexpr std::uint8_t increasing_y = 0;

template <class T>
void put(Bytes& out, T value) {
  std::uint8_t bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}
void put_text(Bytes& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
  out.push_back(0);
}
void put_attribute(Bytes& out, std::string_view name, std::string_view type, const Bytes& value) {
  put_text(out, name);
  put_text(out, type);
  put(out, static_cast<std::uint32_t>(value.size()));
  out.insert(out.end(), value.begin(), value.end());
}
template <class... T>
Bytes values_of(T... values) {
  Bytes out;
  (put(out, values), ...);
  return out;
}

void put_attribute(Bytes& out, std::string_view name, const std::string& text) {
  put_attribute(out, name, "string", Bytes(text.begin(), text.end()));
}
void put_attribute(Bytes& out, std::string_view name, float value) {
  put_attribute(out, name, "float", values_of(value));
}
void put_attribute(Bytes& out, std::string_view name, ExrRational value) {
  put_attribute(out, name, "rational", values_of(value.numerator, value.denominator));
}
void put_attribute(Bytes& out, std::string_view name, ExrTimeCode value) {
  put_attribute(out, name, "timecode", values_of(value.packed, std::uint32_t{0}));
}
void put_attribute(Bytes& out, std::string_view name, const ExrChromaticities& value) {
  put_attribute(out, name, "chromaticities", values_of(value));
}
void put_attribute(Bytes& out, std::string_view name, const ExrMatrix& value) {
  put_attribute(out, name, "m44f", values_of(value));
}

void put_attribute(Bytes& out, std::string_view name, const ExrStoredValue& value) {
  put_attribute(out, name, value.type, value.bytes);
}

std::size_t size_of(ExrType type) { return type == ExrType::Half ? 2 : 4; }

Bytes list_of(std::span<const ExrChannel> channels) {
  Bytes out;
  for (const ExrChannel& channel : channels) {
    put_text(out, channel.name);
    put(out, static_cast<std::int32_t>(channel.type));
    put(out, std::uint32_t{0});  // pLinear: 0, the channel is not perceptually linear
    put(out, std::int32_t{channel.sampling.x});
    put(out, std::int32_t{channel.sampling.y});
  }
  out.push_back(0);
  return out;
}

Bytes window_of(const ExrWindow& w) { return values_of(w.left, w.top, w.right, w.bottom); }

Bytes header_of(const ExrPartImage& part, const std::string& name, std::size_t chunks) {
  Bytes out;
  put_attribute(out, "channels", "chlist", list_of(part.channels));
  put_attribute(out, "compression", "compression", {static_cast<std::uint8_t>(part.compression)});
  put_attribute(out, "dataWindow", "box2i", window_of(part.data));
  put_attribute(out, "displayWindow", "box2i", window_of(part.display));
  put_attribute(out, "lineOrder", "lineOrder", {increasing_y});
  const auto has = [&](std::string_view attribute) {
    return std::ranges::any_of(part.attributes, [&](const auto& a) { return a.first == attribute; });
  };
  if (!has("pixelAspectRatio")) put_attribute(out, "pixelAspectRatio", "float", values_of(1.0f));
  if (!has("screenWindowCenter")) put_attribute(out, "screenWindowCenter", "v2f", values_of(0.0f, 0.0f));
  if (!has("screenWindowWidth")) put_attribute(out, "screenWindowWidth", "float", values_of(1.0f));
  if (!name.empty()) {
    put_attribute(out, "name", name);
    put_attribute(out, "type", std::string("scanlineimage"));
    put_attribute(out, "chunkCount", "int", values_of(static_cast<std::int32_t>(chunks)));
  }
  for (const ExrAttributes::value_type& attribute : part.attributes)
    std::visit([&](const auto& value) { put_attribute(out, attribute.first, value); }, attribute.second);
  return out;
}

/// The uncompressed bytes of rows [first, end): in each row, one channel after the other.
Bytes rows_of(const ExrPartImage& part, std::size_t first, std::size_t end) {
  Bytes out;
  const auto width = static_cast<std::size_t>(part.data.width());
  for (std::size_t y = first; y < end; ++y)
    for (const ExrChannel& channel : part.channels) {
      if ((part.data.top + static_cast<std::int64_t>(y)) % channel.sampling.y != 0) continue;
      const auto column = static_cast<std::size_t>(channel.sampling.x);
      const std::size_t start = y * width * channel.step, size = size_of(channel.type);
      std::size_t at = out.size();
      out.resize(at + width / column * size);
      for (std::size_t x = 0; x < width; x += column, at += size) {
        const std::size_t from = start + x * channel.step;
        if (channel.number != nullptr) {
          std::memcpy(&out[at], channel.number + from, size);  // of halves the lower bytes
        } else if (channel.type == ExrType::Half) {
          const std::uint16_t half = half_bits(channel.value[from]);
          std::memcpy(&out[at], &half, sizeof half);
        } else {
          std::memcpy(&out[at], channel.value + from, sizeof(float));
        }
      }
    }
  return out;
}

/// The predictor of ZIP compression: the bytes at even positions before those at odd positions, each replaced by its
/// difference from the previous byte plus 128.
Bytes prepared(const Bytes& raw) {
  Bytes out(raw.size());
  const std::size_t middle = (raw.size() + 1) / 2;
  for (std::size_t i = 0; i < raw.size(); ++i) out[i / 2 + (i % 2 ? middle : 0)] = raw[i];
  for (std::size_t i = out.size(); i-- > 1;) out[i] = static_cast<std::uint8_t>(out[i] - out[i - 1] + 128);
  return out;
}

/// A compressed block: the deflated bytes, or the raw bytes if deflating does not shorten them.
Bytes packed(Bytes raw) {
  constexpr std::size_t most_part = std::size_t{1} << 24;
  const Bytes data = prepared(raw);
  Bytes out = {0x78, 0x01};
  for (std::size_t at = 0; at < data.size(); at += most_part) {
    const std::size_t n = std::min(most_part, data.size() - at);
    deflate_part(std::span(data).subspan(at, n), at + n == data.size(), out);
  }
  const std::uint32_t sum = PngRowKernels::of().adler(data.data(), data.size());
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(sum >> shift));
  return out.size() < raw.size() ? out : raw;
}

}  // namespace

ExrPartBytes encode_exr_part(ExrPartImage part, const std::string& name) {
  assert(part.data.is_sound() && !part.channels.empty());
  std::ranges::sort(part.channels, {}, &ExrChannel::name);
  const auto lines = static_cast<std::size_t>(part.data.height());
  const std::size_t block_lines = part.compression == ExrCompression::Zip ? 16 : 1;
  ExrPartBytes out;
  out.chunks.resize((lines + block_lines - 1) / block_lines);
  parallel_for(out.chunks.size(), [&](std::size_t i) {
    const std::size_t first = i * block_lines, end = std::min(lines, first + block_lines);
    Bytes rows = rows_of(part, first, end);
    if (part.compression != ExrCompression::None) rows = packed(std::move(rows));
    Bytes& chunk = out.chunks[i];
    put(chunk, static_cast<std::int32_t>(part.data.top + static_cast<std::int64_t>(first)));
    put(chunk, static_cast<std::uint32_t>(rows.size()));
    chunk.insert(chunk.end(), rows.begin(), rows.end());
  });
  out.header = header_of(part, name, out.chunks.size());
  out.has_long_names =
      std::ranges::any_of(part.channels, [](const ExrChannel& c) { return c.name.size() > most_short_exr_name; }) ||
      std::ranges::any_of(part.attributes, [](const auto& a) {
        const auto* const stored = std::get_if<ExrStoredValue>(&a.second);
        return a.first.size() > most_short_exr_name || (stored && stored->type.size() > most_short_exr_name);
      });
  return out;
}

Bytes join_exr_parts(std::span<const ExrPartBytes> parts) {
  const bool are_several = parts.size() > 1;
  // The bits of the version are those of OpenEXR's ImfVersion.h.
  constexpr std::uint32_t version = 2, long_names = 0x400, deep = 0x800, several = 0x1000;
  std::uint32_t flags = version | (are_several ? several : 0);
  for (const ExrPartBytes& part : parts) flags |= (part.has_long_names ? long_names : 0) | (part.is_deep ? deep : 0);
  Bytes out = {0x76, 0x2f, 0x31, 0x01};
  put(out, flags);
  std::uint64_t count = 0;
  for (const ExrPartBytes& part : parts) {
    out.insert(out.end(), part.header.begin(), part.header.end());
    out.push_back(0);
    count += part.chunks.size();
  }
  if (are_several) out.push_back(0);
  // The tables of chunk offsets, then the chunks.
  std::uint64_t at = out.size() + 8 * count;
  const std::size_t number = are_several ? sizeof(std::int32_t) : 0;
  for (const ExrPartBytes& part : parts)
    for (const Bytes& chunk : part.chunks) {
      put(out, at);
      at += number + chunk.size();
    }
  out.reserve(static_cast<std::size_t>(at));
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const Bytes& chunk : parts[i].chunks) {
      if (are_several) put(out, static_cast<std::int32_t>(i));
      out.insert(out.end(), chunk.begin(), chunk.end());
    }
  return out;
}

Bytes encode_exr(int width, int height, std::vector<ExrChannel> channels, const ExrAttributes& attributes,
                 ExrCompression compression) {
  const ExrWindow window{0, 0, width - 1, height - 1};
  const ExrPartBytes part = encode_exr_part({.data = window,
                                             .display = window,
                                             .channels = std::move(channels),
                                             .attributes = attributes,
                                             .compression = compression});
  return join_exr_parts({&part, 1});
}

std::vector<ExrChannel> rgba_channels(const LinearImage& image) {
  const Linear* const first = image.values().data();
  return {{"R", ExrType::Half, &first->r, nullptr, 4},
          {"G", ExrType::Half, &first->g, nullptr, 4},
          {"B", ExrType::Half, &first->b, nullptr, 4},
          {"A", ExrType::Half, &first->a, nullptr, 4}};
}

}  // namespace zoneplate
