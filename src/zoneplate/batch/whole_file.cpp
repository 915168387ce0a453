// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/whole_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <string>

namespace zoneplate {
namespace {

using Bytes = std::span<const std::uint8_t>;

bool begins_with(Bytes bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
}
bool ends_with(Bytes bytes, std::string_view text) {
  return bytes.size() >= text.size() && begins_with(bytes.last(text.size()), text);
}

/// A whole number of `size` bytes at `at`; 0 if the file ends before.
std::uint64_t number_at(Bytes bytes, std::uint64_t at, int size, bool is_big_endian = false) {
  std::uint64_t number = 0;
  if (at > bytes.size() || bytes.size() - at < static_cast<std::uint64_t>(size)) return 0;
  for (int i = 0; i < size; ++i)
    number = number << 8 | bytes[at + static_cast<std::uint64_t>(is_big_endian ? i : size - 1 - i)];
  return number;
}

/// Boxes of a size and a name, one after the other.
bool is_whole_mp4(Bytes bytes) {
  if (bytes.size() < 8 || !begins_with(bytes.subspan(4), "ftyp")) return false;
  std::uint64_t at = 0;
  while (at < bytes.size()) {
    std::uint64_t size = number_at(bytes, at, 4, true);
    if (size == 1) size = number_at(bytes, at + 8, 8, true);
    if (size < 8 || size > bytes.size() - at) return false;
    at += size;
  }
  return true;
}

bool is_whole_pfm(Bytes bytes) {
  // "PF" for colour or "Pf" for grey, width, height and scale, each followed by one space.
  std::array<std::uint64_t, 2> size{};
  std::size_t at = 3;
  if (!begins_with(bytes, "PF") && !begins_with(bytes, "Pf")) return false;
  const std::string head(bytes.begin(),
                         bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(bytes.size(), 100)));
  for (std::uint64_t& side : size) {
    const std::size_t end = head.find_first_of(" \n", at);
    if (end == head.npos) return false;
    if (std::from_chars(head.data() + at, head.data() + end, side).ptr != head.data() + end || side > 1 << 20)
      return false;
    at = end + 1;
  }
  const std::size_t end = head.find('\n', at);
  return end != head.npos && bytes.size() == end + 1 + size[0] * size[1] * (head[1] == 'F' ? 12 : 4);
}

/// Where an attribute of the header begins; its name and type are texts that end with 0.
struct ExrAttribute {
  std::string_view name;
  std::uint64_t value = 0, size = 0;
};

/// The attribute at `at`, which moves behind it; no name at the end of the header.
ExrAttribute next_attribute(Bytes bytes, std::uint64_t& at) {
  const auto text = [&] {
    const auto rest = bytes.subspan(std::min<std::uint64_t>(at, bytes.size()));
    const auto size = static_cast<std::size_t>(std::ranges::find(rest, 0) - rest.begin());
    at += size + 1;
    return std::string_view(reinterpret_cast<const char*>(rest.data()), size);
  };
  ExrAttribute out{.name = text()};
  if (out.name.empty()) return out;
  text();
  out.size = number_at(bytes, at, 4), out.value = at + 4;
  at = out.value + out.size;
  return out;
}

/// A file with one part of scan lines, as they are written here, is as long as its chunks say. Others are taken as
/// whole.
bool is_whole_exr(Bytes bytes) {
  if (!begins_with(bytes, "\x76\x2f\x31\x01")) return false;
  if (number_at(bytes, 4, 4) >> 9 != 0) return true;  // tiles, deep data or several parts
  std::uint64_t at = 8, rows = 0, rows_together = 1;
  for (;;) {
    const ExrAttribute attribute = next_attribute(bytes, at);
    if (at > bytes.size()) return false;
    if (attribute.name.empty()) break;
    if (attribute.name == "dataWindow")
      rows = number_at(bytes, attribute.value + 12, 4) - number_at(bytes, attribute.value + 4, 4) + 1;
    if (attribute.name == "compression") {
      constexpr std::uint64_t rows_of[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
      const std::uint64_t kind = number_at(bytes, attribute.value, 1);
      if (kind >= std::size(rows_of)) return true;
      rows_together = rows_of[kind];
    }
  }
  rows &= 0xffffffff;
  const std::uint64_t chunks = (rows + rows_together - 1) / rows_together;
  if (chunks == 0 || chunks > (bytes.size() - at) / 8) return false;
  std::uint64_t farthest = 0;
  for (std::uint64_t i = 0; i < chunks; ++i) farthest = std::max(farthest, number_at(bytes, at + 8 * i, 8));
  return farthest >= at + 8 * chunks && farthest <= bytes.size() - 8 &&
         farthest + 8 + number_at(bytes, farthest + 4, 4) == bytes.size();
}

}  // namespace

bool is_whole_file(std::string_view extension, std::span<const std::uint8_t> bytes) {
  if (extension == ".png" || extension == ".apng")
    return begins_with(bytes, "\x89PNG\r\n\x1a\n") && ends_with(bytes, "IEND\xae\x42\x60\x82");
  if (extension == ".jpg" || extension == ".jpeg")
    return begins_with(bytes, "\xff\xd8\xff") && ends_with(bytes, "\xff\xd9");
  if (extension == ".gif") return begins_with(bytes, "GIF8") && ends_with(bytes, ";");
  if (extension == ".webp") return begins_with(bytes, "RIFF") && number_at(bytes, 4, 4) + 8 == bytes.size();
  if (extension == ".mp4" || extension == ".mov") return is_whole_mp4(bytes);
  if (extension == ".pfm") return is_whole_pfm(bytes);
  if (extension == ".exr") return is_whole_exr(bytes);
  return !bytes.empty();
}

}  // namespace zoneplate
