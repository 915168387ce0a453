// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/assimp/assimp.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/formats/import/mesh_samples_for_test.h"
#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate {
namespace {

using mesh_samples::Bytes;
using mesh_samples::bytes_of;

// Checks for the file of the library, because only child processes may open the library itself.
bool has_library() { return std::filesystem::exists("/usr/lib/x86_64-linux-gnu/libassimp.so.5"); }

Scene load(const Bytes& bytes, const char* format) {
  const MemoryFile file;
  return load_scene(file.write(bytes), {.limits = {}, .format = format, .choice = {}});
}

/// A concave L of three unit squares, one face with six corners.
const char* const off = "OFF\n6 1 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n6 0 1 2 3 4 5\n";

/// A red square of side 2 on the ground of a z-up world, translated to x = 5.
const char* const dae =
    R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Z_UP</up_axis></asset>
<library_images><image id="i"><init_from>skin.png</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON>
<newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam>
<technique sid="c"><lambert>
<diffuse><texture texture="t" texcoord="UV"/></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="skin"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">-1 -1 0 1 -1 0 1 1 0 -1 1 0</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<source id="u"><float_array id="ua" count="8">0 0 1 0 1 1 0 1</float_array><technique_common>
<accessor source="#ua" count="4" stride="2"><param name="S" type="float"/><param name="T" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1" material="M"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="TEXCOORD" source="#u" offset="1" set="0"/>
<vcount>4</vcount><p>0 0 1 1 2 2 3 3</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node id="n" name="tile"><translate>5 0 0</translate>
<instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="M" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>
)";

/// A textured triangle of FBX, whose DiffuseColor the texture replaces.
const char* const fbx = R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {
FBXVersion: 7300
}
GlobalSettings:  {
}
Objects:  {
Geometry: 1, "Geometry::", "Mesh" {
Vertices: *9 {
a: -1,-1,0,1,-1,0,0,1,0
}
PolygonVertexIndex: *3 {
a: 0,1,-3
}
LayerElementUV: 0 {
MappingInformationType: "ByPolygonVertex"
ReferenceInformationType: "Direct"
UV: *6 {
a: 0,0,1,0,0,1
}
}
LayerElementMaterial: 0 {
MappingInformationType: "AllSame"
ReferenceInformationType: "IndexToDirect"
Materials: *1 {
a: 0
}
}
Layer: 0 {
LayerElement:  {
Type: "LayerElementUV"
TypedIndex: 0
}
LayerElement:  {
Type: "LayerElementMaterial"
TypedIndex: 0
}
}
}
Model: 2, "Model::m", "Mesh" {
}
Material: 3, "Material::m", "" {
ShadingModel: "phong"
Properties70:  {
P: "DiffuseColor", "Color", "", "A",0.8,0.8,0.8
}
}
Texture: 4, "Texture::t", "" {
FileName: "tex.png"
RelativeFilename: "tex.png"
}
}
Connections:  {
C: "OO",2,0
C: "OO",1,2
C: "OO",3,2
C: "OP",4,3, "DiffuseColor"
}
)";

/// A chunk of a 3DS file: its identifier, its length including these six bytes, its content.
Bytes chunk(std::uint16_t number, const Bytes& content) {
  Bytes out;
  mesh_samples::add<std::uint16_t>(out, number);
  mesh_samples::add<std::uint32_t>(out, static_cast<std::uint32_t>(content.size() + 6));
  out.insert(out.end(), content.begin(), content.end());
  return out;
}
Bytes joined(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Bytes triangle_3ds() {
  Bytes vertices, faces;
  mesh_samples::add<std::uint16_t>(vertices, 3);
  for (const float f : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}) mesh_samples::add<float>(vertices, f);
  mesh_samples::add<std::uint16_t>(faces, 1);
  for (const unsigned i : {0u, 1u, 2u, 0u}) mesh_samples::add(faces, static_cast<std::uint16_t>(i));
  const Bytes mesh = chunk(0x4100, joined(chunk(0x4110, vertices), chunk(0x4120, faces)));
  return chunk(0x4d4d, chunk(0x3d3d, chunk(0x4000, joined(Bytes{'a', 0}, mesh))));
}

double area_of(const Scene& s) {
  double area = 0;
  for (const Mesh& m : s.meshes)
    for (std::size_t k = 0; k + 3 <= m.index.size(); k += 3) {
      const float3 a = m.position[m.index[k]];
      area += length(cross(m.position[m.index[k + 1]] - a, m.position[m.index[k + 2]] - a)) / 2;
    }
  return area;
}

TEST(Assimp, CutsPolygonsRightly) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const Scene s = load(bytes_of(off), "off");
  expect_sound(s);
  ASSERT_EQ(s.meshes.size(), 1u);
  EXPECT_EQ(s.meshes[0].primitives(), 4u);
  EXPECT_EQ(area_of(s), 3);
  EXPECT_EQ(s.meshes[0].normal[0], (float3{0, 0, 1}));
  EXPECT_EQ(s.bounds().high, (float3{2, 2, 0}));
}

TEST(Assimp, ReadsNodesMaterialsAndTheTexturesBesideTheModel) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const TestFolder folder;
  folder.write("sub/skin.png", encode_png(Rgba8Image(2, 1, {200, 0, 0, 255})));
  const Scene s = load_scene(folder.write("sub/tile.dae", std::string(dae)));
  expect_sound(s);
  ASSERT_EQ(s.meshes.size(), 1u);
  EXPECT_EQ(area_of(s), 4);
  const Box box = s.bounds();
  EXPECT_NEAR(box.low.x, 4, 1e-6f);
  EXPECT_NEAR(box.high.x, 6, 1e-6f);
  EXPECT_NEAR(box.low.y, 0, 1e-6f);
  EXPECT_NEAR(box.high.y, 0, 1e-6f);
  EXPECT_NEAR(box.high.z, 1, 1e-6f);
  ASSERT_EQ(s.images.size(), 1u);
  EXPECT_EQ(s.images[0].pixels.as<Rgba8>()(1, 0), (Rgba8{200, 0, 0, 255}));
  EXPECT_EQ(s.materials[static_cast<std::size_t>(s.meshes[0].material)].base_color_texture.image, 0);
  EXPECT_TRUE(s.warnings.empty()) << s.warnings[0];
}

TEST(Assimp, MarksTheMaterialOfAFileThatDefinesNone) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  std::string text = dae;
  const auto cut = [&](std::string_view from, std::string_view to) {
    const std::size_t begin = text.find(from);
    text.erase(begin, text.find(to, begin) + to.size() - begin);
  };
  cut("<library_images>", "</library_materials>");
  cut("<bind_material>", "</bind_material>");
  EXPECT_TRUE(load(bytes_of(text.c_str()), "dae").materials.at(0).is_default);
}

TEST(Assimp, ModelsOfColladaWithoutHighlightsHaveNone) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const auto material_of = [](const std::string& model) {
    std::string text = dae;
    const std::size_t begin = text.find("<lambert>"), end = text.find("</lambert>") + 10;
    return load(bytes_of(text.replace(begin, end - begin, model).c_str()), "dae").materials.at(0);
  };
  const Material lambert = material_of("<lambert><diffuse><color>.8 .2 .2 1</color></diffuse></lambert>");
  EXPECT_EQ(lambert.specular, (float3{0, 0, 0}));
  EXPECT_EQ(lambert.base_color.x, decode_srgb(0.8f));
  const std::string red = "<phong><diffuse><color>.8 .2 .2 1</color></diffuse>";
  EXPECT_EQ(material_of(red + "</phong>").specular, (float3{0, 0, 0}));
  EXPECT_NE(material_of(red + "<specular><color>.5 .5 .5 1</color></specular></phong>").specular, (float3{0, 0, 0}));
  const Material constant = material_of("<constant><emission><color>.2 .8 .2 1</color></emission></constant>");
  EXPECT_EQ(constant.model, ShadingModel::Unlit);
  EXPECT_EQ(constant.base_color.y, decode_srgb(0.8f));
  EXPECT_EQ(constant.emissive, (float3{0, 0, 0}));
}

TEST(Assimp, DefaultMaterialsAreThatOfEveryFormat) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const Scene s = load(bytes_of(off), "off");
  EXPECT_TRUE(s.materials.at(0).is_default);
  EXPECT_EQ(s.materials.at(0).base_color, plain_material("").base_color);
}

TEST(Assimp, ATextureOfFbxReplacesTheDiffuseColour) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const TestFolder folder;
  folder.write("tex.png", encode_png(Rgba8Image(2, 1, {200, 0, 0, 255})));
  const Material m = load_scene(folder.write("a.fbx", std::string(fbx))).materials.at(0);
  EXPECT_EQ(m.base_color_texture.image, 0);
  EXPECT_EQ(m.base_color, (float4{1, 1, 1, 1}));
  EXPECT_FALSE(m.is_default);
}

/// The FBX file with more lines in its texture, and a second set of coordinates.
std::string fbx_with(const std::string& texture) {
  std::string text = fbx;
  const auto insert = [&](std::string_view behind, const std::string& lines) {
    text.insert(text.find(behind) + behind.size(), lines);
  };
  insert("RelativeFilename: \"tex.png\"\n", texture);
  insert("LayerElementUV: 0 {\n", "Name: \"first\"\n");
  insert("0,0,1,0,0,1\n}\n}\n",
         "LayerElementUV: 1 {\nName: \"second\"\nMappingInformationType: \"ByPolygonVertex\"\n"
         "ReferenceInformationType: \"Direct\"\nUV: *6 {\na: 0.5,0.25,0.75,0.25,0.5,0.5\n}\n}\n");
  insert("TypedIndex: 0\n}\n}\n", "Layer: 1 {\nLayerElement:  {\nType: \"LayerElementUV\"\nTypedIndex: 1\n}\n}\n");
  return text;
}

// A tiled floor must not be one stretched tile.
TEST(Assimp, TransformsCoordinatesOfFbx) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const TestFolder folder;
  folder.write("tex.png", encode_png(Rgba8Image(2, 1, {200, 0, 0, 255})));
  const auto use_of = [&](const char* properties) {
    const std::string text = fbx_with(std::string("Properties70:  {\n") + properties + "}\n");
    return load_scene(folder.write("a.fbx", text)).materials.at(0).base_color_texture;
  };
  const TextureUse plain = use_of("");
  EXPECT_EQ(plain.scale, (float2{1, 1}));
  EXPECT_EQ(plain.offset, (float2{0, 0}));
  const TextureUse tiled = use_of(
      "P: \"Scaling\", \"Vector\", \"\", \"A\",2,3,1\n"
      "P: \"Translation\", \"Vector\", \"\", \"A\",0.25,0.5,0\n");
  EXPECT_EQ(tiled.scale, (float2{2, 3}));
  EXPECT_EQ(tiled.offset, (float2{0.25f, -2.5f}));  // from the top: 1 - 3 - 0.5
  EXPECT_EQ(tiled.rotation, 0);
  EXPECT_NEAR(use_of("P: \"Rotation\", \"Vector\", \"\", \"A\",0,0,90\n").rotation, 1.5707963f, 1e-6f);
}

TEST(Assimp, UsesTheCoordinatesThatATextureNames) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const TestFolder folder;
  folder.write("tex.png", encode_png(Rgba8Image(2, 1, {200, 0, 0, 255})));
  const auto first_uv = [&](const char* texture) {
    const Scene s = load_scene(folder.write("a.fbx", fbx_with(texture)));
    EXPECT_TRUE(s.meshes.at(0).uv1.empty());
    return s.meshes.at(0).uv0.at(0);
  };
  EXPECT_EQ(first_uv(""), (float2{0, 1}));
  EXPECT_EQ(first_uv("Properties70:  {\nP: \"UVSet\", \"KString\", \"\", \"\", \"second\"\n}\n"),
            (float2{0.5f, 0.75f}));
}

/// A square of ASE, whose texture is transformed.
std::string ase_with(const std::string& transform) {
  return "*3DSMAX_ASCIIEXPORT 200\n*MATERIAL_LIST {\n*MATERIAL_COUNT 1\n*MATERIAL 0 {\n*MATERIAL_NAME \"m\"\n"
         "*MATERIAL_CLASS \"Standard\"\n*MAP_DIFFUSE {\n*MAP_AMOUNT 1.0\n*BITMAP \"tex.png\"\n" +
         transform +
         "}\n}\n}\n*GEOMOBJECT {\n*NODE_NAME \"t\"\n*NODE_TM {\n*NODE_NAME \"t\"\n*TM_ROW0 1.0 0.0 0.0\n"
         "*TM_ROW1 0.0 1.0 0.0\n*TM_ROW2 0.0 0.0 1.0\n*TM_ROW3 0.0 0.0 0.0\n}\n*MESH {\n*TIMEVALUE 0\n"
         "*MESH_NUMVERTEX 3\n*MESH_NUMFACES 1\n*MESH_VERTEX_LIST {\n*MESH_VERTEX 0 0.0 0.0 0.0\n"
         "*MESH_VERTEX 1 1.0 0.0 0.0\n*MESH_VERTEX 2 1.0 0.0 1.0\n}\n*MESH_FACE_LIST {\n"
         "*MESH_FACE 0: A: 0 B: 1 C: 2 AB: 1 BC: 1 CA: 0 *MESH_SMOOTHING 1 *MESH_MTLID 0\n}\n*MESH_NUMTVERTEX 3\n"
         "*MESH_TVERTLIST {\n*MESH_TVERT 0 0.0 0.0 0.0\n*MESH_TVERT 1 1.0 0.0 0.0\n*MESH_TVERT 2 1.0 1.0 0.0\n}\n"
         "*MESH_NUMTVFACES 1\n*MESH_TFACELIST {\n*MESH_TFACE 0 0 1 2\n}\n}\n*MATERIAL_REF 0\n}\n";
}

// 3D Studio Max scales and rotates about the centre.
TEST(Assimp, TransformsCoordinatesOfAse) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const TestFolder folder;
  folder.write("tex.png", encode_png(Rgba8Image(2, 1, {200, 0, 0, 255})));
  const auto first_uv = [&](const char* transform) {
    const Scene s = load_scene(folder.write("a.ase", ase_with(transform)));
    EXPECT_EQ(s.materials.at(0).base_color_texture.image, 0);
    const Mesh& mesh = s.meshes.at(0);
    for (std::size_t v = 0; v < mesh.position.size(); ++v)
      if (length(mesh.position[v]) < 1e-6f) return mesh.uv0.at(v);
    return float2{-99, -99};
  };
  const auto expect_near = [](float2 found, float2 expected) {
    EXPECT_NEAR(found.x, expected.x, 1e-5f);
    EXPECT_NEAR(found.y, expected.y, 1e-5f);
  };
  expect_near(first_uv(""), {0, 1});
  expect_near(first_uv("*UVW_U_TILING 2.0\n*UVW_V_TILING 3.0\n"), {-0.5f, 2});
  expect_near(first_uv("*UVW_ANGLE 1.5707963\n"), {1, 1});
  expect_near(first_uv("*UVW_U_OFFSET 0.25\n"), {0.25f, 1});
}

TEST(Assimp, LineSetsOfX3dAreLines) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const std::string lines =
      "<Shape><IndexedLineSet coordIndex=\"0 1 2 3 -1\"><Coordinate point=\"0 0 0 1 0 0 1 1 0 0 1 0\"/>"
      "</IndexedLineSet></Shape>";
  const std::string faces =
      "<Shape><IndexedFaceSet coordIndex=\"0 1 2 -1\"><Coordinate point=\"0 0 0 1 0 0 1 1 "
      "0\"/></IndexedFaceSet></Shape>";
  const auto scene = [](const std::string& shapes) {
    return load(bytes_of("<?xml version=\"1.0\"?><X3D version=\"3.0\"><Scene>" + shapes + "</Scene></X3D>"), "x3d");
  };
  const Scene polyline = scene(lines);
  ASSERT_EQ(polyline.meshes.size(), 1u);
  EXPECT_EQ(polyline.meshes[0].topology, Topology::Lines);
  EXPECT_EQ(polyline.meshes[0].primitives(), 3u);
  EXPECT_TRUE(polyline.warnings.empty());
  const Scene both = scene(lines + faces);
  ASSERT_EQ(both.warnings.size(), 1u);
  EXPECT_NE(both.warnings[0].find("line sets"), std::string::npos) << both.warnings[0];
  EXPECT_EQ(scene(faces).meshes.at(0).topology, Topology::Triangles);
}

TEST(Assimp, ReadsNothingOutsideTheModelsFolder) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const TestFolder folder;
  folder.write("skin.png", encode_png(Rgba8Image(2, 1, {200, 0, 0, 255})));
  std::string text = dae;
  text.replace(text.find("skin.png"), 8, "../skin.png");
  const std::string path = folder.write("sub/tile.dae", text);
  const Scene s = load_scene(path);
  EXPECT_TRUE(s.images.empty());
  ASSERT_EQ(s.warnings.size(), 1u);
  EXPECT_NE(s.warnings[0].find("leads out of the model's folder"), std::string::npos);
  EXPECT_EQ(load_scene(path, {.limits = {.allowed_paths = {"/"}}, .format = "", .choice = {}}).images.size(), 1u);
}

/// A red triangle of glTF 1.0, whose buffer is `buffer`.
std::string gltf_1(const std::string& version, const std::string& buffer) {
  return R"({"asset":{"version":)" + version +
         R"(},"scene":"s","scenes":{"s":{"nodes":["n"]}},"nodes":{"n":{"meshes":["m"]}},"meshes":{"m":{"primitives":[
      {"attributes":{"POSITION":"p"},"indices":"i","material":"r","mode":4}]}},"materials":{"r":{"values":{"diffuse":[1,0,0,1]}}},
      "accessors":{"p":{"bufferView":"v","byteOffset":0,"byteStride":12,"componentType":5126,"count":3,"type":"VEC3"},
      "i":{"bufferView":"w","byteOffset":0,"byteStride":0,"componentType":5123,"count":3,"type":"SCALAR"}},
      "bufferViews":{"v":{"buffer":"binary_glTF","byteOffset":0,"byteLength":36,"target":34962},
      "w":{"buffer":"binary_glTF","byteOffset":36,"byteLength":6,"target":34963}},
      "extensionsUsed":["KHR_binary_glTF"],"buffers":{"binary_glTF":{"byteLength":42,"type":"arraybuffer")" +
         buffer + "}}}";
}

// The first version of the format has other tables: assimp reads it.
TEST(Assimp, ReadsTheFirstVersionOfGltf) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  Bytes buffer;
  for (const float f : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}) mesh_samples::add<float>(buffer, f);
  for (const unsigned i : {0u, 1u, 2u}) mesh_samples::add(buffer, static_cast<std::uint16_t>(i));
  const TestFolder folder;
  folder.write("b.bin", buffer);
  const std::string uri = R"(,"uri":"b.bin")";
  std::string json = gltf_1("\"1.0\"", "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  Bytes glb = bytes_of("glTF");
  for (const std::size_t word : {std::size_t{1}, 20 + json.size() + buffer.size(), json.size(), std::size_t{0}})
    mesh_samples::add<std::uint32_t>(glb, static_cast<std::uint32_t>(word));
  glb = joined(joined(std::move(glb), bytes_of(json)), buffer);
  std::string profiled = gltf_1("\"1.0.1\"", uri);
  profiled.insert(profiled.find("\"version\""), R"("profile":{"api":"WebGL","version":"2.0"},)");
  for (const std::string& path :
       {folder.write("text.gltf", gltf_1("\"1.0\"", uri)), folder.write("NUMBER.glTF", gltf_1("1.0", uri)),
        folder.write("profile.gltf", profiled), folder.write("binary.GLB", glb), folder.write("binary.gltf", glb),
        folder.write("binary.unknown", glb)})
    for (const bool is_sandboxed : {false, true}) {
      const LoadOptions options{.limits = {.is_strict = true}, .is_sandboxed = is_sandboxed};
      SceneSource source(path, options);
      for (const Scene& s : {load_scene(path, options), source.load({})}) {
        EXPECT_EQ(area_of(s), 0.5) << path;
        EXPECT_EQ(s.materials.at(0).base_color, (float4{1, 0, 0, 1})) << path;
      }
    }
  try {
    load_scene(folder.write("bad.gltf", std::string(R"({"asset":{"version":"1.0"},"meshes":{"m":3}})")));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("bad.gltf: glTF 1.0: "), std::string::npos) << error.what();
  }
}

TEST(Load, KnowsGltfByItsContentsAndInAnyCase) {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}));
  const TestFolder folder;
  for (const char* name : {"a.GLB", "b.glTF", "c.vrm", "avatar", "d.bin"})
    EXPECT_EQ(area_of(load_scene(folder.write(name, m.glb()))), 0.5) << name;
}

TEST(Assimp, SaysWhyNot) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const MemoryFile file;
  const auto complaint = [&](const Bytes& bytes, const char* format, const LoadLimits& limits = {}) {
    const std::string path = file.write(bytes);
    try {
      load_scene(path, {.limits = limits, .format = format, .choice = {}});
      return std::string();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      EXPECT_TRUE(std::string(error.what()).starts_with(path + ": ")) << error.what();
      return std::string(error.what());
    }
  };
  EXPECT_NE(complaint(bytes_of("nonsense"), "fbx"), "");
  EXPECT_NE(complaint(bytes_of(off), "3ds"), "");
  EXPECT_NE(complaint(triangle_3ds(), "3ds", {.memory = 20}).find("the limit of 20 bytes"), std::string::npos);
  EXPECT_THROW(load_scene("missing.fbx"), Error);
}

/// Loads a file and validates the scene. Returns "", or the error message, which must be one line that begins with the
/// file's name.
std::string verdict(const Bytes& bytes, const std::string& format) {
  const MemoryFile file;
  const std::string path = file.write(bytes);
  const auto load_as = [&](const std::string& p, const LoadLimits& limits) {
    return load_scene(p, {.limits = limits, .format = format, .choice = {}});
  };
  const std::string error = load_soundly(load_as, path);
  EXPECT_TRUE(error.empty() || error.starts_with(path + ": ")) << error;
  return error;
}

TEST(Assimp, FilesOfBrokenFormAreRefused) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const auto with = [](std::string text, std::string_view what, std::string_view by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return bytes_of(at == std::string::npos ? text : text.replace(at, what.size(), by));
  };
  const auto half = [](const Bytes& b) {
    return Bytes(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(b.size() / 2));
  };
  for (const auto& [format, good] :
       {std::pair{"off", bytes_of(off)}, {"dae", bytes_of(dae)}, {"3ds", triangle_3ds()}}) {
    EXPECT_EQ(verdict(good, format), "") << format;
    EXPECT_NE(verdict(half(good), format), "") << format;
    EXPECT_NE(verdict({}, format), "") << format;
  }
  for (const auto& [what, by] : {std::pair{"OFF", "OFX"},
                                 {"6 1 0", "0 1 0"},
                                 {"6 1 0", "6 0 0"},
                                 {"6 1 0", "6000000 1 0"},
                                 {"2 0 0", "x 0 0"},
                                 {"2 0 0", "nan 0 0"}})
    EXPECT_NE(verdict(with(off, what, by), "off"), "") << what << " -> " << by;
  for (const auto& [what, by] : {std::pair{"</COLLADA>", ""},
                                 {"<vcount>4", "<vcount>400"},
                                 {"<p>0 0 1 1 2 2 3 3", "<p>0 0 1 1 2 2 9 3"},
                                 {"<p>0 0 1 1 2 2 3 3", "<p>0 0 1 1"},
                                 {"#p\"", "#q\""},
                                 {"-1 -1 0", "a -1 0"}})
    EXPECT_NE(verdict(with(dae, what, by), "dae"), "") << what << " -> " << by;
}

TEST(Assimp, DamagedFilesAreSoundOrRefusedInOneLine) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  std::mt19937 random(2);
  for (const auto& [format, good] :
       {std::pair{"off", bytes_of(off)}, {"dae", bytes_of(dae)}, {"3ds", triangle_3ds()}}) {
    int refused = 0;
    for (int i = 0; i < 12; ++i) {
      Bytes bytes = good;
      for (int n = 0; n < 3; ++n) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
      refused += !verdict(bytes, format).empty();
    }
    EXPECT_GE(refused, 6) << format;  // most triples of random bytes change a byte that matters
  }
}

TEST(Assimp, FloatsFarFromTheOriginLoseNothingMore) {
  if (!has_library()) GTEST_SKIP() << "libassimp is not installed";
  const auto read = [](const char* corners) {
    return load(bytes_of(std::string("OFF\n3 1 0\n") + corners + "3 0 1 2\n"), "off");
  };
  const Scene far = read("1000000.5 0 0\n1000001.5 0 0\n1000000.5 1 0\n");
  EXPECT_NE(far.origin, double3{});
  EXPECT_EQ(far.in_file(far.bounds().low), (double3{1000000.5, 0, 0}));
  EXPECT_EQ(far.in_file(far.bounds().high), (double3{1000001.5, 1, 0}));
  EXPECT_LT(std::abs(far.meshes[0].position[0].x), 2);
  EXPECT_EQ(read("10.5 0 0\n11.5 0 0\n10.5 1 0\n").origin, double3{});
}

}  // namespace
}  // namespace zoneplate
