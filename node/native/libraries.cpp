// SPDX-License-Identifier: Apache-2.0
// What the readers need of an operating system and of libraries that the package does not contain.
#include <meshoptimizer.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/system/in_child.h"
#include "zoneplate/formats/assimp/assimp.h"
#include "zoneplate/formats/gltf/draco.h"
#include "zoneplate/formats/import/scene_bytes.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/library.h"
#include "zoneplate/os/limited_child.h"
#include "zoneplate/os/mapped_file_guard.h"

namespace zoneplate {
namespace {

[[noreturn]] void refuse(const std::string& place, std::string_view what) {
  throw Error(ErrorKind::Input, place + ": " + std::string(what) + " the program zoneplate, not by this package");
}

/// What needs a library, in the order of Library.
constexpr std::string_view contents[] = {"models of this format are read by",    "AVIF images are read by",
                                         "JPEG XL images are read by",           "",
                                         "OpenEXR images are read by",           "TIFF images are read by",
                                         "data packed by Zstandard are read by", "colour profiles are read by"};

}  // namespace

bool open_library(Library library) { return library == Library::Meshoptimizer; }

SharedLibrary::SharedLibrary(Library library, const std::string& place) : library_(library), place_(place) {
  if (library != Library::Meshoptimizer) refuse(place, contents[static_cast<std::size_t>(library)]);
}

SharedLibrary::Found SharedLibrary::find(const char* symbol) const {
  using Decoder = int (*)(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
  using Filter = void (*)(void*, std::size_t, std::size_t);
  using AnyFunction = void (*)();
  const auto decoder = [](Decoder function) { return reinterpret_cast<AnyFunction>(function); };
  const auto filter = [](Filter function) { return reinterpret_cast<AnyFunction>(function); };
  const std::pair<std::string_view, AnyFunction> functions[] = {
      {"meshopt_decodeVertexBuffer", decoder(meshopt_decodeVertexBuffer)},
      {"meshopt_decodeIndexBuffer", decoder(meshopt_decodeIndexBuffer)},
      {"meshopt_decodeIndexSequence", decoder(meshopt_decodeIndexSequence)},
      {"meshopt_decodeFilterOct", filter(meshopt_decodeFilterOct)},
      {"meshopt_decodeFilterQuat", filter(meshopt_decodeFilterQuat)},
      {"meshopt_decodeFilterExp", filter(meshopt_decodeFilterExp)}};
  const auto* const found = std::ranges::find_if(functions, [&](const auto& f) { return f.first == symbol; });
  return Found(found == std::end(functions) ? nullptr : found->second);
}

StoredImage decode_in_child(const std::string& place, Library library, std::uint64_t, std::uint64_t,
                            const std::function<StoredImage()>& decode) {
  const SharedLibrary open(library, place);
  return decode();
}

DracoMesh decode_draco(std::span<const std::uint8_t>, std::uint64_t, std::span<const DracoWish>,
                       const std::string& place, ImportBudget&) {
  refuse(place, "meshes packed by Draco are read by");
}

std::span<const SceneFormat> assimp_formats() { return {}; }
Scene load_by_assimp(const std::string& path, std::string_view, ImportBudget&) {
  refuse(path, contents[static_cast<std::size_t>(Library::Assimp)]);
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

}  // namespace zoneplate
