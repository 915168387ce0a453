// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace zoneplate {

/// A file of zip_of, and how it is written.
struct ZipMember {
  std::string name, text;
  bool is_deflated = false;
  bool has_descriptor = false;  ///< its sizes follow its bytes
  bool is_zip64 = false;        ///< its sizes have 64 bits
  std::uint16_t flags = 0, method = 0xffff;
  std::uint32_t crc_change = 0;
};

namespace zip_writer {

inline void append(std::vector<std::uint8_t>& out, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) out.push_back(i < 8 ? static_cast<std::uint8_t>(value >> (8 * i)) : std::uint8_t{0});
}
inline void append(std::vector<std::uint8_t>& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
}

inline std::string deflated(const std::string& text) {
  z_stream stream{};
  ::deflateInit2(&stream, 9, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY);
  std::string out(::deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  ::deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  ::deflateEnd(&stream);
  return out;
}

}  // namespace zip_writer

/// A ZIP archive.
inline std::vector<std::uint8_t> zip_of(const std::vector<ZipMember>& members) {
  using zip_writer::append;
  std::vector<std::uint8_t> out, directory;
  for (const ZipMember& m : members) {
    const std::uint64_t at = out.size(), size = m.text.size();
    const std::string packed = m.is_deflated ? zip_writer::deflated(m.text) : m.text;
    const std::uint32_t crc = static_cast<std::uint32_t>(
        ::crc32_z(0, reinterpret_cast<const Bytef*>(m.text.data()), m.text.size()) + m.crc_change);
    // The member's own header, and its line in the directory.
    for (const bool is_line : {false, true}) {
      std::vector<std::uint8_t>& to = is_line ? directory : out;
      const bool is_known = is_line || !m.has_descriptor;
      append(to, is_line ? 0x02014b50 : 0x04034b50, 4);
      if (is_line) append(to, 45, 2);
      append(to, m.is_zip64 ? 45 : 20, 2), append(to, m.flags | (m.has_descriptor ? 8 : 0), 2);
      append(to, m.method != 0xffff ? m.method : m.is_deflated ? 8 : 0, 2), append(to, 0x210000, 4);
      append(to, is_known ? crc : 0, 4);
      append(to, m.is_zip64 ? 0xffffffff : is_known ? packed.size() : 0, 4);
      append(to, m.is_zip64 ? 0xffffffff : is_known ? size : 0, 4);
      append(to, m.name.size(), 2), append(to, m.is_zip64 ? 20 : 0, 2);
      if (is_line) append(to, 0, 10), append(to, at, 4);
      append(to, m.name);
      if (m.is_zip64) append(to, 1, 2), append(to, 16, 2), append(to, size, 8), append(to, packed.size(), 8);
    }
    append(out, packed);
    if (m.has_descriptor)
      append(out, 0x08074b50, 4), append(out, crc, 4), append(out, packed.size(), 4), append(out, size, 4);
  }
  const std::size_t at = out.size();
  out.insert(out.end(), directory.begin(), directory.end());
  append(out, 0x06054b50, 4), append(out, 0, 4), append(out, members.size(), 2), append(out, members.size(), 2);
  append(out, directory.size(), 4), append(out, at, 4), append(out, 0, 2);
  return out;
}

}  // namespace zoneplate
