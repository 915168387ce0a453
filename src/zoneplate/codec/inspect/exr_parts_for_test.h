// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace zoneplate {

/// A channel of one value.
struct ExrChannelForTest {
  std::string name;
  float value = 0;
  int sampling = 1;  ///< the columns and rows to a sample
};

/// A part of an EXR with several.
struct ExrPartForTest {
  std::string name;
  std::vector<ExrChannelForTest> channels;  ///< sorted by name
};

/// An uncompressed EXR of several parts, which encode_exr does not write.
///
/// Requires  a side that is a multiple of each channel's sampling.
/// Source    OpenEXR File Layout, openexr.com: multi-part files.
inline std::vector<std::uint8_t> exr_of_parts(int side, const std::vector<ExrPartForTest>& parts) {
  std::vector<std::uint8_t> out;
  const auto put = [&](const void* data, std::size_t size) {
    const auto* const bytes = static_cast<const std::uint8_t*>(data);
    out.insert(out.end(), bytes, bytes + size);
  };
  const auto put_int = [&](std::int32_t v) { put(&v, sizeof v); };
  const auto put_float = [&](float v) { put(&v, sizeof v); };
  const auto put_text = [&](const std::string& text) { put(text.c_str(), text.size() + 1); };
  const auto attribute = [&](const char* name, const char* type, std::size_t size) {
    put_text(name), put_text(type), put_int(static_cast<std::int32_t>(size));
  };
  put_int(20000630), put_int(2 | 0x1000);
  for (const ExrPartForTest& part : parts) {
    std::size_t size = 1;
    for (const ExrChannelForTest& c : part.channels) size += c.name.size() + 1 + 16;
    attribute("channels", "chlist", size);
    for (const ExrChannelForTest& c : part.channels)
      put_text(c.name), put_int(2), put_int(0), put_int(c.sampling), put_int(c.sampling);
    out.push_back(0);
    attribute("chunkCount", "int", 4), put_int(side);
    attribute("compression", "compression", 1), out.push_back(0);
    for (const char* window : {"dataWindow", "displayWindow"}) {
      attribute(window, "box2i", 16);
      put_int(0), put_int(0), put_int(side - 1), put_int(side - 1);
    }
    attribute("lineOrder", "lineOrder", 1), out.push_back(0);
    attribute("name", "string", part.name.size()), put(part.name.data(), part.name.size());
    attribute("pixelAspectRatio", "float", 4), put_float(1);
    attribute("screenWindowCenter", "v2f", 8), put_float(0), put_float(0);
    attribute("screenWindowWidth", "float", 4), put_float(1);
    attribute("type", "string", 13), put("scanlineimage", 13);
    out.push_back(0);
  }
  out.push_back(0);
  const auto row_of = [&](const ExrPartForTest& part, int y) {
    std::vector<float> row;
    for (const ExrChannelForTest& c : part.channels)
      if (y % c.sampling == 0) row.insert(row.end(), static_cast<std::size_t>(side / c.sampling), c.value);
    return row;
  };
  std::uint64_t offset = out.size() + parts.size() * static_cast<std::size_t>(side) * sizeof offset;
  for (const ExrPartForTest& part : parts)
    for (int y = 0; y < side; ++y) {
      put(&offset, sizeof offset);
      offset += 12 + row_of(part, y).size() * sizeof(float);
    }
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (int y = 0; y < side; ++y) {
      const std::vector<float> row = row_of(parts[i], y);
      put_int(static_cast<std::int32_t>(i)), put_int(y), put_int(static_cast<std::int32_t>(row.size() * sizeof(float)));
      put(row.data(), row.size() * sizeof(float));
    }
  return out;
}

}  // namespace zoneplate
