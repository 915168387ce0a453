// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/assimp/assimp.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <new>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/assimp/files.h"
#include "zoneplate/formats/assimp/scene.h"
#include "zoneplate/formats/import/import_child.h"
#include "zoneplate/formats/import/scene_bytes.h"
#include "zoneplate/os/library.h"
#include "zoneplate/os/limited_child.h"
#include "zoneplate/scene/geometry/origin.h"
#include "zoneplate/scene/validate.h"

#if __has_include(<assimp/cimport.h>)
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#endif

namespace zoneplate {
namespace {

constexpr SceneFormat formats[] = {{".fbx", "Autodesk FBX"},       {".dae", "COLLADA"},
                                   {".3ds", "3D Studio"},          {".x", "DirectX X"},
                                   {".off", "Object File Format"}, {".lwo", "LightWave object"},
                                   {".ase", "3D Studio ASE"},      {".ac", "AC3D"},
                                   {".blend", "Blender, to 2.7"},  {".dxf", "Drawing Interchange"},
                                   {".ms3d", "MilkShape 3D"},      {".md2", "Quake II"},
                                   {".md3", "Quake III"},          {".md5mesh", "Doom 3"},
                                   {".b3d", "BlitzBasic 3D"},      {".iqm", "Inter-Quake Model"},
                                   {".smd", "Valve SMD"},          {".x3d", "X3D"},
                                   {".cob", "TrueSpace"},          {".nff", "Neutral File Format"}};

#if __has_include(<assimp/cimport.h>)

/// The functions of the library that this file calls.
struct AssimpLibrary {
  SharedLibrary library;
  decltype(&aiImportFileEx) import = library.find("aiImportFileEx");
  decltype(&aiReleaseImport) release = library.find("aiReleaseImport");
  decltype(&aiGetErrorString) error = library.find("aiGetErrorString");

  explicit AssimpLibrary(const std::string& file) : library(Library::Assimp, file) {}
};

/// Joins the lines of the library's error message, and limits its length.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return text.substr(0, 400);
}

/// What the polygons of an X3D file are. assimp gives the polylines of line sets as polygons: they are polylines if the
/// file has no other shapes, and stay polygons if it has, with a warning.
Polygons polygons_of_x3d(std::span<const std::uint8_t> bytes, ModelFolder& folder) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.find("LineSet") == text.npos) return Polygons::Filled;
  constexpr std::string_view surfaces[] = {"FaceSet", "TriangleSet",   "TriangleFanSet", "TriangleStripSet",
                                           "QuadSet", "ElevationGrid", "Extrusion",      "<Box",
                                           "<Cone",   "<Cylinder",     "<Sphere",        "2D"};
  const bool has_surfaces = std::any_of(std::begin(surfaces), std::end(surfaces),
                                        [&](std::string_view name) { return text.find(name) != text.npos; });
  if (has_surfaces)
    folder.warn(folder.budget().file() +
                ": line sets beside surfaces are drawn as polygons, as assimp hands them over");
  return has_surfaces ? Polygons::Filled : Polygons::Polylines;
}

Scene import(const AssimpLibrary& library, const std::string& path, std::string_view extension, ImportBudget& budget) {
  const std::string folder = path == "-" ? "." : std::filesystem::path(path).parent_path().string();
  AssimpFiles files(path, folder, extension, budget);
  // The transforms of FBX are not those that assimp applies: they are about the origin and in degrees.
  const unsigned transforms = extension == ".fbx" ? 0u : unsigned{aiProcess_TransformUVCoords};
  const unsigned steps = aiProcess_GenUVCoords | aiProcess_JoinIdenticalVertices | transforms;
  const std::unique_ptr<const aiScene, decltype(library.release)> read(
      library.import(files.model_name().c_str(), steps, files.io()), library.release);
  files.rethrow();
  if (!read && std::string_view(library.error()).find("bad_alloc") != std::string_view::npos) throw std::bad_alloc();
  const std::string place = budget.file() + (extension == ".gltf" ? ": glTF 1.0: " : ": ");
  if (!read) throw Error(ErrorKind::Input, place + one_line(library.error()));
  Scene scene;
  ModelFolder textures(folder, budget, scene);
  const Polygons polygons = extension == ".x3d" ? polygons_of_x3d(files.model(), textures) : Polygons::Filled;
  convert_assimp_scene(*read, extension, polygons, textures);
  if (scene.instances.empty()) throw Error(ErrorKind::Input, place + "holds nothing to draw");
  if (const auto flaw = find_invalid(scene)) throw Error(ErrorKind::Input, place + *flaw);
  center_far_scene(scene);
  return scene;
}

#else

struct AssimpLibrary {
  explicit AssimpLibrary(const std::string& file) {
    throw Error(ErrorKind::Input, file + ": needs the library assimp, which this program was built without");
  }
};
Scene import(const AssimpLibrary&, const std::string&, std::string_view, ImportBudget&) { return {}; }

#endif

}  // namespace

std::span<const SceneFormat> assimp_formats() { return formats; }

Scene load_by_assimp(const std::string& path, std::string_view extension, ImportBudget& budget) {
  if (is_limited_child()) return import(AssimpLibrary(budget.file()), path, extension, budget);
  std::optional<AssimpLibrary> library;
  LimitedChild child(
      budget.file(), child_limits(budget),
      [&](ChildAnswer& answer) {
        const Scene scene = import(*library, path, extension, budget);
        write_scene(scene, [&](const void* data, std::size_t size) { answer.write(data, size); });
      },
      [&] {
        library.emplace(budget.file());
        open_library(Library::OpenExr);
      });
  return read_scene([&](void* out, std::size_t size) { child.read(out, size); }, budget);
}

}  // namespace zoneplate
