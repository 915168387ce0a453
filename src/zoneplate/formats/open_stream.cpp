// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/open_stream.h"

#include <filesystem>

#include "zoneplate/base/lower_case.h"
#include "zoneplate/formats/ply/stream.h"
#include "zoneplate/formats/stl/stream.h"

namespace zoneplate {

std::unique_ptr<FileStream> open_large_file(const std::string& name, const LoadOptions& options) {
  const bool has_format = !options.format.empty();
  // A file that a child process has to read is not mapped here.
  if (name == "-" || options.is_sandboxed || (!has_format && is_builtin_scene(name))) return nullptr;
  const std::string extension =
      lower_case(has_format ? options.format : std::filesystem::path(name).extension().string());
  const bool is_stl = extension.ends_with("stl"), is_ply = extension.ends_with("ply");
  if (!is_stl && !is_ply) return nullptr;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(name, ignored)) return nullptr;
  // No scene takes more than 32 times the bytes of its file.
  if (std::filesystem::file_size(name, ignored) <= options.limits.memory / 32) return nullptr;
  std::unique_ptr<FileStream> stream =
      is_stl ? open_stl_stream(name, options.limits) : open_ply_stream(name, options.limits);
  if (!stream) return nullptr;
  return stream->bytes_to_draw() <= options.limits.memory ? nullptr : std::move(stream);
}

}  // namespace zoneplate
