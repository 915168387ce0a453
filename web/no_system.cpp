// SPDX-License-Identifier: Apache-2.0
// What readers need of an operating system, in a module of WebAssembly: it has neither mapped files nor child
// processes.
#include "no_system.h"

#include <fmt/format.h>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/assimp/assimp.h"
#include "zoneplate/formats/gltf/draco.h"
#include "zoneplate/job/render_streamed.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/limited_child.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/raster/parts/rasterize_parts.h"

namespace zoneplate {

void refuse(const std::string& place, std::string_view what) {
  throw Error(ErrorKind::Input, fmt::format("{}: {} the program, not by {}", place, what, this_door));
}

DracoMesh decode_draco(std::span<const std::uint8_t>, std::uint64_t, std::span<const DracoWish>,
                       const std::string& place, ImportBudget&) {
  refuse(place, "meshes packed by Draco are read by");
}

std::span<const SceneFormat> assimp_formats() { return {}; }
Scene load_by_assimp(const std::string& path, std::string_view, ImportBudget&) {
  refuse(path, "models of this format are read by");
}

void check_is_file(const std::string&) {}
void read_parts(const std::string& path, const std::function<bool(std::span<const std::uint8_t>)>& take) {
  const FileBytes file(path);
  take(file.bytes());
}

// Files are not mapped, and there are no child processes: the module has a memory of its own.
MappedFileWatch::MappedFileWatch() : before_(0) {}
void MappedFileWatch::check(const std::string&) const {}

bool is_limited_child() { return true; }
void ChildAnswer::write(const void*, std::size_t) {}
LimitedChild::LimitedChild(std::string place, Limits, const std::function<void(ChildAnswer&)>&,
                           const std::function<void()>&) {
  refuse(place, "child processes are started by");
}
LimitedChild::~LimitedChild() = default;
void LimitedChild::read(void*, std::size_t) {}

std::unique_ptr<FileStream> open_streamed(const Job&, const Request&) { return nullptr; }
void render_streamed(Job job, std::unique_ptr<Resolver>, std::unique_ptr<FileStream>, JobSink&, Summary&) {
  refuse(job.input, "files are read in parts by");
}

RasterCounts rasterize_parts(std::span<const Draw>, const FragmentShader&, const RasterRules&, const Target&,
                             RasterMemory&, Ranks&, HeldPixels&, PartTimes&) {
  refuse("parts of an image", "several processes are those of");
}

}  // namespace zoneplate
