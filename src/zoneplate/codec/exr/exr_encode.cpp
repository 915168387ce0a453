// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr_encode.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <string_view>
#include <utility>

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

/// In the order in which the format stores them.
std::vector<ExrChannel> sorted(std::vector<ExrChannel> channels) {
  std::ranges::sort(channels, {}, &ExrChannel::name);
  return channels;
}

Bytes list_of(const std::vector<ExrChannel>& channels) {
  Bytes out;
  for (const ExrChannel& channel : sorted(channels)) {
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

/// The uncompressed bytes of rows [first, end) of a window, whose first row is `top`: in each row, one channel after
/// the other.
Bytes rows_of(std::span<const ExrChannel> channels, std::size_t width, std::int64_t top, std::size_t first,
              std::size_t end) {
  Bytes out;
  for (std::size_t y = first; y < end; ++y)
    for (const ExrChannel& channel : channels) {
      if ((top + static_cast<std::int64_t>(y)) % channel.sampling.y != 0) continue;
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

std::size_t lines_of_block(const ExrPartImage& part) { return part.compression == ExrCompression::Zip ? 16 : 1; }

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
  constexpr std::size_t max_part = std::size_t{1} << 24;
  const Bytes data = prepared(raw);
  Bytes out = {0x78, 0x01};
  for (std::size_t at = 0; at < data.size(); at += max_part) {
    const std::size_t n = std::min(max_part, data.size() - at);
    deflate_part(std::span(data).subspan(at, n), at + n == data.size(), out);
  }
  const std::uint32_t sum = PngRowKernels::of().adler(data.data(), data.size());
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(sum >> shift));
  return out.size() < raw.size() ? out : raw;
}

}  // namespace

std::vector<Bytes> encode_exr_rows(const ExrPartImage& part, std::int64_t first, std::int64_t end) {
  assert(part.data.is_sound() && !part.channels.empty() && first >= 0 && end <= part.data.height());
  const std::vector<ExrChannel> channels = sorted(part.channels);
  const auto width = static_cast<std::size_t>(part.data.width()), lines = static_cast<std::size_t>(end - first);
  const std::size_t block_lines = lines_of_block(part);
  assert(static_cast<std::size_t>(first) % block_lines == 0);
  assert(end == part.data.height() || lines % block_lines == 0);
  std::vector<Bytes> chunks((lines + block_lines - 1) / block_lines);
  parallel_for(chunks.size(), [&](std::size_t i) {
    const std::size_t block = i * block_lines;
    Bytes rows = rows_of(channels, width, part.data.top + first, block, std::min(lines, block + block_lines));
    if (part.compression != ExrCompression::None) rows = packed(std::move(rows));
    Bytes& chunk = chunks[i];
    put(chunk, static_cast<std::int32_t>(part.data.top + first + static_cast<std::int64_t>(block)));
    put(chunk, static_cast<std::uint32_t>(rows.size()));
    chunk.insert(chunk.end(), rows.begin(), rows.end());
  });
  return chunks;
}

ExrPartHeader exr_part_header(const ExrPartImage& part, const std::string& name) {
  ExrPartHeader out;
  const auto lines = static_cast<std::size_t>(part.data.height()), block_lines = lines_of_block(part);
  out.chunks = (lines + block_lines - 1) / block_lines;
  out.bytes = header_of(part, name, out.chunks);
  out.has_long_names =
      std::ranges::any_of(part.channels, [](const ExrChannel& c) { return c.name.size() > max_short_exr_name; }) ||
      std::ranges::any_of(part.attributes, [](const auto& a) {
        const auto* const stored = std::get_if<ExrStoredValue>(&a.second);
        return a.first.size() > max_short_exr_name || (stored && stored->type.size() > max_short_exr_name);
      });
  return out;
}

ExrPartBytes encode_exr_part(const ExrPartImage& part, const std::string& name) {
  return {exr_part_header(part, name), encode_exr_rows(part, 0, part.data.height())};
}

ExrFileWriter::ExrFileWriter(std::vector<ExrPartHeader> parts, std::uint64_t bytes) : parts_(std::move(parts)) {
  const bool are_several = parts_.size() > 1;
  // The bits of the version are those of OpenEXR's ImfVersion.h.
  constexpr std::uint32_t version = 2, long_names = 0x400, deep = 0x800, several = 0x1000;
  std::uint32_t flags = version | (are_several ? several : 0);
  for (const ExrPartHeader& part : parts_) flags |= (part.has_long_names ? long_names : 0) | (part.is_deep ? deep : 0);
  out_ = {0x76, 0x2f, 0x31, 0x01};
  put(out_, flags);
  std::size_t count = 0;
  for (const ExrPartHeader& part : parts_) {
    out_.insert(out_.end(), part.bytes.begin(), part.bytes.end());
    out_.push_back(0);
    count += part.chunks;
  }
  if (are_several) out_.push_back(0);
  // The tables of chunk offsets, then the chunks.
  table_ = out_.size();
  out_.reserve(table_ + count * (sizeof(std::uint64_t) + sizeof(std::int32_t)) + static_cast<std::size_t>(bytes));
  out_.resize(table_ + count * sizeof(std::uint64_t));
}

void ExrFileWriter::add(std::span<const std::uint8_t> chunk) {
  while (done_ == parts_[part_].chunks) done_ = 0, ++part_;
  ++done_;
  const std::uint64_t at = out_.size();
  std::memcpy(&out_[table_], &at, sizeof at);
  table_ += sizeof at;
  if (parts_.size() > 1) put(out_, static_cast<std::int32_t>(part_));
  out_.insert(out_.end(), chunk.begin(), chunk.end());
}

Bytes ExrFileWriter::finish() { return std::move(out_); }

Bytes join_exr_parts(std::vector<ExrPartBytes> parts) {
  std::vector<ExrPartHeader> headers;
  std::uint64_t bytes = 0;
  for (ExrPartBytes& part : parts) {
    headers.push_back(std::move(part.header));
    for (const Bytes& chunk : part.chunks) bytes += chunk.size();
  }
  ExrFileWriter file(std::move(headers), bytes);
  for (ExrPartBytes& part : parts)
    for (Bytes& chunk : part.chunks) file.add(std::exchange(chunk, {}));
  return file.finish();
}

Bytes encode_exr(int width, int height, std::vector<ExrChannel> channels, const ExrAttributes& attributes,
                 ExrCompression compression) {
  const ExrWindow window{0, 0, width - 1, height - 1};
  std::vector<ExrPartBytes> parts;
  parts.push_back(encode_exr_part({.data = window,
                                   .display = window,
                                   .channels = std::move(channels),
                                   .attributes = attributes,
                                   .compression = compression}));
  return join_exr_parts(std::move(parts));
}

std::vector<ExrChannel> rgba_channels(const LinearImage& image) {
  const Linear* const first = image.values().data();
  return {{"R", ExrType::Half, &first->r, nullptr, 4},
          {"G", ExrType::Half, &first->g, nullptr, 4},
          {"B", ExrType::Half, &first->b, nullptr, 4},
          {"A", ExrType::Half, &first->a, nullptr, 4}};
}

}  // namespace zoneplate
