// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

/// The distinct names of the objects or materials, and the name of every instance.
struct Names {
  std::vector<std::string> list;
  std::vector<std::uint32_t> of_instance;
};

Names names_of(const Scene& scene, MatteKind kind) {
  Names out;
  std::map<std::string, std::uint32_t> numbers;
  const bool is_object = kind == MatteKind::Object;
  std::vector<std::uint32_t> number_of(is_object ? scene.objects.texts().size() : 0, Frame::no_id);  // of each text
  for (std::size_t number = 0; number < scene.instances.size(); ++number) {
    if (number % 1024 == 0) check_deadline();
    const Instance& instance = scene.instances[number];
    const int material = scene.meshes[static_cast<std::size_t>(instance.mesh)].material;
    const auto i = static_cast<std::size_t>(is_object ? instance.object : material);
    const std::string& text = is_object ? scene.objects[i] : scene.materials[i].name;
    std::uint32_t* const known = is_object && !text.empty() ? &number_of[scene.objects.text_of()[i]] : nullptr;
    if (known == nullptr || *known == Frame::no_id) {
      const std::string name = text.empty() ? fmt::format("{} {}", is_object ? "object" : "material", i) : text;
      const auto [entry, is_new] = numbers.try_emplace(name, static_cast<std::uint32_t>(out.list.size()));
      if (is_new) out.list.push_back(name);
      out.of_instance.push_back(entry->second);
      if (known != nullptr) *known = entry->second;
    } else {
      out.of_instance.push_back(*known);
    }
  }
  return out;
}

/// The instance of each triangle id: ids count draw after draw, two triangles for a line or point.
class InstanceOf {
 public:
  explicit InstanceOf(const Scene& scene) {
    std::size_t triangles = 0;
    for (const Instance& instance : scene.instances) {
      const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
      triangles += mesh.primitives() * (mesh.topology == Topology::Triangles ? 1 : 2);
      end_.push_back(triangles);
    }
  }
  std::size_t operator()(std::uint32_t triangle) const {
    return static_cast<std::size_t>(std::upper_bound(end_.begin(), end_.end(), triangle) - end_.begin());
  }

 private:
  std::vector<std::size_t> end_;
};

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += '\\', out += c;
    else if (static_cast<unsigned char>(c) < ' ')
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + '"';
}

std::string hex_of(float id) { return fmt::format("{:08x}", std::bit_cast<std::uint32_t>(id)); }

std::string manifest_of(std::span<const std::string> names) {
  std::string out = "{";
  for (const std::string& name : names)
    out += (out.size() > 1 ? "," : "") + quoted(name) + ":\"" + hex_of(cryptomatte_id(name)) + "\"";
  return out + "}";
}

/// The coverage of one pixel by one item.
struct Part {
  std::uint32_t name = 0;
  int samples = 0;
};

/// Counts the items at one pixel's samples and ranks them.
class PartCounter {
 public:
  PartCounter(const std::vector<Plane<std::uint32_t>>& samples, const Scene& scene, const Names& names)
      : samples_(samples), instance_of_(scene), names_(names) {}

  /// The items by descending coverage; `parts` is memory that is reused.
  void count(int x, int y, std::vector<Part>& parts) const {
    parts.clear();
    for (const Plane<std::uint32_t>& plane : samples_) {
      if (plane(x, y) == Frame::no_id) continue;
      const std::uint32_t name = names_.of_instance[instance_of_(plane(x, y))];
      const auto found = std::ranges::find(parts, name, &Part::name);
      if (found == parts.end())
        parts.push_back({name, 1});
      else
        ++found->samples;
    }
    std::ranges::sort(parts, [](const Part& a, const Part& b) {
      return a.samples != b.samples ? a.samples > b.samples : a.name < b.name;
    });
  }

 private:
  const std::vector<Plane<std::uint32_t>>& samples_;
  InstanceOf instance_of_;
  const Names& names_;
};

std::vector<std::pair<std::string, std::string>> attributes_of(const std::string& layer,
                                                               std::span<const std::string> names) {
  const std::string key = "cryptomatte/" + fmt::format("{:08x}", murmur3(layer)).substr(0, 7);
  return {{key + "/name", layer},
          {key + "/hash", "MurmurHash3_32"},
          {key + "/conversion", "uint32_to_float32"},
          {key + "/manifest", manifest_of(names)}};
}

}  // namespace

std::uint32_t murmur3(std::string_view text) {
  constexpr std::uint32_t c1 = 0xcc9e2d51, c2 = 0x1b873593;
  const auto mixed = [](std::uint32_t k) { return std::rotl(k * c1, 15) * c2; };
  std::uint32_t h = 0;
  std::size_t at = 0;
  for (; at + 4 <= text.size(); at += 4) {
    std::uint32_t k = 0;
    for (std::size_t i = 4; i-- > 0;) k = k << 8 | static_cast<unsigned char>(text[at + i]);
    h = std::rotl(h ^ mixed(k), 13) * 5 + 0xe6546b64;
  }
  std::uint32_t rest = 0;
  for (std::size_t i = text.size(); i-- > at;) rest = rest << 8 | static_cast<unsigned char>(text[i]);
  h ^= mixed(rest);
  h ^= static_cast<std::uint32_t>(text.size());
  h = (h ^ h >> 16) * 0x85ebca6b;
  h = (h ^ h >> 13) * 0xc2b2ae35;
  return h ^ h >> 16;
}

float cryptomatte_id(std::string_view name) {
  std::uint32_t bits = murmur3(name);
  const std::uint32_t exponent = bits >> 23 & 255;
  if (exponent == 0 || exponent == 255) bits ^= 1u << 23;
  return std::bit_cast<float>(bits);
}

Cryptomatte make_cryptomatte(const Frame& frame, const Scene& scene, MatteKind kind) {
  const Names names = names_of(scene, kind);
  std::vector<float> ids;
  for (const std::string& name : names.list) ids.push_back(cryptomatte_id(name));

  Cryptomatte out;
  out.layer = kind == MatteKind::Object ? "CryptoObject" : "CryptoMaterial";
  out.attributes = attributes_of(out.layer, names.list);
  const auto& samples = frame.sample_triangle;
  const int width = samples.front().width(), height = samples.front().height();
  out.ranks.assign(Cryptomatte::levels / 2, Plane<float4>(width, height, float4{0, 0, 0, 0}));

  const PartCounter counter(samples, scene, names);
  parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) {
    std::vector<Part> parts;
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      counter.count(x, y, parts);
      const std::size_t ranks = std::min<std::size_t>(parts.size(), Cryptomatte::levels);
      for (std::size_t i = 0; i < ranks; ++i) {
        float4& pair = out.ranks[i / 2](x, y);
        const float coverage = static_cast<float>(parts[i].samples) / static_cast<float>(samples.size());
        (i % 2 ? pair.z : pair.x) = ids[parts[i].name];
        (i % 2 ? pair.w : pair.y) = coverage;
      }
    }
  });
  return out;
}

}  // namespace zoneplate
