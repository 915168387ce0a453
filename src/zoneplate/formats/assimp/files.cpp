// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/assimp/files.h"

#if __has_include(<assimp/cfileio.h>)
#include <algorithm>
#include <cstring>
#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/gltf/gltf.h"

namespace zoneplate {

/// An open file. It contains assimp's record of it, whose user data points back to this object.
struct AssimpFiles::Open {
  aiFile file{};
  std::span<const std::uint8_t> bytes;
  std::size_t at = 0;

  explicit Open(std::span<const std::uint8_t> all) : bytes(all) {
    file.ReadProc = [](aiFile* f, char* out, std::size_t size, std::size_t count) {
      return of(f).read(out, size, count);
    };
    file.WriteProc = [](aiFile*, const char*, std::size_t, std::size_t) { return std::size_t{0}; };
    file.TellProc = [](aiFile* f) { return of(f).at; };
    file.FileSizeProc = [](aiFile* f) { return of(f).bytes.size(); };
    file.SeekProc = [](aiFile* f, std::size_t offset, aiOrigin origin) { return of(f).seek(offset, origin); };
    file.FlushProc = [](aiFile*) {};
    file.UserData = reinterpret_cast<char*>(this);
  }
  static Open& of(aiFile* f) { return *reinterpret_cast<Open*>(f->UserData); }

  /// Reads whole items, as fread does; returns their number.
  std::size_t read(char* out, std::size_t size, std::size_t count) {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes.size() - at) / size);
    std::memcpy(out, bytes.data() + at, whole * size);
    at += whole * size;
    return whole;
  }
  aiReturn seek(std::size_t offset, aiOrigin origin) {
    const std::size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at : bytes.size();
    // A negative offset is a large unsigned number; the sum wraps around to the intended one.
    const std::size_t to = from + offset;
    if (to > bytes.size()) return aiReturn_FAILURE;
    at = to;
    return aiReturn_SUCCESS;
  }
};

AssimpFiles::AssimpFiles(const std::string& path, const std::string& folder, std::string_view extension,
                         ImportBudget& budget)
    : folder_(folder),
      budget_(budget),
      finder_(folder, budget.limits().allowed_paths),
      model_(path, budget.limits().memory) {
  const bool is_binary_gltf_1 = extension == ".gltf" && is_binary_gltf(model_.bytes());
  model_name_ = (std::filesystem::path(folder) / (path == "-" ? "object" : std::filesystem::path(path).stem().string()))
                    .string() +
                std::string(is_binary_gltf_1 ? ".glb" : extension);
  io_.OpenProc = open;
  io_.CloseProc = close;
  io_.UserData = reinterpret_cast<char*>(this);
}

aiFile* AssimpFiles::open(aiFileIO* io, const char* name, const char* mode) {
  if (std::strpbrk(mode, "wa+") != nullptr) return nullptr;
  auto* const files = reinterpret_cast<AssimpFiles*>(io->UserData);
  return files->error_.guarded<aiFile*>(nullptr, [&] { return files->open(std::string(name)); });
}

aiFile* AssimpFiles::open(const std::string& name) {
  if (name == model_name_) return &(new Open(model_.bytes()))->file;
  try {
    // assimp passes names that include the folder; the finder checks where they lead after symbolic links.
    std::string uri;
    for (const char c : std::filesystem::absolute(name).string())
      uri += c == '%' ? std::string("%25") : std::string(1, c);
    const auto path = finder_.find(uri);
    if (!path || is_stream(*path)) return nullptr;
    others_.push_back(open_found(folder_, *path, budget_.limits().allowed_paths, budget_.limits().memory));
    return &(new Open(others_.back().bytes()))->file;
  } catch (const Error&) {
    return nullptr;
  }
}

void AssimpFiles::close(aiFileIO*, aiFile* file) { delete &Open::of(file); }

}  // namespace zoneplate
#endif
