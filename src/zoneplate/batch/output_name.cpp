// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/output_name.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

#include "zoneplate/base/closest.h"
#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

constexpr std::array<std::string_view, 5> placeholders = {"model", "ext", "dir", "index", "frame"};

/// A placeholder {name} or {name:digits} in a text.
struct Placeholder {
  std::size_t begin = 0, size = 0;
  std::string name;
  std::string digits;
};

/// The first placeholder from `at` on. Braces around anything but a word are part of the name.
std::optional<Placeholder> find_placeholder(const std::string& text, std::size_t at) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_-";
  for (std::size_t begin = text.find('{', at); begin != text.npos; begin = text.find('{', begin + 1)) {
    const std::size_t end = text.find('}', begin);
    if (end == text.npos) return std::nullopt;
    const std::string inside = text.substr(begin + 1, end - begin - 1);
    const std::size_t colon = std::min(inside.find(':'), inside.size());
    const std::string name = inside.substr(0, colon);
    if (name.empty() || name.find_first_not_of(letters) != name.npos) continue;
    return Placeholder{begin, end + 1 - begin, name, colon < inside.size() ? inside.substr(colon + 1) : ""};
  }
  return std::nullopt;
}

std::string model_of(const std::string& input) {
  std::string stem = input == "-" ? "stdin" : std::filesystem::path(input).stem().string();
  const bool is_dots = stem.find_first_not_of('.') == stem.npos;
  for (char& c : stem)
    if (c == ':' || c == '/' || is_dots) c = '_';
  return stem.empty() ? "_" : stem;
}

// The folder of an input, as a path that does not lead upwards.
std::string folder_of(const std::string& input) {
  const std::filesystem::path whole = std::filesystem::path(input).parent_path().lexically_normal();
  std::filesystem::path out;
  for (const std::filesystem::path& part : whole.relative_path())
    if (part != ".." && !part.empty()) out /= part;
  return out.empty() ? "." : out.string();
}

// `is_beginning`: the placeholder is the folder at the beginning of the whole name.
std::string value_of(const Placeholder& place, const std::string& input, std::uint64_t index, bool is_beginning) {
  const std::filesystem::path path(input);
  const bool has_digits = !place.digits.empty() && place.digits.size() <= 2 &&
                          place.digits.find_first_not_of("0123456789") == std::string::npos;
  if (place.name == "index" && (place.digits.empty() || has_digits))
    return fmt::format("{:0{}}", index, place.digits.empty() ? 1 : std::min(std::stoi(place.digits), 20));
  if (place.digits.empty() && place.name == "model") return model_of(input);
  if (place.digits.empty() && place.name == "ext")
    return path.has_extension() ? path.extension().string().substr(1) : std::string();
  if (place.digits.empty() && place.name == "dir")
    return is_beginning && path.has_parent_path() ? path.parent_path().string() : folder_of(input);
  const std::string_view near = closest(place.name, placeholders);
  throw Error(ErrorKind::Usage,
              fmt::format("--output: there is no placeholder {{{}}}; {}", place.name,
                          near.empty() || near == place.name ? "there are {model}, {ext}, {dir}, {index} and {frame}"
                                                             : fmt::format("did you mean {{{}}}?", near)));
}

}  // namespace

bool names_input(const std::string& output) {
  if (output.ends_with('/')) return true;
  std::size_t at = 0;
  while (const std::optional<Placeholder> place = find_placeholder(output, at)) {
    if (place->name != "frame") return true;
    at = place->begin + place->size;
  }
  return false;
}

OutputName output_name(const std::string& output, const std::string& input, std::uint64_t index, bool is_sequence) {
  const std::string pattern =
      output.ends_with('/') ? output + (is_sequence ? "{model}.####.png" : "{model}.png") : output;
  const std::optional<FramePlace> frame = find_frame_place(pattern);
  OutputName out;
  const auto copy = [&](std::size_t begin, std::size_t end) {
    if (frame && frame->begin >= begin && frame->begin < end)
      out.frame = FramePlace{out.text.size() + frame->begin - begin, frame->size, frame->digits};
    out.text.append(pattern, begin, end - begin);
  };
  std::size_t copied = 0, at = 0;
  while (const std::optional<Placeholder> place = find_placeholder(pattern, at)) {
    at = place->begin + place->size;
    if (place->name == "frame") continue;
    copy(copied, place->begin);
    const bool is_beginning = place->begin == 0 && pattern.substr(at, 1) == "/";
    out.text += value_of(*place, input, index, is_beginning);
    copied = at;
  }
  copy(copied, pattern.size());
  const std::size_t end = out.frame ? out.frame->begin + out.frame->size : out.text.size();
  if (end < out.text.size() && out.text[end] >= '0' && out.text[end] <= '9')
    throw Error(ErrorKind::Usage,
                fmt::format("--output: {}: a digit follows the frame number; put another character between", out.text));
  return out;
}

}  // namespace zoneplate
