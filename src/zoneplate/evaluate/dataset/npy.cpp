// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/dataset/npy.h"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <cstring>
#include <string>
#include <string_view>

namespace zoneplate {
namespace {

static_assert(std::endian::native == std::endian::little);

/// The magic number and the header, a literal of a Python dictionary that is padded to whole blocks of 64 bytes.
std::string header_of(std::string_view type, std::span<const int> shape) {
  std::string lengths;
  for (const int length : shape) lengths += fmt::format("{}{}", length, shape.size() == 1 ? "," : ", ");
  if (shape.size() > 1) lengths.resize(lengths.size() - 2);
  std::string dictionary = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, lengths);
  constexpr std::size_t block = 64, fixed = 10;  // bytes before the dictionary
  dictionary.resize((fixed + dictionary.size() + 1 + block - 1) / block * block - fixed - 1, ' ');
  dictionary += '\n';
  const auto size = static_cast<std::uint16_t>(dictionary.size());
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(size & 0xff), out += static_cast<char>(size >> 8);
  return out + dictionary;
}

template <class T>
std::vector<std::uint8_t> encode(std::string_view type, std::span<const int> shape, std::span<const T> values) {
  [[maybe_unused]] std::size_t count = 1;
  for (const int length : shape) count *= static_cast<std::size_t>(length);
  assert(!shape.empty() && count == values.size());
  const std::string header = header_of(type, shape);
  std::vector<std::uint8_t> out(header.begin(), header.end());
  out.resize(header.size() + values.size_bytes());
  if (!values.empty()) std::memcpy(out.data() + header.size(), values.data(), values.size_bytes());
  return out;
}

}  // namespace

std::vector<std::uint8_t> encode_npy(std::span<const int> shape, std::span<const float> values) {
  return encode("<f4", shape, values);
}
std::vector<std::uint8_t> encode_npy(std::span<const int> shape, std::span<const std::uint32_t> values) {
  return encode("<u4", shape, values);
}
std::vector<std::uint8_t> encode_npy(std::span<const int> shape, std::span<const std::uint8_t> values) {
  return encode("|u1", shape, values);
}

}  // namespace zoneplate
