// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr_replace.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr_layer.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ExrBytes = std::span<const std::uint8_t>;

constexpr std::array<float Linear::*, 4> slots = {&Linear::r, &Linear::g, &Linear::b, &Linear::a};

template <class T>
T value_at(ExrBytes bytes, std::size_t at) {
  T out;
  std::memcpy(&out, bytes.data() + at, sizeof out);
  return out;
}

/// The attributes but those that state how the part is packed, which encode_exr_part writes, and a preview, which would
/// show another image; of a part among others it also writes the name. (`version`, of deep parts, some readers expect
/// of the others too.)
ExrAttributes carried_attributes(const ExrPart& part, bool has_name, const ExrStorage& storage) {
  constexpr std::array<std::string_view, 10> own = {
      "channels", "compression", "dataWindow", "displayWindow", "lineOrder",
      "tiles",    "type",        "chunkCount", "preview",       "dwaCompressionLevel"};
  ExrAttributes out;
  std::set<std::string_view> taken;
  for (const ExrAttributeView& a : part.attributes) {
    if (std::ranges::find(own, a.name) != own.end() || (has_name && a.name == "name")) continue;
    if (storage.is_converted && is_exr_color_attribute(a.name)) continue;
    // Of several attributes of a name, readers take the first or none.
    if (!taken.insert(a.name).second) continue;
    out.emplace_back(std::string(a.name), ExrStoredValue{std::string(a.type), {a.value.begin(), a.value.end()}});
  }
  return out;
}

ExrCompression compression_of(const ExrPart& part) {
  const ExrAttributeView* const found = part.find("compression");
  if (!found || found->value.empty()) return ExrCompression::Zip;
  const auto compression = static_cast<ExrCompression>(found->value[0]);
  const bool is_written = compression == ExrCompression::None || compression == ExrCompression::Zips;
  return is_written ? compression : ExrCompression::Zip;
}

/// The channels of an image in place of those of a layer.
class LayerChannels {
 public:
  LayerChannels(const ExrPart& part, const ExrLayer& layer, const LinearImage& image, std::optional<ExrType> type)
      : part_(part), layer_(layer), image_(image), type_(type) {}

  std::vector<ExrChannel> make() const {
    const bool is_grey = layer_.kind == ExrLayer::Kind::Grey && has_equal_colors();
    std::vector<ExrChannel> out;
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const bool is_alpha = i == 3;
      if (is_grey && (i == 1 || i == 2)) continue;
      const std::string& own = layer_.channels[i];
      // What the file lacks reads as black and opaque.
      const bool is_renamed = !is_alpha && has_new_names(is_grey);
      if (own.empty() && !is_renamed && is_everywhere(i, is_alpha ? 1.0f : 0.0f)) continue;
      const std::string name = own.empty() || is_renamed ? new_name(i) : own;
      out.push_back({.name = name, .type = type_of(i), .value = &(image_.values()[0].*slots[i]), .step = 4});
    }
    return out;
  }

 private:
  /// True where the three colours have one channel or none of their own.
  bool has_new_names(bool is_grey) const {
    return layer_.kind == ExrLayer::Kind::Chroma || (layer_.kind == ExrLayer::Kind::Grey && !is_grey);
  }
  std::string new_name(std::size_t slot) const { return layer_.prefix + "RGBA"[slot]; }

  bool has_equal_colors() const {
    return std::ranges::all_of(image_.values(), [](const Linear& c) { return c.r == c.g && c.g == c.b; });
  }
  bool is_everywhere(std::size_t slot, float value) const {
    constexpr float rounding = 1e-5f;  // of sums of weights
    return std::ranges::all_of(image_.values(),
                               [&](const Linear& c) { return std::abs(c.*slots[slot] - value) <= rounding; });
  }

  ExrType type_of(std::size_t slot) const {
    if (type_) return *type_;
    const std::string& own = layer_.channels[slot];
    bool are_halves = true;
    for (const std::string& name : layer_.channels) {
      if (name.empty() || (!own.empty() && name != own)) continue;
      const auto channel = std::ranges::find(part_.channels, name, &ExrPartChannel::name);
      are_halves = are_halves && channel != part_.channels.end() && channel->type == ExrType::Half;
    }
    constexpr float max_half = 65504;
    const auto fits = [&](const Linear& c) { return !(std::abs(c.*slots[slot]) > max_half); };
    return are_halves && std::ranges::all_of(image_.values(), fits) ? ExrType::Half : ExrType::Float;
  }

  const ExrPart& part_;
  const ExrLayer& layer_;
  const LinearImage& image_;
  std::optional<ExrType> type_;
};

/// True if all pixels outside a window are 0; the image fills `whole`.
bool is_empty_outside(const LinearImage& image, const ExrWindow& whole, const ExrWindow& window) {
  for (std::int64_t y = whole.top; y <= whole.bottom; ++y) {
    const auto row = image.row(static_cast<int>(y - whole.top));
    const bool is_inside = y >= window.top && y <= window.bottom;
    for (std::int64_t x = whole.left; x <= whole.right; ++x)
      if (!(is_inside && x >= window.left && x <= window.right) &&
          row[static_cast<std::size_t>(x - whole.left)] != Linear{0, 0, 0, 0})
        return false;
  }
  return true;
}

bool contains(const ExrWindow& outer, const ExrWindow& inner) {
  return outer.left <= inner.left && outer.top <= inner.top && outer.right >= inner.right &&
         outer.bottom >= inner.bottom;
}

/// A part of a file of several, as it is packed.
class PackedPart {
 public:
  PackedPart(ExrBytes file, const std::string& name, const ExrPart& part) : file_(file), name_(name), part_(part) {}

  std::optional<std::size_t> chunk_count() const {
    const ExrAttributeView* const found = part_.find("chunkCount");
    if (!found || found->value.size() != sizeof(std::int32_t)) return std::nullopt;
    const auto count = value_at<std::int32_t>(found->value, 0);
    if (count < 0 || static_cast<std::size_t>(count) > file_.size() / sizeof(std::uint64_t)) return std::nullopt;
    return static_cast<std::size_t>(count);
  }

  ExrPartHeader header() const {
    ExrPartHeader out{.bytes = {part_.header.begin(), part_.header.end()},
                      .chunks = chunk_count().value_or(0),
                      .is_deep = part_.is_deep};
    const auto is_long = [](std::string_view name) { return name.size() > max_short_exr_name; };
    out.has_long_names =
        std::ranges::any_of(part_.attributes, [&](const auto& a) { return is_long(a.name) || is_long(a.type); }) ||
        std::ranges::any_of(part_.channels, [&](const ExrPartChannel& c) { return is_long(c.name); });
    return out;
  }

  /// Copies the chunks whose offsets are in a table.
  void copy_chunks(int number, std::size_t table, ExrFileWriter& file) const {
    std::size_t total = 0;
    for (std::size_t i = 0; i < chunk_count().value_or(0); ++i) {
      const ExrBytes chunk = chunk_at(number, word(table + i * sizeof(std::uint64_t)));
      if ((total += chunk.size()) > file_.size()) throw incomplete();  // chunks share no bytes
      file.add(chunk);
    }
  }

 private:
  Error incomplete() const {
    return {ErrorKind::Input, name_ + ": EXR: part " + part_.name + " is corrupt or cut off"};
  }
  std::uint64_t word(std::size_t at) const {
    if (at > file_.size() || file_.size() - at < sizeof(std::uint64_t)) throw incomplete();
    return value_at<std::uint64_t>(file_, at);
  }

  /// A chunk without the number of its part: coordinates, sizes and bytes.
  ExrBytes chunk_at(int number, std::uint64_t at) const {
    const ExrAttributeView* const type = part_.find("type");
    const std::string_view text =
        type ? std::string_view(reinterpret_cast<const char*>(type->value.data()), type->value.size()) : "";
    const std::size_t coordinates = text == "tiledimage" || text == "deeptile" ? 16 : 4;
    const std::size_t sizes = part_.is_deep ? 3 * sizeof(std::uint64_t) : sizeof(std::int32_t);
    const std::size_t head = sizeof(std::int32_t) + coordinates + sizes;
    if (at > file_.size() || file_.size() - at < head) throw incomplete();
    const ExrBytes bytes = file_.subspan(static_cast<std::size_t>(at));
    if (value_at<std::int32_t>(bytes, 0) != number) throw incomplete();
    const std::size_t place = sizeof(std::int32_t) + coordinates;
    const std::uint64_t most = bytes.size() - head;
    std::uint64_t size = 0;
    if (part_.is_deep) {
      const auto counts = value_at<std::uint64_t>(bytes, place), samples = value_at<std::uint64_t>(bytes, place + 8);
      if (counts > most || samples > most) throw incomplete();
      size = counts + samples;
    } else {
      size = value_at<std::uint32_t>(bytes, place);
    }
    if (size > most) throw incomplete();
    return bytes.subspan(sizeof(std::int32_t), coordinates + sizes + static_cast<std::size_t>(size));
  }

  ExrBytes file_;
  const std::string& name_;
  const ExrPart& part_;
};

class Replacement {
 public:
  Replacement(ExrBytes file, const std::string& name, const ExrChoice& choice)
      : file_(file), name_(name), choice_(choice), parts_(read_exr_parts(file)) {
    layer_ = choose_exr_layer(parts_, choice.layer, name);
  }

  ExrReplacement make(const LinearImage& image, const ExrStorage& storage) {
    if (!part().data.is_sound() || !part().display.is_sound())
      throw Error(ErrorKind::Input, name_ + ": EXR: the header is wrong");
    const ExrWindow whole = choice_.area == ExrArea::Whole ? exr_whole_window(part()) : part().display;
    if (image.width() != whole.width() || image.height() != whole.height()) return alone(image, storage);
    ExrWindow window = whole;
    if (contains(whole, part().data)) {
      if (is_empty_outside(image, whole, part().data)) window = part().data;
    } else {
      out_.left_out.push_back("the pixels outside the display window");
    }
    const LinearImage cropped = cropped_to(image, {window.left - whole.left, window.top - whole.top,
                                                   window.right - whole.left, window.bottom - whole.top});
    const bool is_joined = parts_.size() > 1 && !storage.is_converted;
    ExrPartImage own = {.data = window,
                        .display = part().display,
                        .channels = LayerChannels(part(), layer_, cropped, storage.type).make(),
                        .attributes = carried_attributes(part(), is_joined, storage),
                        .compression = compression_of(part())};
    if (storage.is_converted) {
      leave_out_others();
      set_only(encode_exr_part(own));
      return std::move(out_);
    }
    write_with_others(std::move(own), is_joined ? part().name : "");
    return std::move(out_);
  }

 private:
  const ExrPart& part() const { return parts_[static_cast<std::size_t>(layer_.part)]; }

  bool is_replaced(const ExrPartChannel& channel) const {
    return std::ranges::find(layer_.channels, channel.name) != layer_.channels.end();
  }

  void leave_out_others() {
    for (const ExrPartChannel& channel : part().channels)
      if (!is_replaced(channel)) out_.left_out.push_back(channel.name);
    for (const ExrPart& other : parts_)
      if (&other != &part()) out_.left_out.push_back("part " + other.name);
  }
  void set_only(ExrPartBytes own) {
    std::vector<ExrPartBytes> parts;
    parts.push_back(std::move(own));
    out_.bytes = join_exr_parts(std::move(parts));
  }

  /// A file of the layer alone, of another size than its own.
  ExrReplacement alone(const LinearImage& image, const ExrStorage& storage) {
    leave_out_others();
    if (!contains(part().display, part().data)) out_.left_out.push_back("the pixels outside the display window");
    const ExrWindow window{0, 0, image.width() - 1, image.height() - 1};
    set_only(encode_exr_part({.data = window,
                              .display = window,
                              .channels = LayerChannels(part(), layer_, image, storage.type).make(),
                              .attributes = carried_attributes(part(), false, storage),
                              .compression = compression_of(part())}));
    return std::move(out_);
  }

  /// Writes the part with its other channels, and the other parts.
  void write_with_others(ExrPartImage own, const std::string& name) {
    const std::vector<ExrChannel> replaced = own.channels;
    const std::vector<std::string> names = add_others(own);
    // The tables of offsets follow the headers, the last of which ends before one or two zeros.
    const ExrPart& last = parts_.back();
    std::size_t table = static_cast<std::size_t>(last.header.data() + last.header.size() - file_.data()) + 2;
    std::vector<ExrPartHeader> headers;
    std::vector<std::size_t> tables;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const PackedPart packed(file_, name_, parts_[i]);
      const std::optional<std::size_t> chunks = parts_.size() > 1 ? packed.chunk_count() : std::size_t{0};
      if (!chunks) throw Error(ErrorKind::Input, name_ + ": EXR: part " + parts_[i].name + " states no chunks");
      headers.push_back(static_cast<int>(i) == layer_.part ? exr_part_header(own, name) : packed.header());
      tables.push_back(table);
      table += *chunks * sizeof(std::uint64_t);
    }
    // Packed pixels never take more than unpacked ones behind their place and size. Room for 2 GB costs nothing.
    constexpr std::uint64_t head = 8, room = std::uint64_t{1} << 31;
    std::uint64_t row_bytes = head;
    for (const ExrChannel& c : own.channels)
      row_bytes += static_cast<std::uint64_t>((c.type == ExrType::Half ? 2 : 4) * own.data.width());
    const std::uint64_t most = file_.size() + row_bytes * static_cast<std::uint64_t>(own.data.height());
    ExrFileWriter file(std::move(headers), std::min(most, std::max<std::uint64_t>(room, 2 * file_.size())));
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (static_cast<int>(i) == layer_.part)
        write_bands(own, replaced, names, file);
      else
        PackedPart(file_, name_, parts_[i]).copy_chunks(static_cast<int>(i), tables[i], file);
    out_.bytes = file.finish();
  }

  /// Encodes the part band by band, so that few rows of its other channels are in memory.
  void write_bands(ExrPartImage& own, std::span<const ExrChannel> replaced, const std::vector<std::string>& names,
                   ExrFileWriter& file) const {
    const auto width = static_cast<std::size_t>(own.data.width());
    const std::int64_t height = own.data.height(), step = exr_band_rows(part(), std::max<std::size_t>(names.size(), 1));
    for (std::int64_t first = 0; first < height; first += step) {
      const std::int64_t end = std::min(height, first + step);
      ExrWindow rows = own.data;
      rows.top = static_cast<std::int32_t>(own.data.top + first);
      rows.bottom = static_cast<std::int32_t>(own.data.top + end - 1);
      std::vector<Plane<std::uint32_t>> planes;
      if (!names.empty()) planes = decode_exr_stored(file_, name_, layer_.part, names, rows);
      for (std::size_t i = 0; i < replaced.size(); ++i)
        own.channels[i].value = replaced[i].value + static_cast<std::size_t>(first) * width * replaced[i].step;
      for (std::size_t i = 0; i < names.size(); ++i)
        own.channels[replaced.size() + i].number = planes[i].values().data();
      for (const Bytes& chunk : encode_exr_rows(own, first, end)) file.add(chunk);
    }
  }

  /// Adds them without their values, and returns their names.
  std::vector<std::string> add_others(ExrPartImage& own) {
    std::set<std::string> taken;
    for (const ExrChannel& channel : own.channels) taken.insert(channel.name);
    std::vector<std::string> names;
    for (const ExrPartChannel& channel : part().channels) {
      if (is_replaced(channel)) continue;
      if (!is_aligned(channel, own.data) || !taken.insert(channel.name).second) {
        out_.left_out.push_back(channel.name);
        continue;
      }
      names.push_back(channel.name);
      own.channels.push_back({.name = channel.name, .type = channel.type, .sampling = channel.sampling});
    }
    return names;
  }

  static bool is_aligned(const ExrPartChannel& channel, const ExrWindow& window) {
    const int2 s = channel.sampling;
    return window.left % s.x == 0 && window.width() % s.x == 0 && window.top % s.y == 0 && window.height() % s.y == 0;
  }

  ExrBytes file_;
  const std::string& name_;
  const ExrChoice& choice_;
  std::vector<ExrPart> parts_;
  ExrLayer layer_;
  ExrReplacement out_;
};

}  // namespace

LinearImage cropped_to(const LinearImage& image, const ExrWindow& window) {
  LinearImage out(static_cast<int>(window.width()), static_cast<int>(window.height()));
  for (int y = 0; y < out.height(); ++y)
    std::copy_n(image.row(y + window.top).begin() + window.left, out.width(), out.row(y).begin());
  return out;
}

ExrReplacement replace_exr_layer(std::span<const std::uint8_t> file, const std::string& name, const ExrChoice& choice,
                                 const LinearImage& image, const ExrStorage& storage) {
  return Replacement(file, name, choice).make(image, storage);
}

}  // namespace zoneplate
