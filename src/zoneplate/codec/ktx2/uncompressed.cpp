// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/ktx2/uncompressed.h"

#include <bit>
#include <cmath>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/image/half.h"

namespace zoneplate::ktx2 {
namespace {

std::uint32_t number(const std::uint8_t* at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value |= static_cast<std::uint32_t>(at[i]) << (8 * i);
  return value;
}

std::size_t channel_bytes(ChannelType type) {
  return type == ChannelType::Unorm8 ? 1 : type == ChannelType::Unorm16 || type == ChannelType::Half ? 2 : 4;
}

/// A texel of codes, Rgba8 or Rgba16.
template <class Texel>
Texel codes_at(UncompressedFormat format, const std::uint8_t* at) {
  using Code = decltype(Texel::r);
  Code code[4] = {0, 0, 0, static_cast<Code>(-1)};
  for (std::size_t c = 0; c < format.channels; ++c)
    code[c] = static_cast<Code>(number(at + c * sizeof(Code), sizeof(Code)));
  if (format.is_reversed) std::swap(code[0], code[2]);
  return {code[0], code[1], code[2], code[3]};
}

float4 light_at(UncompressedFormat format, const std::uint8_t* at) {
  if (format.type == ChannelType::Float11) {
    const std::uint32_t bits = number(at, 4);
    // A half float has the same exponent, four or five more bits of its mantissa, and a sign.
    const auto channel = [&](int shift, std::uint32_t mask, int more) {
      return half_value(static_cast<std::uint16_t>((bits >> shift & mask) << more));
    };
    return {channel(0, 0x7ff, 4), channel(11, 0x7ff, 4), channel(22, 0x3ff, 5), 1};
  }
  if (format.type == ChannelType::Shared9) {
    const std::uint32_t bits = number(at, 4);
    const int exponent = static_cast<int>(bits >> 27) - 15 - 9;
    const auto channel = [&](int shift) { return std::ldexp(static_cast<float>(bits >> shift & 511), exponent); };
    return {channel(0), channel(9), channel(18), 1};
  }
  float channel[4] = {0, 0, 0, 1};
  for (std::size_t c = 0; c < format.channels; ++c)
    channel[c] = format.type == ChannelType::Half ? half_value(static_cast<std::uint16_t>(number(at + 2 * c, 2)))
                                                  : std::bit_cast<float>(number(at + 4 * c, 4));
  return {channel[0], channel[1], channel[2], channel[3]};
}

template <class Texel, class At>
Plane<Texel> decode(UncompressedFormat format, std::span<const std::uint8_t> bytes, int width, int height,
                    const At& texel_at) {
  Plane<Texel> image(width, height);
  const std::uint8_t* at = bytes.data();
  for (int y = 0; y < height; ++y) {
    check_deadline();
    for (Texel& texel : image.row(y)) {
      texel = texel_at(format, at);
      at += texel_bytes(format);
    }
  }
  return image;
}

}  // namespace

std::optional<UncompressedFormat> uncompressed_format_of(std::uint32_t vulkan_format) {
  using enum ChannelType;
  switch (vulkan_format) {
    case 9:  // VK_FORMAT_R8_UNORM, and so on in the order of the numbers; the second of a pair is sRGB
    case 15:
      return UncompressedFormat{Unorm8, 1};
    case 16:
    case 22:
      return UncompressedFormat{Unorm8, 2};
    case 23:
    case 29:
      return UncompressedFormat{Unorm8, 3};
    case 30:
    case 36:
      return UncompressedFormat{Unorm8, 3, true};
    case 37:
    case 43:
      return UncompressedFormat{Unorm8, 4};
    case 44:
    case 50:
      return UncompressedFormat{Unorm8, 4, true};
    case 70:
      return UncompressedFormat{Unorm16, 1};
    case 76:
      return UncompressedFormat{Half, 1};
    case 77:
      return UncompressedFormat{Unorm16, 2};
    case 83:
      return UncompressedFormat{Half, 2};
    case 84:
      return UncompressedFormat{Unorm16, 3};
    case 90:
      return UncompressedFormat{Half, 3};
    case 91:
      return UncompressedFormat{Unorm16, 4};
    case 97:
      return UncompressedFormat{Half, 4};
    case 100:
      return UncompressedFormat{Float, 1};
    case 103:
      return UncompressedFormat{Float, 2};
    case 106:
      return UncompressedFormat{Float, 3};
    case 109:
      return UncompressedFormat{Float, 4};
    case 122:
      return UncompressedFormat{Float11, 3};
    case 123:
      return UncompressedFormat{Shared9, 3};
    default:
      return std::nullopt;
  }
}

std::size_t texel_bytes(UncompressedFormat format) {
  const bool is_packed = format.type == ChannelType::Float11 || format.type == ChannelType::Shared9;
  return is_packed ? 4 : channel_bytes(format.type) * format.channels;
}

TexelImage decode_uncompressed(UncompressedFormat format, std::span<const std::uint8_t> bytes, int width, int height) {
  if (format.type == ChannelType::Unorm8) return decode<Rgba8>(format, bytes, width, height, codes_at<Rgba8>);
  if (format.type == ChannelType::Unorm16) return decode<Rgba16>(format, bytes, width, height, codes_at<Rgba16>);
  return decode<float4>(format, bytes, width, height, light_at);
}

}  // namespace zoneplate::ktx2
