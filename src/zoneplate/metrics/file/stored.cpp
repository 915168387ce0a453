// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/file/stored.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/exr/exr_header.h"
#include "zoneplate/codec/exr/exr_layer.h"
#include "zoneplate/codec/inspect/color_space.h"
#include "zoneplate/codec/inspect/several_images.h"
#include "zoneplate/image/rgb_space.h"

namespace zoneplate::metrics {
namespace {

/// A channel that no metric measures, of an EXR.
struct Layer {
  int part = 0;
  std::string channel;  ///< as the file names it
  bool is_number = false;
};
/// By their names for messages.
using Layers = std::map<std::string, Layer>;

/// The parts of an EXR, what is measured of them, and the channels that no metric measures; of other files there are
/// none.
struct Contents {
  std::vector<ExrPart> parts;
  std::optional<ExrLayer> measured;
  Layers layers;

  explicit Contents(const ImageFile& file) : parts(read_exr_parts(file.bytes)) {
    if (parts.empty()) return;
    measured = choose_exr_layer(parts, file.exr.layer, file.name);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const auto is_measured = [&](const ExrPartChannel& c) {
        return static_cast<int>(i) == measured->part &&
               std::ranges::find(measured->channels, c.name) != measured->channels.end();
      };
      const std::string prefix = i == 0 ? "" : parts[i].name.empty() ? fmt::format("{}.", i + 1) : parts[i].name + ".";
      for (const ExrPartChannel& c : parts[i].channels) {
        if (is_measured(c)) continue;
        // "depth.Z" may be a channel of the first part, and the channel Z of the part "depth".
        std::string name = prefix + c.name;
        while (!layers.emplace(name, Layer{static_cast<int>(i), c.name, c.type == ExrType::Number}).second)
          name = fmt::format("{}.{}", i + 1, name);
      }
    }
  }
};

/// Bits of a channel.
using Bits = Plane<std::uint32_t>;

/// Pixels to leave out: 1 at ignored ones; empty if there are none.
using Mask = std::span<const std::uint8_t>;

bool is_ignored(const Mask& mask, std::size_t pixel) { return !mask.empty() && mask[pixel] != 0; }

std::size_t count_different(const Bits& a, const Bits& b, const Mask& mask) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) count += !is_ignored(mask, i) && a.values()[i] != b.values()[i];
  return count;
}

/// The number of values that are not finite.
struct FiniteCount {
  std::size_t infinite = 0, undefined = 0;

  void add(float value) { infinite += std::isinf(value), undefined += std::isnan(value); }
  void note(const std::string& name, bool is_color, NotFinite& out) const {
    if (infinite + undefined == 0) return;
    out.channels.push_back({name, infinite + undefined});
    out.is_wrong = out.is_wrong || undefined > 0 || is_color;
  }
};

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

class StoredComparison {
 public:
  StoredComparison(const ImageFile& reference, const ImageFile& test)
      : files_{&reference, &test},
        contents_{Contents(reference), Contents(test)},
        is_same_file_(std::ranges::equal(reference.bytes, test.bytes)) {}

  StoredDifference compare(const Picture& reference, const Picture& test) {
    compare_colors(reference, test);
    compare_layers();
    compare_meanings(reference, test);
    for (std::size_t side = 0; side < 2; ++side) {
      if (files_[side]->decode_frame) continue;
      if (const std::string several = several_images(files_[side]->bytes); !several.empty())
        differ(fmt::format("{} {}, of which the first is compared", names[side], several));
    }
    return std::move(out_);
  }

 private:
  static constexpr std::array<const char*, 2> names = {"the reference", "the test image"};

  /// Notes something by which files differ unless all their bytes are equal.
  void differ(const std::string& note) {
    out_.notes.push_back(note);
    if (!is_same_file_) out_.is_identical = false;
  }
  void count(const std::string& channel, std::size_t different) {
    if (different == 0) return;
    out_.differing.push_back({channel, different});
    out_.is_identical = false;
  }

  void compare_colors(const Picture& reference, const Picture& test) {
    constexpr std::array<const char*, 4> channels = {"R", "G", "B", "A"};
    is_same_size_ = reference.width() == test.width() && reference.height() == test.height();
    if (!is_same_size_) out_.is_identical = false;
    if (is_same_size_) mask_ = reference.is_ignored.values();
    for (std::size_t side = 0; side < 2; ++side) {
      const LinearImage& light = (side == 0 ? reference : test).linear;
      const std::span<const float> values(&light.values()[0].r, 4 * light.values().size());
      for (std::size_t c = 0; c < 4; ++c) {
        FiniteCount found;
        for (std::size_t i = c; i < values.size(); i += 4)
          if (!is_ignored(mask_, i / 4)) found.add(values[i]);
        found.note(channels[c], true, not_finite(side));
      }
    }
    if (reference.is_scene_linear != test.is_scene_linear) {
      const auto kind = [](const Picture& p) { return p.is_scene_linear ? "linear light" : "sRGB codes"; };
      return differ(fmt::format("the reference stores {}, the test image {}", kind(reference), kind(test)));
    }
    if (!is_same_size_ || has_same_values(reference, test)) return;
    const bool is_linear = test.is_scene_linear;
    for (std::size_t c = 0; c < 4; ++c) {
      const auto bits = [&](const Picture& p, std::size_t i) {
        return is_linear ? std::bit_cast<std::array<std::uint32_t, 4>>(p.linear.values()[i])[c]
                         : std::bit_cast<std::array<std::uint32_t, 4>>(p.display.values()[i])[c];
      };
      std::size_t different = 0;
      for (std::size_t i = 0; i < test.linear.values().size(); ++i)
        different += !is_ignored(mask_, i) && bits(reference, i) != bits(test, i);
      count(channels[c], different);
    }
  }

  NotFinite& not_finite(std::size_t side) { return side == 0 ? out_.reference : out_.test; }

  /// The layers of both files, those of a pair of parts together, so that each chunk is decompressed once.
  void compare_layers() {
    for (std::size_t side = 0; side < 2; ++side) {
      std::vector<std::string> alone;
      for (const auto& [name, layer] : contents_[side].layers)
        if (!contents_[1 - side].layers.contains(name)) alone.push_back(name);
      if (!alone.empty()) differ(fmt::format("only {} has {}", names[side], listed(alone)));
    }
    // By the parts in both files; -1 where a file lacks the layer.
    std::map<std::array<int, 2>, std::vector<std::string>> groups;
    Layers all = contents_[0].layers;
    all.insert(contents_[1].layers.begin(), contents_[1].layers.end());
    for (const auto& [name, ignored] : all) {
      std::array<int, 2> parts = {-1, -1};
      for (std::size_t side = 0; side < 2; ++side)
        if (const auto found = contents_[side].layers.find(name); found != contents_[side].layers.end())
          parts[side] = found->second.part;
      groups[parts].push_back(name);
    }
    for (const auto& [parts, members] : groups) compare_group(parts, members);
  }

  /// What is counted of a layer.
  struct Counts {
    std::size_t different = 0;
    std::array<FiniteCount, 2> not_finite;
  };

  /// Compares channels of a part in each file, -1 for none, band by band.
  void compare_group(const std::array<int, 2>& parts, const std::vector<std::string>& group) {
    std::vector<Counts> counts(group.size());
    std::int64_t height = 1, step = 1;
    for (std::size_t side = 0; side < 2; ++side)
      if (parts[side] >= 0) {
        const ExrPart& part = contents_[side].parts[static_cast<std::size_t>(parts[side])];
        height = std::max(height, part.display.height());
        if (part.data.is_sound()) step = std::max(step, exr_band_rows(part, 2 * group.size()));
      }
    for (std::int64_t first = 0; first < height; first += step)
      if (!compare_band(parts, group, first, first + step, counts)) return;
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (std::size_t side = 0; side < 2; ++side)
        if (parts[side] >= 0 && !contents_[side].layers.at(group[i]).is_number)
          counts[i].not_finite[side].note(group[i], false, not_finite(side));
      if (!is_same_size_ || parts[0] < 0 || parts[1] < 0) continue;
      count(group[i], counts[i].different);
      if (counts[i].different == 0) out_.equal_layers.push_back(group[i]);
    }
  }

  const ExrWindow& display_of(int part, std::size_t side) const {
    return contents_[side].parts[static_cast<std::size_t>(part)].display;
  }

  /// Rows [first, end) of the group. False, with a note, if they cannot be decoded.
  bool compare_band(const std::array<int, 2>& parts, const std::vector<std::string>& group, std::int64_t first,
                    std::int64_t end, std::vector<Counts>& counts) {
    std::array<std::vector<Bits>, 2> bits;
    for (std::size_t side = 0; side < 2; ++side) {
      if (parts[side] < 0) continue;
      ExrWindow rows = display_of(parts[side], side);
      if (rows.is_sound()) {  // else the decoder says so
        if (first >= rows.height()) continue;
        rows.bottom = static_cast<int>(rows.top + std::min(end, rows.height()) - 1);
        rows.top = static_cast<int>(rows.top + first);
      }
      const Mask mask = mask_of(first, rows);
      try {
        // The channels of one file are equal to themselves, whatever else they are.
        if (side == 1 && is_same_file_ && parts[0] == parts[1]) {
          for (Counts& c : counts) c.not_finite[1] = c.not_finite[0];
          return true;
        }
        std::vector<std::string> channels;
        for (const std::string& name : group) channels.push_back(contents_[side].layers.at(name).channel);
        bits[side] = decode_exr_bits(files_[side]->bytes, files_[side]->name, parts[side], channels, rows);
      } catch (const Error& error) {
        differ(fmt::format("{} of {} not compared: {}", listed(group), names[side], error.what()));
        return false;
      }
      for (std::size_t i = 0; i < group.size(); ++i) {
        const std::span<const std::uint32_t> values = bits[side][i].values();
        for (std::size_t k = 0; k < values.size(); ++k)
          if (!is_ignored(mask, k)) counts[i].not_finite[side].add(std::bit_cast<float>(values[k]));
      }
    }
    if (!is_same_size_ || bits[0].empty() || bits[1].empty()) return true;
    for (std::size_t i = 0; i < group.size(); ++i)
      counts[i].different += count_different(bits[0][i], bits[1][i], mask_of(first, display_of(parts[0], 0)));
    return true;
  }

  /// The mask from a row on, of layers of the size that is measured.
  Mask mask_of(std::int64_t first, const ExrWindow& rows) const {
    return mask_.empty() ? mask_ : mask_.subspan(static_cast<std::size_t>(first * rows.width()));
  }

  void compare_meanings(const Picture& reference, const Picture& test) {
    std::array<std::string, 2> spaces;
    for (std::size_t side = 0; side < 2; ++side) {
      const RgbSpacePtr& found = (side == 0 ? reference : test).space;
      spaces[side] = color_space_of(files_[side]->bytes, files_[side]->name, files_[side]->exr);
      // Only the decoder finds the profile of a JPEG XL.
      if (spaces[side].empty() && found && !found->is_standard) spaces[side] = found->name;
    }
    if (spaces[0] == spaces[1]) {
      if (test.space && !test.space->is_standard)
        out_.notes.push_back(fmt::format("both have {}: the values are compared as they are", test.space->name));
      return;
    }
    const bool is_data =
        std::ranges::any_of(contents_, [](const Contents& c) { return c.measured && !c.measured->has_colors; });
    const std::string usual = test.is_scene_linear ? "Rec.709 light" : "sRGB";
    for (std::string& space : spaces)
      if (space.empty()) space = usual;
    differ(fmt::format("the {} mean {} in the reference, {} in the test image: {}",
                       is_data ? "colours beside the layer" : "values", spaces[0], spaces[1],
                       share_space(reference, test) ? "they are compared as they are"
                                                    : "they are compared after conversion to " + usual));
  }

  std::array<const ImageFile*, 2> files_;
  std::array<Contents, 2> contents_;
  bool is_same_file_, is_same_size_ = true;
  Mask mask_;
  StoredDifference out_;
};

}  // namespace

StoredDifference compare_stored(const ImageFile& reference_file, const Picture& reference, const ImageFile& test_file,
                                const Picture& test) {
  return StoredComparison(reference_file, test_file).compare(reference, test);
}

bool share_space(const Picture& reference, const Picture& test) {
  const auto is_usual = [](const Picture& p) { return !p.space || p.space->is_standard; };
  if (reference.is_scene_linear != test.is_scene_linear) return is_usual(reference) && is_usual(test);
  return is_same(reference.space, test.space);
}

}  // namespace zoneplate::metrics
