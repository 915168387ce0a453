// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/open_stream.h"

#include <filesystem>

#include "zoneplate/base/lower_case.h"
#include "zoneplate/formats/gltf/stream/stream.h"
#include "zoneplate/formats/obj/stream.h"
#include "zoneplate/formats/ply/stream.h"
#include "zoneplate/formats/stl/stream.h"

namespace zoneplate {

namespace {

std::unique_ptr<FileStream> open_large_gltf(const std::string& name, const LoadOptions& options) {
  if (!gltf_may_exceed_memory(name, options.limits, options.choice)) return nullptr;
  return open_gltf_stream(name, options.limits, options.choice);
}

}  // namespace

std::unique_ptr<FileStream> open_large_file(const std::string& name, const LoadOptions& options) {
  const bool has_format = !options.format.empty();
  // A file that a child process has to read is not mapped here.
  if (name == "-" || options.is_sandboxed || (!has_format && is_builtin_scene(name))) return nullptr;
  const std::string extension =
      lower_case(has_format ? options.format : std::filesystem::path(name).extension().string());
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(name, ignored)) return nullptr;
  const std::uint64_t size = std::filesystem::file_size(name, ignored);
  std::unique_ptr<FileStream> stream;
  if (extension.ends_with("gltf")) {
    // What is large are its buffers, in other files.
    constexpr std::uint64_t most = 1 << 24;
    if (size == 0 || size > most) return nullptr;
    stream = open_large_gltf(name, options);
  } else if (size <= options.limits.memory / 32) {  // no scene takes more than 32 times the bytes of its file
    return nullptr;
  } else if (extension.ends_with("glb") || extension.ends_with("vrm")) {
    stream = open_large_gltf(name, options);
  } else if (extension.ends_with("obj")) {
    if (obj_may_exceed_memory(name, options.limits)) stream = open_obj_stream(name, options.limits);
  } else if (extension.ends_with("stl")) {
    if (stl_may_exceed_memory(name, options.limits)) stream = open_stl_stream(name, options.limits);
  } else if (extension.ends_with("ply")) {
    if (ply_may_exceed_memory(name, options.limits)) stream = open_ply_stream(name, options.limits);
  }
  if (!stream) return nullptr;
  return stream->bytes_to_draw() <= options.limits.memory ? nullptr : std::move(stream);
}

}  // namespace zoneplate
