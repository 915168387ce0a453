// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/file/stored.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/animated/animation_reader.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/exr/exr_header.h"
#include "zoneplate/codec/exr/exr_layer.h"
#include "zoneplate/codec/inspect/color_space.h"

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

Layers layers_of(const ImageFile& file) {
  Layers out;
  const std::vector<ExrPart> parts = read_exr_parts(file.bytes);
  if (parts.empty()) return out;
  const ExrLayer measured = choose_exr_layer(parts, file.exr.layer, file.name);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto is_measured = [&](const ExrPartChannel& c) {
      return static_cast<int>(i) == measured.part &&
             std::ranges::find(measured.channels, c.name) != measured.channels.end();
    };
    const std::string prefix = i == 0 ? "" : parts[i].name.empty() ? fmt::format("{}.", i + 1) : parts[i].name + ".";
    for (const ExrPartChannel& c : parts[i].channels) {
      if (is_measured(c)) continue;
      // "depth.Z" may be a channel of the first part, and the channel Z of the part "depth".
      std::string name = prefix + c.name;
      while (!out.emplace(name, Layer{static_cast<int>(i), c.name, c.type == ExrType::Number}).second)
        name = fmt::format("{}.{}", i + 1, name);
    }
  }
  return out;
}

/// Bits of a channel; empty if the file lacks it.
using Bits = Plane<std::uint32_t>;

/// Pixels to leave out: 1 at ignored ones; empty if there are none.
using Mask = std::span<const std::uint8_t>;

bool is_ignored(const Mask& mask, std::size_t pixel) { return !mask.empty() && mask[pixel] != 0; }

std::size_t count_different(const Bits& a, const Bits& b, const Mask& mask) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) count += !is_ignored(mask, i) && a.values()[i] != b.values()[i];
  return count;
}

void count_not_finite(const std::string& name, std::span<const float> values, std::size_t step, bool is_color,
                      const Mask& mask, NotFinite& out) {
  std::size_t infinite = 0, undefined = 0;
  for (std::size_t i = 0; i < values.size(); i += step) {
    if (is_ignored(mask, i / step)) continue;
    infinite += std::isinf(values[i]);
    undefined += std::isnan(values[i]);
  }
  if (infinite + undefined == 0) return;
  out.channels.push_back({name, infinite + undefined});
  out.is_wrong = out.is_wrong || undefined > 0 || is_color;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

class StoredComparison {
 public:
  StoredComparison(const ImageFile& reference, const ImageFile& test)
      : files_{&reference, &test}, is_same_file_(std::ranges::equal(reference.bytes, test.bytes)) {}

  StoredDifference compare(const Picture& reference, const Picture& test) {
    compare_colors(reference, test);
    compare_layers();
    compare_meanings(reference, test);
    for (std::size_t side = 0; side < 2; ++side) {
      if (files_[side]->decode_frame) continue;
      if (const std::size_t frames = count_frames(files_[side]->bytes); frames > 1)
        differ(fmt::format("{} is an animation of {} frames, of which the first is compared", names[side], frames));
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
      for (std::size_t c = 0; c < 4; ++c)
        count_not_finite(channels[c], values.subspan(c), 4, true, mask_, side == 0 ? out_.reference : out_.test);
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

  /// The layers of both files, in groups of at most four, which the codec reads at once.
  void compare_layers() {
    const std::array<Layers, 2> layers = {layers_of(*files_[0]), layers_of(*files_[1])};
    for (std::size_t side = 0; side < 2; ++side) {
      std::vector<std::string> alone;
      for (const auto& [name, layer] : layers[side])
        if (!layers[1 - side].contains(name)) alone.push_back(name);
      if (!alone.empty()) differ(fmt::format("only {} has {}", names[side], listed(alone)));
    }
    // By the parts in both files; -1 where a file lacks the layer.
    std::map<std::array<int, 2>, std::vector<std::string>> groups;
    Layers all = layers[0];
    all.insert(layers[1].begin(), layers[1].end());
    for (const auto& [name, ignored] : all) {
      std::array<int, 2> parts = {-1, -1};
      for (std::size_t side = 0; side < 2; ++side)
        if (const auto found = layers[side].find(name); found != layers[side].end()) parts[side] = found->second.part;
      groups[parts].push_back(name);
    }
    constexpr std::size_t most = 4;
    for (const auto& [parts, members] : groups)
      for (std::size_t i = 0; i < members.size(); i += most)
        compare_group({members.begin() + static_cast<std::ptrdiff_t>(i),
                       members.begin() + static_cast<std::ptrdiff_t>(std::min(i + most, members.size()))},
                      layers);
  }

  void compare_group(const std::vector<std::string>& group, const std::array<Layers, 2>& layers) {
    std::array<std::map<std::string, Bits>, 2> bits;
    for (std::size_t side = 0; side < 2; ++side) {
      std::vector<std::string> found, channels;
      for (const std::string& name : group)
        if (const auto layer = layers[side].find(name); layer != layers[side].end())
          found.push_back(name), channels.push_back(layer->second.channel);
      if (found.empty()) continue;
      const int part = layers[side].at(found[0]).part;
      try {
        std::vector<Bits> planes = decode_exr_bits(files_[side]->bytes, files_[side]->name, part, channels);
        for (std::size_t i = 0; i < found.size(); ++i) bits[side].emplace(found[i], std::move(planes[i]));
      } catch (const Error& error) {
        differ(fmt::format("{} of {} not compared: {}", listed(found), names[side], error.what()));
        return;
      }
      for (const std::string& name : found) note_not_finite(name, layers[side].at(name), bits[side].at(name), side);
    }
    if (!is_same_size_) return;
    for (const auto& [name, reference] : bits[0]) {
      const auto test = bits[1].find(name);
      if (test == bits[1].end()) continue;
      const std::size_t different = count_different(reference, test->second, mask_);
      count(name, different);
      if (different == 0) out_.equal_layers.push_back(name);
    }
  }

  void note_not_finite(const std::string& name, const Layer& layer, const Bits& bits, std::size_t side) {
    if (layer.is_number) return;
    std::vector<float> values(bits.values().size());
    std::ranges::transform(bits.values(), values.begin(), [](std::uint32_t v) { return std::bit_cast<float>(v); });
    count_not_finite(name, values, 1, false, mask_, side == 0 ? out_.reference : out_.test);
  }

  void compare_meanings(const Picture& reference, const Picture& test) {
    std::array<std::string, 2> spaces;
    for (std::size_t side = 0; side < 2; ++side) spaces[side] = color_space_of(files_[side]->bytes);
    if (spaces[0] == spaces[1]) {
      if (test.space && !test.space->is_standard)
        out_.notes.push_back(fmt::format("both have {}: the values are compared as they are", test.space->name));
      return;
    }
    const std::string usual = test.is_scene_linear ? "Rec.709 light" : "sRGB";
    for (std::string& space : spaces)
      if (space.empty()) space = usual;
    differ(fmt::format("the values mean {} in the reference, {} in the test image: {}", spaces[0], spaces[1],
                       share_space(reference, test) ? "they are compared as they are"
                                                    : "they are compared after conversion to " + usual));
  }

  std::array<const ImageFile*, 2> files_;
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
