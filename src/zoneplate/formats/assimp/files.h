// SPDX-License-Identifier: Apache-2.0
#pragma once

#if __has_include(<assimp/cfileio.h>)
#include <assimp/cfileio.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/callback_error.h"
#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/formats/import/model_path.h"
#include "zoneplate/os/file.h"

namespace zoneplate {

/// The files that assimp may open for reading: the model, and the files in its folder or in LoadLimits::allowed_paths.
class AssimpFiles {
 public:
  AssimpFiles(const std::string& path, const std::string& folder, std::string_view extension, ImportBudget& budget);

  /// The name that assimp gets for the model. Its extension selects the format.
  const std::string& model_name() const { return model_name_; }
  std::span<const std::uint8_t> model() const { return model_.bytes(); }
  aiFileIO* io() { return &io_; }
  /// Throws the exception that a callback kept; called after assimp has returned.
  void rethrow() { error_.rethrow(); }

 private:
  static aiFile* open(aiFileIO* io, const char* name, const char* mode);
  static void close(aiFileIO* io, aiFile* file);
  aiFile* open(const std::string& name);

  struct Open;
  std::string folder_, model_name_;
  ImportBudget& budget_;
  PathFinder finder_;
  FileBytes model_;
  std::vector<FileBytes> others_;
  aiFileIO io_{};
  CallbackError error_;
};

}  // namespace zoneplate
#endif
