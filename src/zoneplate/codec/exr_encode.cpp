// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr_encode.h"

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

std::size_t size_of(ExrType type) { return type == ExrType::Half ? 2 : 4; }

Bytes list_of(std::span<const ExrChannel> channels) {
  Bytes out;
  for (const ExrChannel& channel : channels) {
    put_text(out, channel.name);
    put(out, static_cast<std::int32_t>(channel.type));
    put(out, std::uint32_t{0});  // pLinear: 0, the channel is not perceptually linear
    put(out, std::int32_t{1});   // xSampling and ySampling: one sample per pixel
    put(out, std::int32_t{1});
  }
  out.push_back(0);
  return out;
}

Bytes header_of(int width, int height, std::span<const ExrChannel> channels, const ExrAttributes& attributes,
                ExrCompression compression) {
  Bytes out = {0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0};
  const Bytes window = values_of(0, 0, width - 1, height - 1);
  put_attribute(out, "channels", "chlist", list_of(channels));
  put_attribute(out, "compression", "compression", {static_cast<std::uint8_t>(compression)});
  put_attribute(out, "dataWindow", "box2i", window);
  put_attribute(out, "displayWindow", "box2i", window);
  put_attribute(out, "lineOrder", "lineOrder", {increasing_y});
  put_attribute(out, "pixelAspectRatio", "float", values_of(1.0f));
  put_attribute(out, "screenWindowCenter", "v2f", values_of(0.0f, 0.0f));
  put_attribute(out, "screenWindowWidth", "float", values_of(1.0f));
  for (const ExrAttributes::value_type& attribute : attributes)
    std::visit([&](const auto& value) { put_attribute(out, attribute.first, value); }, attribute.second);
  out.push_back(0);
  return out;
}

/// The uncompressed bytes of rows [first, end): in each row, one channel after the other.
Bytes rows_of(std::span<const ExrChannel> channels, std::size_t width, std::size_t first, std::size_t end) {
  Bytes out;
  for (std::size_t y = first; y < end; ++y)
    for (const ExrChannel& channel : channels) {
      const std::size_t start = y * width * channel.step, at = out.size();
      out.resize(at + width * size_of(channel.type));
      for (std::size_t x = 0; x < width; ++x) {
        const std::size_t from = start + x * channel.step;
        if (channel.type == ExrType::Half) {
          const std::uint16_t half = half_bits(channel.value[from]);
          std::memcpy(&out[at + 2 * x], &half, sizeof half);
        } else if (channel.type == ExrType::Float) {
          std::memcpy(&out[at + 4 * x], channel.value + from, sizeof(float));
        } else {
          std::memcpy(&out[at + 4 * x], channel.number + from, sizeof(std::uint32_t));
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

std::vector<std::uint8_t> encode_exr(int width, int height, std::vector<ExrChannel> channels,
                                     const ExrAttributes& attributes, ExrCompression compression) {
  assert(width > 0 && height > 0 && !channels.empty());
  std::ranges::sort(channels, {}, &ExrChannel::name);
  const auto lines = static_cast<std::size_t>(height);
  const std::size_t block_lines = compression == ExrCompression::Zip ? 16 : 1;
  std::vector<Bytes> blocks((lines + block_lines - 1) / block_lines);
  parallel_for(blocks.size(), [&](std::size_t i) {
    const std::size_t first = i * block_lines, end = std::min(lines, first + block_lines);
    Bytes rows = rows_of(channels, static_cast<std::size_t>(width), first, end);
    blocks[i] = compression == ExrCompression::None ? std::move(rows) : packed(std::move(rows));
  });

  Bytes out = header_of(width, height, channels, attributes, compression);
  // The table of block offsets, then the blocks: first row, size, bytes.
  std::uint64_t at = out.size() + 8 * blocks.size();
  for (const Bytes& block : blocks) {
    put(out, at);
    at += 8 + block.size();
  }
  out.reserve(static_cast<std::size_t>(at));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    put(out, static_cast<std::int32_t>(i * block_lines));
    put(out, static_cast<std::uint32_t>(blocks[i].size()));
    out.insert(out.end(), blocks[i].begin(), blocks[i].end());
  }
  return out;
}

std::vector<ExrChannel> rgba_channels(const LinearImage& image) {
  const Linear* const first = image.values().data();
  return {{"R", ExrType::Half, &first->r, nullptr, 4},
          {"G", ExrType::Half, &first->g, nullptr, 4},
          {"B", ExrType::Half, &first->b, nullptr, 4},
          {"A", ExrType::Half, &first->a, nullptr, 4}};
}

}  // namespace zoneplate
