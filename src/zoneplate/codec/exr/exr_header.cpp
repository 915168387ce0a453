// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/exr/exr_encode.h"

namespace zoneplate {
namespace {

using ExrBytes = std::span<const std::uint8_t>;

/// Takes the text before the next zero byte from the front of `bytes`; at most 255 bytes.
std::optional<std::string_view> take_text(ExrBytes& bytes) {
  const std::size_t most = std::min<std::size_t>(bytes.size(), 256);
  const auto end = std::find(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(most), 0);
  if (end == bytes.begin() + static_cast<std::ptrdiff_t>(most)) return std::nullopt;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                              static_cast<std::size_t>(end - bytes.begin()));
  bytes = bytes.subspan(text.size() + 1);
  return text;
}

std::vector<ExrPartChannel> channels_in(ExrBytes value) {
  std::vector<ExrPartChannel> out;
  constexpr std::size_t description = 16;  // type, linearity, sampling along x and y
  while (const auto channel = take_text(value)) {
    if (channel->empty() || value.size() < description) break;
    std::int32_t words[4];
    std::memcpy(words, value.data(), sizeof words);
    const bool is_known = words[0] >= 0 && words[0] <= static_cast<std::int32_t>(ExrType::Float);
    out.push_back({.name = std::string(*channel),
                   .type = is_known ? static_cast<ExrType>(words[0]) : ExrType::Float,
                   .sampling = {std::max(words[2], 1), std::max(words[3], 1)}});
    value = value.subspan(description);
  }
  return out;
}

/// Numbers as text; the primaries of Rec.709 are what a file without the attribute has.
std::string floats_in(std::string_view name, ExrBytes value) {
  std::vector<float> numbers(value.size() / sizeof(float));
  if (!numbers.empty()) std::memcpy(numbers.data(), value.data(), numbers.size() * sizeof(float));
  if (name == "chromaticities" && std::ranges::equal(numbers, rec709_chromaticities)) return {};
  std::string text(name);
  for (const float v : numbers) text += fmt::format(" {:g}", v);
  return text;
}

void take_attribute(std::string_view name, std::string_view type, ExrBytes value, ExrPart& part) {
  if (type == "box2i" && value.size() == sizeof(ExrWindow)) {
    if (name == "dataWindow") std::memcpy(&part.data, value.data(), sizeof(ExrWindow));
    if (name == "displayWindow") std::memcpy(&part.display, value.data(), sizeof(ExrWindow));
  }
  if (name == "chromaticities" && type == "chromaticities" && value.size() == sizeof(ExrChromaticities))
    std::memcpy(part.chromaticities.emplace().data(), value.data(), value.size());
  const std::string text(reinterpret_cast<const char*>(value.data()), value.size());
  if (name == "channels" && type == "chlist") part.channels = channels_in(value);
  if (name == "name" && type == "string") part.name = text;
  if (name == "type" && type == "string") part.is_deep = text.starts_with("deep");
  part.attributes.push_back({name, type, value});
  if (!is_exr_color_attribute(name)) return;
  const bool are_floats = type == "chromaticities" || type == "float" || type == "v2f";
  const std::string color = are_floats ? floats_in(name, value) : fmt::format("{} {}", name, text);
  if (!color.empty()) part.color_space += (part.color_space.empty() ? "" : ", ") + color;
}

/// Takes a header from the front: attributes of a name, a type, a size and a value, up to an empty name. Nothing if it
/// is cut off.
std::optional<ExrPart> take_header(ExrBytes& bytes) {
  ExrPart part;
  const ExrBytes whole = bytes;
  for (;;) {
    part.header = whole.first(whole.size() - bytes.size());
    const auto name = take_text(bytes);
    if (!name) return std::nullopt;
    if (name->empty()) return part;
    const auto type = take_text(bytes);
    std::uint32_t size = 0;
    if (!type || bytes.size() < sizeof size) return std::nullopt;
    std::memcpy(&size, bytes.data(), sizeof size);
    bytes = bytes.subspan(sizeof size);
    if (size > bytes.size()) return std::nullopt;
    take_attribute(*name, *type, bytes.first(size), part);
    bytes = bytes.subspan(size);
  }
}

/// Width and height of the tiles of a part.
std::optional<std::array<std::uint32_t, 2>> tile_of(const ExrPart& part) {
  const ExrAttributeView* const tiles = part.find("tiles");
  std::array<std::uint32_t, 2> sides{};
  if (!tiles || tiles->value.size() < sizeof sides) return std::nullopt;
  std::memcpy(sides.data(), tiles->value.data(), sizeof sides);
  return sides;
}

}  // namespace

const ExrAttributeView* ExrPart::find(std::string_view attribute) const {
  const auto found = std::ranges::find(attributes, attribute, &ExrAttributeView::name);
  return found == attributes.end() ? nullptr : &*found;
}

bool is_exr_color_attribute(std::string_view name) {
  constexpr std::array<std::string_view, 5> all = {"chromaticities", "whiteLuminance", "adoptedNeutral",
                                                   "colorInteropID", "colorSpace"};
  return std::ranges::find(all, name) != all.end();
}

std::int64_t exr_chunk_rows(const ExrPart& part) {
  if (const auto tile = tile_of(part)) return std::clamp<std::int64_t>((*tile)[1], 1, part.data.height());
  // None, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA and DWAB; of other kinds as many as of any.
  constexpr std::array<std::int64_t, 10> rows = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  const ExrAttributeView* const found = part.find("compression");
  const std::size_t compression = found && !found->value.empty() ? found->value[0] : rows.size();
  return std::min(part.data.height(), compression < rows.size() ? rows[compression] : 256);
}

std::uint64_t exr_chunk_bytes(const ExrPart& part) {
  std::int64_t width = part.data.width();
  if (const auto tile = tile_of(part)) width = std::min<std::int64_t>(width, (*tile)[0]);
  std::uint64_t sample_bytes = 0;
  for (const ExrPartChannel& channel : part.channels) sample_bytes += channel.type == ExrType::Half ? 2 : 4;
  return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(exr_chunk_rows(part)) * sample_bytes;
}

std::optional<ExrPart> read_exr_part(std::span<const std::uint8_t> bytes) {
  if (!is_exr(bytes)) return std::nullopt;
  bytes = bytes.subspan(8);
  return take_header(bytes);
}

std::vector<ExrPart> read_exr_parts(std::span<const std::uint8_t> bytes) {
  std::vector<ExrPart> parts;
  if (!is_exr(bytes)) return parts;
  constexpr std::uint8_t several_parts = 0x10;  // bit 12 of the version
  const bool has_several = (bytes[5] & several_parts) != 0;
  // An empty header ends the list of several parts.
  for (bytes = bytes.subspan(8); !(has_several && !bytes.empty() && bytes[0] == 0);) {
    std::optional<ExrPart> part = take_header(bytes);
    if (!part) break;
    parts.push_back(std::move(*part));
    if (!has_several) break;
  }
  return parts;
}

ExrWindow exr_whole_window(const ExrPart& part) {
  const ExrWindow &data = part.data, &display = part.display;
  return {std::min(data.left, display.left), std::min(data.top, display.top), std::max(data.right, display.right),
          std::max(data.bottom, display.bottom)};
}

}  // namespace zoneplate
