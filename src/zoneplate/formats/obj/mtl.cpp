// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/mtl.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "zoneplate/base/deadline.h"
#include "zoneplate/formats/import/text_scan.h"

namespace zoneplate {
namespace {

/// Parses a finite number; "1.#IND" and the like are rejected.
std::optional<float> find_value(std::string_view word) {
  const std::optional<float> number = find_number(word);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

/// Keys are case-insensitive, because files differ (map_Kd, map_kd, map_bump, map_Bump).
std::string lower(std::string_view word) {
  std::string out(word);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

/// Takes up to `most` numbers from the front of the line, and stops at the first other word.
std::vector<float> take_numbers(LineWords& words, std::size_t most) {
  std::vector<float> numbers;
  while (numbers.size() < most) {
    LineWords ahead = words;
    const std::optional<float> number = find_value(ahead.next());
    if (!number || ahead.is_over()) break;  // the last argument is the file name, even if it is a number
    numbers.push_back(*number);
    words = ahead;
  }
  return numbers;
}

bool takes_numbers(std::string_view option) {
  return option == "-o" || option == "-s" || option == "-t" || option == "-mm";
}
bool takes_word(std::string_view option) {
  constexpr std::array all = {"-blendu", "-blendv", "-boost",   "-cc",   "-clamp",
                              "-texres", "-bm",     "-imfchan", "-type", "-colorspace"};
  return std::find(all.begin(), all.end(), option) != all.end();
}

/// Reads the options at the front of the words.
void read_options(LineWords& words, MtlTexture& texture) {
  for (;;) {
    LineWords ahead = words;
    const std::string option = lower(ahead.next());
    if (takes_numbers(option)) {
      const std::vector<float> v = take_numbers(ahead, option == "-mm" ? 2 : 3);
      const float first = option == "-s" ? 1 : 0;
      const float2 pair{v.size() > 0 ? v[0] : first, v.size() > 1 ? v[1] : first};
      if (option == "-o") texture.offset = pair;
      if (option == "-s") texture.scale = pair;
    } else if (takes_word(option)) {
      const std::string_view word = ahead.next();
      if (option == "-clamp") texture.clamp = word == "on";
      if (option == "-bm") texture.strength = find_value(word).value_or(1);
    } else {
      return;
    }
    words = ahead;
  }
}

/// The length of the file name at the front of a text: up to an option or a comment that follows the name's extension.
/// Names contain spaces, and '#' or '-' after one, so that these end a name only there.
std::size_t name_length(std::string_view text) {
  constexpr std::size_t longest_extension = 5;  // .jpeg
  for (std::size_t space = text.find(' '); space != text.npos; space = text.find(' ', space + 1)) {
    const std::size_t dot = text.substr(0, space).rfind('.');
    if (dot == text.npos || space - dot > longest_extension || space - dot < 2) continue;
    const std::size_t next = text.find_first_not_of(' ', space);
    if (next == text.npos) continue;
    const std::string word = lower(text.substr(next, text.find(' ', next) - next));
    if (word.front() == '#' || takes_numbers(word) || takes_word(word)) return space;
  }
  return text.size();
}

/// The options may precede the file name, as the format has it, or follow it.
MtlTexture read_texture(LineWords words) {
  MtlTexture texture;
  read_options(words, texture);
  texture.file = words.rest();
  const std::string behind = texture.file.substr(name_length(texture.file));
  texture.file.resize(texture.file.size() - behind.size());
  const std::string last = behind + " .";  // so that the last number is an option's, not a file's name
  LineWords options(last);
  read_options(options, texture);
  return texture;
}

class MtlReader {
 public:
  MtlReader(const std::string& file, std::vector<std::string>& warnings,
            const std::function<bool(const std::string&)>& is_used)
      : file_(file), warnings_(warnings), is_used_(is_used) {}

  std::vector<MtlMaterial> take() {
    close();
    return std::move(materials_);
  }

  void read_line(std::uint64_t line, LineWords words) {
    line_ = line;
    const std::string key = lower(words.next());
    if (key.empty()) return;
    if (key == "newmtl") {
      close();
      open_.emplace().name = words.rest();
      return;
    }
    if (!open_) return warn(fmt::format("{} before newmtl is ignored", key));
    if (!read_color(key, words) && !read_value(key, words)) read_map(key, words);
  }

 private:
  /// Keeps the current material, if it is used. A map of Ka is nearly always the same as that of Kd; alone it is lost.
  void close() {
    if (open_ && has_ambient_map_ && open_->diffuse_map.file.empty()) open_->unsupported.push_back("map_ka");
    has_ambient_map_ = false;
    if (open_ && is_used_(open_->name)) materials_.push_back(std::move(*open_));
    open_.reset();
  }

  void warn(const std::string& text) {
    constexpr int most = 20;
    if (++warned_ > most) return;
    warnings_.push_back(warned_ < most ? fmt::format("{}: line {}: {}", file_, line_, text)
                                       : fmt::format("{}: line {}: further warnings are omitted", file_, line_));
  }

  bool read_color(const std::string& key, LineWords words) {
    MtlMaterial& m = *open_;
    std::optional<float3>* target = key == "kd"   ? &m.diffuse
                                    : key == "ka" ? &m.ambient
                                    : key == "ks" ? &m.specular
                                    : key == "ke" ? &m.emissive
                                                  : nullptr;
    if (target == nullptr) return false;
    std::array<float, 3> v{};
    std::size_t n = 0;
    for (; n < 3; ++n) {
      const std::string_view word = words.next();
      if (word.empty()) break;
      const std::optional<float> value = find_value(word);
      if (!value) return warn(fmt::format("{}: '{}' is not a number", key, word.substr(0, 40))), true;
      v[n] = std::max(0.0f, *value);
    }
    if (n == 0) return warn(key + " has no numbers"), true;
    *target = n == 3 ? float3{v[0], v[1], v[2]} : float3{v[0], v[0], v[0]};
    return true;
  }

  bool read_value(const std::string& key, LineWords words) {
    MtlMaterial& m = *open_;
    std::optional<float>* target = key == "ns"       ? &m.exponent
                                   : key == "d"      ? &m.opacity
                                   : key == "tr"     ? &m.transparency
                                   : key == "pr"     ? &m.roughness
                                   : key == "pm"     ? &m.metallic
                                   : key == "ps"     ? &m.sheen
                                   : key == "pc"     ? &m.clearcoat
                                   : key == "pcr"    ? &m.clearcoat_roughness
                                   : key == "aniso"  ? &m.anisotropy
                                   : key == "anisor" ? &m.anisotropy_rotation
                                   : key == "ni"     ? &m.index_of_refraction
                                                     : nullptr;
    if (target == nullptr && key != "illum") return false;
    std::string_view word = words.next();
    if (word == "-halo") word = words.next();
    const std::optional<float> value = find_value(word);
    if (!value) return warn(fmt::format("{}: '{}' is not a number", key, word.substr(0, 40))), true;
    if (target != nullptr)
      *target = *value;
    else
      m.illumination = static_cast<int>(std::clamp(*value, 0.0f, 100.0f));
    return true;
  }

  void read_map(const std::string& key, LineWords words) {
    MtlMaterial& m = *open_;
    MtlTexture* target = key == "map_kd"                      ? &m.diffuse_map
                         : key == "map_ke"                    ? &m.emissive_map
                         : key == "map_d"                     ? &m.opacity_map
                         : key == "norm"                      ? &m.normal_map
                         : key == "map_ks"                    ? &m.specular_map
                         : key == "map_ns"                    ? &m.exponent_map
                         : key == "map_pr"                    ? &m.roughness_map
                         : key == "map_pm"                    ? &m.metallic_map
                         : key == "bump" || key == "map_bump" ? &m.bump_map
                         : key == "disp" || key == "map_disp" ? &m.displacement_map
                                                              : nullptr;
    if (target != nullptr) {
      *target = read_texture(words);
      if (target->file.empty()) warn(key + " names no file");
      return;
    }
    const bool is_map = key.substr(0, 4) == "map_" || key == "decal" || key == "refl";
    has_ambient_map_ = has_ambient_map_ || key == "map_ka";
    if (is_map && key != "map_ka" && key != "map_aat") {
      constexpr std::size_t max_keys = 16;  // more than the format has
      const bool is_new = std::find(m.unsupported.begin(), m.unsupported.end(), key) == m.unsupported.end();
      if (is_new && m.unsupported.size() < max_keys) m.unsupported.push_back(key);
      return;
    }
    constexpr std::array known = {"tf", "sharpness", "km", "map_ka", "map_aat", "xalpha", "spectral"};
    if (std::find(known.begin(), known.end(), key) == known.end())
      warn(fmt::format("'{}' is unknown and ignored", key.substr(0, 40)));
  }

  const std::string& file_;
  std::vector<std::string>& warnings_;
  const std::function<bool(const std::string&)>& is_used_;
  std::optional<MtlMaterial> open_;  ///< the material that is being read
  bool has_ambient_map_ = false;     ///< it has a map of Ka
  std::vector<MtlMaterial> materials_;
  std::uint64_t line_ = 0;
  int warned_ = 0;
};

}  // namespace

std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& file, std::vector<std::string>& warnings,
                                   const std::function<bool(const std::string&)>& is_used) {
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  const char separator = text.find('\n') == text.npos && text.find('\r') != text.npos ? '\r' : '\n';
  MtlReader reader(file, warnings, is_used);
  // A backslash at the end of a line continues the line, as in OBJ; no file name ends in a backslash.
  TextLines lines(text, 1, separator);
  constexpr std::uint64_t lines_per_check = 1024;
  for (std::uint64_t line = 0; lines.next(); ++line) {
    if (line % lines_per_check == 0) check_deadline();
    reader.read_line(lines.number(), LineWords(lines.line()));
  }
  return reader.take();
}

}  // namespace zoneplate
