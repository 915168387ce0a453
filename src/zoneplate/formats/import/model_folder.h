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
#include "zoneplate/formats/import/model_path.h"
#include "zoneplate/os/file.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The files that accompany a model: material libraries and images, found and opened within its folder.
class ModelFolder {
 public:
  /// `folder` is the folder of the model. No file outside it is opened, except those that the limits allow.
  ModelFolder(std::string folder, ImportBudget& budget, Scene& scene)
      : folder_(std::move(folder)), budget_(budget), scene_(scene), finder_(folder_, budget.limits().allowed_paths) {}

  /// Finds a file by the name that a material library states, relative to the folder `within`, itself relative to the
  /// model's folder ("" or "sub/").
  ///
  /// Backslashes are slashes. If that file is missing or outside the folder, the last component of its name is searched
  /// in the model's folder, because models often contain paths of the machine that wrote them. After that all of these
  /// are searched in another case (PathFinder).
  std::optional<std::string> find_file(const std::string& within, std::string_view name);

  /// The message about a file that find_file does not find: "a.png: not found in the model's folder", with a hint where
  /// it lies outside.
  std::string missing_text(const std::string& within, const std::string& name) const;

  /// The contents of a file that find_file found.
  FileBytes open(const std::string& path) const;

  /// The index of an image in Scene::images, which is loaded at its first use; -1, with a warning, if it cannot be
  /// loaded. The search ends after 1000 missing images.
  int image(const std::string& within, const std::string& name);

  /// Adds an image that is embedded in the model's file. image() finds it by any of the names unless there is a file of
  /// that name. Returns its index in Scene::images; -1, with a warning, if it cannot be decoded.
  int embed(std::span<const std::string> names, std::span<const std::uint8_t> bytes);
  int embed(std::span<const std::string> names, Rgba8Image pixels);

  /// Adds a warning about ignored content. Only the first 2000 are kept.
  void warn(std::string text);

  ImportBudget& budget() { return budget_; }
  Scene& scene() { return scene_; }

 private:
  int load(const std::string& within, const std::string& name, const std::optional<std::string>& path);
  TextureImage decode(const std::string& name, std::span<const std::uint8_t> bytes);
  template <class Make>
  int add(Make make);

  std::string folder_;
  ImportBudget& budget_;
  Scene& scene_;
  PathFinder finder_;
  std::map<std::string, int> images_;                         ///< index by path, or by name if there is no file
  std::map<std::pair<std::string, std::string>, int> known_;  ///< index by the arguments of image(): `within` and name
  std::size_t missing_ = 0, notes_ = 0;
};

/// The material of surfaces that have none: light grey, without highlights.
Material plain_material(const std::string& name);

}  // namespace zoneplate
