// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/os/file.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The files about a model: its material libraries and images, found and opened within its folder.
class ModelFolder {
 public:
  /// `folder` is that of the model; nothing outside it is opened unless the limits allow it.
  ModelFolder(std::string folder, ImportBudget& budget, Scene& scene)
      : folder_(std::move(folder)), budget_(budget), scene_(scene) {}

  /// The file of that name as a material library writes it, seen from the folder `within` the model's ("" or "sub/").
  ///
  /// Backslashes are slashes. A name that leads elsewhere or to nothing is looked for in the model's folder by its
  /// last part, as models keep the paths of the machine that wrote them.
  std::optional<std::string> find_file(const std::string& within, std::string_view name) const;

  /// The bytes of a file that find_file found.
  FileBytes open(const std::string& path) const;

  /// The number of the image in Scene::images, which is loaded at its first use; -1, with a warning, if there is none.
  /// Of very many that are not there only the first are looked for.
  int image(const std::string& within, const std::string& name);

  /// An image that the model's file holds: it is found by any of the names, where there is no file of that name.
  void embed(std::span<const std::string> names, std::span<const std::uint8_t> bytes);
  void embed(std::span<const std::string> names, Rgba8Image pixels);

  /// Adds a warning about ignored content; of very many only the first.
  void warn(std::string text);

  ImportBudget& budget() { return budget_; }
  Scene& scene() { return scene_; }

 private:
  int load(const std::string& name, const std::optional<std::string>& path);
  TextureImage decode(const std::string& name, std::span<const std::uint8_t> bytes);
  template <class Make>
  int add(Make make);

  std::string folder_;
  ImportBudget& budget_;
  Scene& scene_;
  std::map<std::string, int> images_;                         ///< by path, or by name where there is no file
  std::map<std::pair<std::string, std::string>, int> known_;  ///< by the arguments of image(): `within` and name
  std::size_t missing_ = 0, notes_ = 0;
};

/// The material of surfaces without one: light grey, without highlights.
Material plain_material(const std::string& name);

}  // namespace zoneplate
