// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/import/model_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/formats/import/model_path.h"

namespace zoneplate {
namespace {

std::string with_slashes(std::string_view name) {
  std::string out(name);
  std::replace(out.begin(), out.end(), '\\', '/');
  if (out.size() >= 2 && out.front() == '"' && out.back() == '"') out = out.substr(1, out.size() - 2);
  return out;
}

/// Encodes a file name as a URI, the argument of find_path.
std::string to_uri(const std::string& name) {
  std::string out;
  for (const char c : name) out += c == '%' ? std::string("%25") : std::string(1, c);
  return out;
}

bool is_file(const std::string& path) {
  std::error_code trouble;
  return std::filesystem::is_regular_file(path, trouble);
}

/// Whether a name with slashes is absolute, in Unix or Windows.
bool is_absolute(const std::string& path) { return path.starts_with('/') || (path.size() > 1 && path[1] == ':'); }

}  // namespace

std::optional<std::string> ModelFolder::find_file(const std::string& within, std::string_view name) {
  const std::string path = with_slashes(name);
  const std::string last = path.substr(path.find_last_of('/') + 1);
  const std::string tries[] = {is_absolute(path) ? path : within + path, path, within + last, last};
  for (const std::string& attempt : tries) {
    const auto found = find_path(folder_, to_uri(attempt), budget_.limits().allowed_paths);
    if (found && is_file(*found)) return found;
  }
  for (const std::string& attempt : tries) {
    const auto found = finder_.find(to_uri(attempt));
    if (found && is_file(*found)) return found;
  }
  return std::nullopt;
}

std::string ModelFolder::missing_text(const std::string& within, const std::string& name) const {
  const std::string path = with_slashes(name);
  if (path.find("<UDIM>") != path.npos) return name + ": a set of UDIM tiles, which are not drawn";
  const bool is_outside =
      !path.empty() && !is_absolute(path) && !find_path(folder_, to_uri(within + path), budget_.limits().allowed_paths);
  return name + (is_outside ? ": leads out of the model's folder (--allow-path PATH permits more)"
                            : ": not found in the model's folder");
}

FileBytes ModelFolder::open(const std::string& path) const {
  return open_found(folder_, path, budget_.limits().allowed_paths, budget_.limits().memory);
}

int ModelFolder::image(const std::string& within, const std::string& name) {
  constexpr std::size_t max_missing = 1000;
  const auto [known, is_first] = known_.try_emplace({within, name}, -1);
  if (!is_first) return known->second;
  constexpr std::uint64_t of_the_tables = 256;
  budget_.check_time();  // because the file search below takes time
  budget_.take(of_the_tables + 2 * name.size());
  const std::optional<std::string> path = missing_ < max_missing ? find_file(within, name) : std::nullopt;
  const auto [entry, is_new] = images_.try_emplace(path.value_or("missing " + name), -1);
  const bool is_missing = is_new && !path;
  if (is_new && missing_ < max_missing) entry->second = load(within, name, path);
  if (is_missing && ++missing_ == max_missing) warn(budget_.file() + ": no more textures are looked for");
  return known->second = entry->second;
}

void ModelFolder::warn(std::string text) {
  constexpr std::size_t max_notes = 2000;
  if (++notes_ > max_notes) return;
  budget_.take(text.size());
  scene_.warnings.push_back(notes_ < max_notes ? std::move(text)
                                               : budget_.file() + ": more of this kind is not listed");
}

/// Adds the image that `make` returns to the scene. Returns its index, or -1 with a warning if `make` fails.
template <class Make>
int ModelFolder::add(Make make) {
  try {
    scene_.images.push_back(make());
    return static_cast<int>(scene_.images.size()) - 1;
  } catch (const Error& error) {
    // Exceeding the memory budget or the deadline is an error nevertheless.
    budget_.take(0);
    budget_.check_time();
    if (budget_.limits().is_strict)
      throw Error(error.kind(), fmt::format("{}: texture {}", budget_.file(), error.what()));
    warn(fmt::format("{}: texture {}", budget_.file(), error.what()));
    return -1;
  }
}

TextureImage ModelFolder::decode(const std::string& name, std::span<const std::uint8_t> bytes) {
  const std::uint64_t working = image_working_memory(bytes);
  budget_.take(name.size() + 2 * sizeof(TextureImage));
  budget_.take(working + decoded_image_memory(bytes));
  DecodedImage decoded = decode_image(bytes, name, budget_.limits());
  budget_.give_back(working);
  if (!decoded.flaw.empty()) warn(fmt::format("{}: texture {}", budget_.file(), decoded.flaw));
  TextureImage image{name, std::move(decoded.texels)};
  if (const auto warning = size_warning(image)) scene_.warnings.push_back(budget_.file() + ": " + *warning);
  return image;
}

int ModelFolder::load(const std::string& within, const std::string& name, const std::optional<std::string>& path) {
  return add([&] {
    if (!path) throw Error(ErrorKind::Input, missing_text(within, name));
    const FileBytes file = open(*path);
    return decode(name, file.bytes());
  });
}

int ModelFolder::embed(std::span<const std::string> names, std::span<const std::uint8_t> bytes) {
  const int number = add([&] { return decode(names.front(), bytes); });
  for (const std::string& name : names) images_["missing " + name] = number;
  return number;
}

int ModelFolder::embed(std::span<const std::string> names, Rgba8Image pixels) {
  const int number = add([&] { return TextureImage{names.front(), std::move(pixels)}; });
  for (const std::string& name : names) images_["missing " + name] = number;
  return number;
}

Material plain_material(const std::string& name) {
  Material material;
  material.name = name;
  material.is_default = true;
  material.model = ShadingModel::BlinnPhong;
  material.double_sided = true;
  material.base_color = {0.8f, 0.8f, 0.8f, 1};
  material.ambient = {0.8f, 0.8f, 0.8f};
  return material;
}

}  // namespace zoneplate
