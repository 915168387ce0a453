// SPDX-License-Identifier: Apache-2.0
// A fuzz target of libFuzzer: bytes that pretend to be a model of the format that the build names.
//
// Whatever they are, reading them ends with a sound scene or with zoneplate::Error of one line; the sanitizers watch
// the way there.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/formats/gltf/stream/stream.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/formats/obj/mtl.h"
#include "zoneplate/formats/obj/stream.h"
#include "zoneplate/formats/ply/stream.h"
#include "zoneplate/formats/stl/stream.h"
#include "zoneplate/scene/stream/stream_outline.h"
#include "zoneplate/scene/validate.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::string_view format = ZONEPLATE_FUZZ_FORMAT;
constexpr LoadLimits limits{.memory = 1 << 26, .pixels = 1 << 20, .seconds = 5};

/// The name of a file in memory that holds the bytes.
std::string file_of(const Bytes& bytes) {
  static const int number = ::memfd_create("fuzz", 0);
  const auto size = static_cast<ssize_t>(bytes.size());
  if (::ftruncate(number, size) != 0 || ::pwrite(number, bytes.data(), bytes.size(), 0) != size) std::abort();
  return "/proc/self/fd/" + std::to_string(number);
}

void check(const Scene& scene) {
  const auto flaw = find_invalid(scene);
  if (!flaw) return;
  std::fprintf(stderr, "the scene is not sound: %s\n", flaw->c_str());
  std::abort();
}

/// JSON, a zero, and the binary chunk become a GLB, so that parts may change their lengths; what is a GLB stays one.
Bytes glb_of(const Bytes& bytes) {
  constexpr std::string_view magic = "glTF";
  if (std::equal(magic.begin(), magic.end(), bytes.begin(),
                 bytes.begin() + std::min<std::ptrdiff_t>(4, std::ssize(bytes))))
    return bytes;
  const auto zero = std::find(bytes.begin(), bytes.end(), 0);
  return GltfMaker::glb({bytes.begin(), zero}, {zero == bytes.end() ? zero : zero + 1, bytes.end()});
}

std::unique_ptr<FileStream> open_stream(const std::string& file) {
  return format == "gltf"  ? open_gltf_stream(file, limits)
         : format == "obj" ? open_obj_stream(file, limits)
         : format == "ply" ? open_ply_stream(file, limits)
                           : open_stl_stream(file, limits);
}

/// Reads some triangles of a file that may be read in parts.
void read_parts_of(const std::string& file) {
  constexpr std::size_t max_triangles = 1 << 20;
  const std::unique_ptr<FileStream> stream = open_stream(file);
  if (!stream || stream->count() > max_triangles) return;
  stream->check();
  const StreamOutline outline(*stream, file, {});
  Scene scene = stream->head();
  std::vector<Mesh> meshes;
  std::size_t t = 0;
  for (const StreamInstance& instance : stream->instances()) {
    std::vector<std::uint32_t> some;
    for (; t < instance.end; t += 3) some.push_back(static_cast<std::uint32_t>(t));
    Instance& own = scene.instances[meshes.size()];
    Mesh mesh = some.empty() ? Mesh() : stream->mesh(some);
    mesh.material = scene.meshes[static_cast<std::size_t>(own.mesh)].material;
    own.mesh = static_cast<int>(meshes.size());
    meshes.push_back(std::move(mesh));
  }
  scene.meshes = std::move(meshes);
  check(scene);
}

/// The same of a file that cannot be read so, or is not sound: the loader may read it.
void try_parts_of(const std::string& file) {
  try {
    read_parts_of(file);
  } catch (const Error&) {
  }
}

void read(const Bytes& bytes) {
  if (format == "gltf") {
    const std::string file = file_of(glb_of(bytes));
    try_parts_of(file);
    GltfModel model(file, limits);
    const Scene scene = model.scene({});
    check(scene);
    if (!scene.animations.empty()) check(model.scene({.animation = SceneChoice::all_animations, .time = 0.4}));
    for (const std::string& variant : scene.variants) check(model.scene({.variant = variant}));
  } else if (format == "mtl") {
    Scene scene;
    parse_mtl({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "file", scene.warnings);
    check(scene);
  } else {
    const std::string file = file_of(bytes);
    if (format == "ply" || format == "stl" || format == "obj") try_parts_of(file);
    check(load_scene(file, {.limits = limits, .format = std::string(format)}));
  }
}

}  // namespace
}  // namespace zoneplate

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    zoneplate::read({data, data + size});
  } catch (const zoneplate::Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
