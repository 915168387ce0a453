// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/output_name.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

#include "zoneplate/base/closest.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/render/frame_name.h"

namespace zoneplate::cli {
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
  for (char& c : stem)
    if (c == ':' || c == '/') c = '_';
  return stem;
}

std::string value_of(const Placeholder& place, const std::string& input, std::uint64_t index) {
  const std::filesystem::path path(input);
  const bool has_digits = !place.digits.empty() && place.digits.size() <= 2 &&
                          place.digits.find_first_not_of("0123456789") == std::string::npos;
  if (place.name == "index" && (place.digits.empty() || has_digits))
    return fmt::format("{:0{}}", index, place.digits.empty() ? 1 : std::min(std::stoi(place.digits), 20));
  if (place.digits.empty() && place.name == "model") return model_of(input);
  if (place.digits.empty() && place.name == "ext")
    return path.has_extension() ? path.extension().string().substr(1) : std::string();
  if (place.digits.empty() && place.name == "dir") {
    const std::string folder = path.parent_path().string();
    return folder.empty() ? "." : folder;
  }
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

std::string output_name(const std::string& output, const std::string& input, std::uint64_t index) {
  std::string out = output.ends_with('/') ? output + "{model}.png" : output;
  std::size_t at = 0;
  while (const std::optional<Placeholder> place = find_placeholder(out, at)) {
    if (place->name == "frame") {
      at = place->begin + place->size;
      continue;
    }
    const std::string value = value_of(*place, input, index);
    out.replace(place->begin, place->size, value);
    at = place->begin + value.size();
  }
  return out;
}

void OutputNames::add(const RenderArgs& args, const std::string& name) {
  std::string key = args.output;
  const SequenceArgs& s = args.sequence;
  if (has_frame_number(key))  // jobs may share the frames of one sequence
    key += fmt::format("\n{} {} {} {}", s.first.value_or(0), s.last.value_or(-1), s.count.value_or(-1), s.jump);
  const auto [place, is_new] = owner_.emplace(std::move(key), name);
  if (is_new) return;
  throw Error(ErrorKind::Usage, fmt::format("{} and {} would both be written to {}: use {{dir}}, {{ext}} or {{index}} "
                                            "in the output's name",
                                            place->second, name, args.output));
}

}  // namespace zoneplate::cli
