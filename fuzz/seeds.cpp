// SPDX-License-Identifier: Apache-2.0
// Writes the seeds of the fuzz targets, a folder a format: small files that between them use what a format has.
#include <filesystem>
#include <memory>
#include <string>

#include "zoneplate/codec/animated/gif_file_for_test.h"
#include "zoneplate/codec/apng.h"
#include "zoneplate/codec/bitmap/pillow_files_for_test.h"
#include "zoneplate/codec/color/icc_for_test.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/inspect/exif_for_test.h"
#include "zoneplate/codec/inspect/exr_parts_for_test.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/ktx2/files_for_test.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/system/avif.h"
#include "zoneplate/codec/system/jxl.h"
#include "zoneplate/codec/system/tiff_file_for_test.h"
#include "zoneplate/codec/webp.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/formats/3mf/maker_for_test.h"
#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/sample_for_test.h"
#include "zoneplate/formats/import/mesh_samples_for_test.h"
#include "zoneplate/formats/import/scene_bytes.h"
#include "zoneplate/math/random.h"
#include "zoneplate/os/file.h"
#include "zoneplate/scene/material_layers.h"

/// Opens the libraries that encoders need (child_seam.cpp).
extern "C" int LLVMFuzzerInitialize(int*, char***);

namespace {

using namespace zoneplate;
using namespace mesh_samples;

void write(const std::string& folder, const std::string& name, const Bytes& bytes) {
  std::filesystem::create_directories(folder);
  save_bytes(folder + "/" + name, bytes);
}

/// JSON, a zero and the binary chunk, as model_fuzz.cpp takes them.
Bytes parts_of(const GltfMaker& m) {
  Bytes out = bytes_of(m.json());
  out.push_back(0);
  out.insert(out.end(), m.binary.begin(), m.binary.end());
  return out;
}

/// Strips and tiles of codes, a palette and light.
void write_tiffs(const std::string& folder) {
  const Bytes codes(16 * 16 * 8, 77);
  int number = 0;
  const auto put = [&](const TiffForTest& t) { write(folder, std::to_string(number++) + ".tif", tiff_of(t)); };
  for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS})
    put({.width = 7,
         .height = 5,
         .samples = 4,
         .compression = static_cast<std::uint16_t>(compression),
         .alpha = EXTRASAMPLE_ASSOCALPHA,
         .rows_per_strip = 2,
         .data = codes});
  put({.width = 20,
       .height = 9,
       .planes = PLANARCONFIG_SEPARATE,
       .orientation = 6,
       .tile = 16,
       .mode = "wb",
       .data = codes});
  put({.width = 9, .height = 3, .samples = 1, .bits = 1, .photometric = PHOTOMETRIC_MINISWHITE, .data = codes});
  put({.width = 3,
       .height = 3,
       .samples = 1,
       .bits = 16,
       .photometric = PHOTOMETRIC_MINISBLACK,
       .mode = "w8",
       .data = codes});
  put({.width = 3, .height = 3, .bits = 32, .kind = SAMPLEFORMAT_IEEEFP, .data = codes});
  put({.width = 16, .height = 16, .photometric = PHOTOMETRIC_YCBCR, .compression = COMPRESSION_JPEG, .data = codes});
  put({.width = 2,
       .height = 1,
       .samples = 1,
       .bits = 2,
       .photometric = PHOTOMETRIC_PALETTE,
       .palette = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11},
       .data = codes});
}

/// A triangle that is packed by Draco, instanced, has variants and a material with all textures.
GltfMaker extended() {
  GltfMaker m;
  const std::string packed = m.view<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 128, 63});
  const std::string position = m.accessor(R"({"componentType":5126,"count":3,"type":"VEC3"})");
  const std::string index = m.accessor(R"({"componentType":5125,"count":3,"type":"SCALAR"})");
  m.mesh(R"("POSITION":)" + position,
         R"(,"material":0,"indices":)" + index + R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":)" +
             packed +
             R"(,"attributes":{"POSITION":0}},"KHR_materials_variants":{"mappings":[{"material":0,"variants":[0]}]}})");
  const std::string places = m.floats("VEC3", {0, 0, 0, 1, 2, 3});
  m.nodes = R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" + places + "}}}}";
  m.materials = R"({"emissiveTexture":{"index":0},"occlusionTexture":{"index":0,"strength":0.5},
      "extensions":{"KHR_materials_unlit":{},"KHR_materials_emissive_strength":{"emissiveStrength":3}}})";
  m.rest = R"(,"textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,iVBORw0KGgo="}],
      "extensions":{"KHR_materials_variants":{"variants":[{"name":"red"}]}})";
  return m;
}

/// A view of four values and an index packed by meshoptimizer, whose bytes a fuzzer may find.
GltfMaker packed() {
  GltfMaker m;
  const std::string bytes = m.view<std::uint8_t>(Bytes(64, 0xa0));
  m.views += R"(,{"buffer":0,"byteLength":48,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":0,
      "byteLength":64,"byteStride":12,"count":4,"mode":"ATTRIBUTES","filter":"NONE"}}})";
  m.mesh(R"("POSITION":)" + m.accessor(R"({"bufferView":1,"componentType":5126,"count":4,"type":"VEC3"})"));
  m.rest = R"(,"extensionsUsed":["EXT_meshopt_compression"])";
  return m;
}

/// A triangle whose material has every layer, and an animation of its base colour by a pointer.
GltfMaker layered() {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}), R"(,"material":0)");
  const std::string times = m.floats("SCALAR", {0, 1}), colors = m.floats("VEC4", {0, 0, 0, 1, 1, 1, 1, 1});
  m.nodes = R"({"mesh":0,"extensions":{"KHR_node_visibility":{"visible":true}}})";
  m.materials = R"({"pbrMetallicRoughness":{},"extensions":{"KHR_materials_ior":{"ior":1.4},
      "KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[1,1,1],"specularTexture":{"index":0}},
      "KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatNormalTexture":{"index":0,"scale":2}},
      "KHR_materials_sheen":{"sheenColorFactor":[1,1,1],"sheenRoughnessTexture":{"index":0}},
      "KHR_materials_anisotropy":{"anisotropyStrength":1,"anisotropyTexture":{"index":0}},
      "KHR_materials_iridescence":{"iridescenceFactor":1,"iridescenceThicknessTexture":{"index":0}},
      "KHR_materials_transmission":{"transmissionFactor":1},
      "KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":2,"attenuationColor":[1,0.5,0]},
      "KHR_materials_dispersion":{"dispersion":1},
      "KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":1},
      "KHR_materials_pbrSpecularGlossiness":{"glossinessFactor":1,"specularGlossinessTexture":{"index":0}}}})";
  m.rest = R"(,"textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,iVBORw0KGgo="}],
      "animations":[{"channels":[{"sampler":0,"target":{"path":"pointer","extensions":{"KHR_animation_pointer":
      {"pointer":"/materials/0/pbrMetallicRoughness/baseColorFactor"}}}}],"samplers":[{"input":)" +
           times + R"(,"output":)" + colors + "}]}]";
  return m;
}

Rgba8Image noise(int width, int height) {
  Rgba8Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::uint32_t h = hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0u);
      image(x, y) = {static_cast<std::uint8_t>(h), static_cast<std::uint8_t>(h >> 8), static_cast<std::uint8_t>(x),
                     static_cast<std::uint8_t>(h >> 16)};
    }
  return image;
}

void write_images(const std::string& root) {
  const Rgba8Image image = noise(9, 7);
  write(root + "/png", "rgba.png", encode_png(image));
  write(root + "/png", "rgb.png", encode_png(image, {.has_alpha = false}));
  write(root + "/png", "indexed.png", encode_png(Rgba8Image(5, 3, {1, 2, 3, 255}), {.may_be_indexed = true}));
  write(root + "/png", "rgba16.png", encode_png(Rgba16Image(4, 4, {1000, 2000, 3000, 4000})));
  write(root + "/png", "grey16.png", encode_png(Plane<std::uint16_t>(4, 4, 999)));
  const Bytes icc = icc_display_p3();
  const ColorProfile profile{.cicp = {{9, 16, 0, 1}},
                             .icc = icc,
                             .gamma = 55556,
                             .primaries = {{31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000}}};
  write(root + "/png", "profile.png", png_with(encode_png(image, {.profile = profile}), "eXIf", exif_of(6)));
  write(root + "/jpeg", "profile.jpg", turned_jpeg(encode_jpeg(image, 90, icc), 6));
  write(root + "/webp", "profile.webp", encode_webp(image, true, std::nullopt, icc));
  write(root + "/jpeg", "noise.jpg", encode_jpeg(image));
  write(root + "/jpeg", "pixel.jpg", encode_jpeg(Rgba8Image(1, 1)));
  write(root + "/webp", "rgba.webp", encode_webp(image, true));
  write(root + "/webp", "rgb.webp", encode_webp(image, false));
  Animation film{.format = {.loops = 2, .has_alpha = true}, .frames = {image, image}};
  film.frames[1](1, 1) = {9, 8, 7, 6};
  write(root + "/apng", "film.png", encode_apng(film));
  write(root + "/webp", "film.webp", encode_webp(film));
  GifMaker gif(4, 3, {0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255}, 3);
  gif.frame(
         {.width = 4, .height = 3, .indices = {0, 1, 2, 3, 0, 1, 2, 3, 3, 3, 3, 3}, .delay = 5, .is_interlaced = true})
      .frame({.x = 1, .y = 1, .width = 2, .height = 1, .indices = {1, 2}, .disposal = 3, .transparent = 1})
      .frame({.width = 1, .height = 1, .indices = {0}, .disposal = 2, .colors = {1, 2, 3, 4, 5, 6}});
  write(root + "/gif", "film.gif", gif.end());
  write_tiffs(root + "/tiff");
  write(root + "/avif", "rgba.avif", encode_avif(image, true));
  write(root + "/avif", "rgb.avif", encode_avif(image, false));
  write(root + "/jxl", "rgba.jxl", encode_jxl(image, true));
  write(root + "/jxl", "rgb.jxl", encode_jxl(image, false));
  for (const PillowFile& file : pillow_bmp_files)
    write(root + "/bmp", file.name + std::string(".bmp"), {file.bytes.begin(), file.bytes.end()});
  for (const PillowFile& file : pillow_tga_files)
    write(root + "/tga", file.name + std::string(".tga"), {file.bytes.begin(), file.bytes.end()});
  // Of 2 x 2 pixels with a palette of two colours: RLE8, then 4 bits.
  const Bytes bmp = {'B', 'M', 0, 0, 0, 0, 0, 0, 0, 0, 62, 0, 0, 0, 40, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 1, 0, 8, 0, 1};
  Bytes runs = bmp, nibbles = bmp;
  nibbles[28] = 4, nibbles[30] = 0;
  for (Bytes* file : {&runs, &nibbles}) file->resize(62), (*file)[46] = 2;
  runs.insert(runs.end(), {0, 2, 0, 1, 1, 1, 0, 0, 0, 3, 0, 1, 1, 0, 0, 1});
  nibbles.insert(nibbles.end(), {0x10, 0, 0, 0, 0x01, 0, 0, 0});
  write(root + "/bmp", "runs.bmp", runs);
  write(root + "/bmp", "nibbles.bmp", nibbles);
  write(root + "/ktx2", "etc1s.ktx2", Bytes(std::begin(etc1s_file), std::end(etc1s_file)));
  write(root + "/ktx2", "uastc.ktx2", Bytes(std::begin(zstandard_file), std::end(zstandard_file)));
}

/// A Radiance image of these bytes.
Bytes radiance(const std::string& lines, const std::string& scan, const Bytes& pixels) {
  Bytes out = bytes_of("#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n" + scan + "\n");
  out.insert(out.end(), pixels.begin(), pixels.end());
  return out;
}

void write_light(const std::string& root) {
  write(root + "/hdr", "plain.hdr",
        radiance("", "-Y 2 +X 2", {128, 64, 255, 129, 7, 7, 7, 0, 255, 0, 1, 255, 1, 2, 3, 1}));
  write(root + "/hdr", "turned.hdr", radiance("EXPOSURE=2\n# made\n", "+X 1 -Y 2", {9, 8, 7, 130, 6, 5, 4, 131}));
  write(root + "/hdr", "old.hdr", radiance("", "-Y 1 +X 9", {9, 8, 7, 130, 1, 1, 1, 3, 9, 9, 9, 128, 1, 1, 1, 4}));
  // Each channel of a row by itself: a run of ten, of six and four others, ...
  const Bytes run = {2, 2, 0, 10, 138, 77, 134, 5, 4, 1, 2, 3, 4, 10, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 138, 129};
  write(root + "/hdr", "new.hdr", radiance("", "-Y 1 +X 10", run));
  write(root + "/pfm", "color.pfm", encode_pfm(LinearImage(3, 2, {1, 0.5f, -2, 1})));
  write(root + "/pfm", "grey.pfm", encode_pfm(Plane<float>(2, 3, 7)));
  const std::vector<float> values(12, 0.5f);
  write(root + "/exr", "light.exr",
        encode_exr(4, 3, {{"R", ExrType::Half, values.data()}, {"Z", ExrType::Float, values.data()}},
                   {{"note", "text"}}));
  write(root + "/exr", "parts.exr",
        exr_of_parts(4, {{"beauty", {{"B", 0.5f}, {"G", 0.5f}, {"R", 0.5f}, {"depth.Z", 1}}},
                         {"normals", {{"N.X", 0}, {"N.Y", 0}, {"N.Z", 1}}}}));
}

/// A scene as write_scene writes it.
Bytes answer_of(const Scene& scene) {
  Bytes out;
  write_scene(scene, [&](const void* data, std::size_t size) {
    const auto* at = static_cast<const std::uint8_t*>(data);
    out.insert(out.end(), at, at + size);
  });
  return out;
}

void write_answers(const std::string& root) {
  write(root + "/scene", "empty", answer_of({}));
  Scene scene = load_gltf(root + "/gltf/triangle.glb");
  write(root + "/scene", "triangle", answer_of(scene));
  scene.objects.share(0);
  scene.instances.push_back({0, 1, {}});
  scene.images.push_back({"image", Rgba8Image(2, 2)});
  scene.materials.emplace_back().base_color_texture.image = 0;
  scene.materials.back().layers = std::make_shared<const MaterialLayers>();
  scene.lights.push_back({.name = "lamp", .kind = LightKind::Spot});
  scene.cameras.push_back({.name = "eye", .is_orthographic = true});
  scene.animations.push_back({"turn", 0, 1});
  scene.variants = {"red"}, scene.warnings = {"passed over"};
  write(root + "/scene", "everything", answer_of(scene));
}

void write_manifests(const std::string& root) {
  write(root + "/manifest", "jobs",
        bytes_of(R"({"input":"a.glb","output":"a.png","size":"64x64","frames":"0-3","skip-existing":true})"
                 "\n"
                 R"({"input":"sphere:triangles=1000","output":"b.exr","yaw":-12.5,"yaw":1e2})"
                 "\n"));
  write(root + "/manifest", "nested", bytes_of(R"({"a":[1,{"b":null,"c":["\u00e9","\n"]}],"d":18446744073709551615})"));
  std::string many;
  for (int i = 0; i < 100; ++i) many += (i == 0 ? "{\"k" : ",\"k") + std::to_string(i % 90) + "\":\"v\"";
  write(root + "/manifest", "many", bytes_of(many + "}"));
}

void write_shapes(const std::string& root) {
  write(root + "/sdf", "shapes",
        bytes_of(
            "canvas 64 48 background #204060 // dark\nlet eye = circle(20, 24, 12)\n"
            "fill #ff8000cc smooth-union(6, eye, turn(30, rectangle(30, 0, 20, 10)), polygon(40, 4, 60, 4, 50, 20))\n"
            "stroke #fff 2.5 grid(2, 3, 9, 9, ellipse(0, 0, 4, 2))\n"));
  write(root + "/sdf", "path",
        bytes_of("fill #000 path(\"M1 2L3 4h5v6C1 2 3 4 5 6s7 8 9 1Q2 3 4 5t6 7A8 9 10 0 1 2 3z\")\n"
                 "fill #123456 difference(repeat(8, 0, rhombus(0, 0, 4, 3)), complement(line(0, 0, 9, 9, 2)))\n"));
  write(root + "/sdf", "json",
        bytes_of(R"({"canvas":[64,48],"background":"#204060","let":{"eye":{"circle":[20,24,12]}},"layers":[
          {"fill":"#ff8000cc","shape":{"smooth-difference":[6,{"eye":[]},{"scale":[2,{"flip":[{"triangle":[1,2,3,4]}]}]}]}},
          {"stroke":"\u0023fff","width":2.5,"shape":{"shrink":[1,{"regular-polygon":[9,9,8,5]}]}}]})"));
}

/// A network and a table whose weights are small, of the forms that weights_fuzz.cpp reads.
void write_weights(const std::string& root) {
  Bytes network = bytes_of("ZPLEARN1");
  constexpr int forms[][4] = {{12, 16, 3, 2}, {16, 16, 3, 1}, {16, 24, 3, 1},
                              {12, 8, 1, 1},  {14, 16, 3, 1}, {16, 16, 1, 1}};
  for (const auto& [inputs, outputs, side, stride] : forms) {
    for (const int number : {inputs, outputs, side, stride}) network.push_back(static_cast<std::uint8_t>(number));
    for (int o = 0; o < outputs; ++o) network.insert(network.end(), {0, 0, 0x80, 0x3b});  // 1 / 256
    network.resize(network.size() + 4 * static_cast<std::size_t>(outputs));
    for (int k = 0; k < outputs * side * side * inputs; ++k) network.push_back(static_cast<std::uint8_t>(k % 5));
  }
  write(root + "/weights", "network", network);
  Bytes table = bytes_of("ZPTABLE1");
  table.resize(table.size() + std::size_t{2} * 96 * 28, 1);
  write(root + "/weights", "table", table);
}

/// Packages of few bytes, stored, so that a fuzzer reaches their XML; and AMF.
void write_printed(const std::string& root) {
  using namespace maker_3mf;
  const std::string mesh =
      R"(<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/>)"
      R"(</vertices><triangles><triangle v1="0" v2="1" v3="2" pid="3" p1="0" p2="1"/></triangles></mesh>)";
  const std::string groups =
      R"(<basematerials id="2"><base name="a" displaycolor="#FF0000"/></basematerials>)"
      R"(<m:colorgroup id="3"><m:color color="#FF0000"/><m:color color="#00FF0080"/></m:colorgroup>)"
      R"(<m:texture2d id="4" path="/t.png" contenttype="image/png" tilestyleu="mirror"/>)"
      R"(<m:texture2dgroup id="5" texid="4"><m:tex2coord u="0" v="0.5"/></m:texture2dgroup>)"
      R"(<m:compositematerials id="6" matid="2" matindices="0 0"><m:composite values="1 2"/>)"
      R"(</m:compositematerials>)"
      R"(<m:multiproperties id="7" pids="2 3 5" blendmethods="mix multiply">)"
      R"(<m:multi pindices="0 1 0"/></m:multiproperties>)";
  const auto stored = [](const std::string& text, const std::vector<ZipMember>& more = {}) {
    std::vector<ZipMember> members = {{"_rels/.rels", relationships({{model_type, "/a.model"}})}, {"a.model", text}};
    members.insert(members.end(), more.begin(), more.end());
    return zip_of(members);
  };
  const std::vector<std::uint8_t> image = encode_png(Rgba8Image(1, 1, {9, 8, 7, 6}));
  write(root + "/3mf", "core.3mf", stored(model(object(1, mesh), item(1, R"(transform="1 0 0 0 1 0 0 0 1 3 0 0")"))));
  std::string stray = mesh;
  stray.replace(stray.find("v3=\"2\""), 6, "v3=\"60\"");
  write(root + "/3mf", "nested.3mf", stored(model(object(1, stray + object(2, mesh) + mesh), item(1))));
  for (int pid = 2; pid <= 7; ++pid) {
    std::string text = mesh;
    text.replace(text.find("pid=\"3\""), 7, "pid=\"" + std::to_string(pid) + "\"");
    write(root + "/3mf", "group" + std::to_string(pid) + ".3mf",
          stored(model(groups + object(1, text, R"(pid="3" pindex="0")"), item(1)),
                 {{"t.png", {image.begin(), image.end()}}}));
  }
  const std::string parts =
      R"(<components><component objectid="1" p:path="/b.model"/><component objectid="3"/></components>)";
  write(root + "/3mf", "parts.3mf",
        stored(model(object(2, parts) + object(3, R"(<components><component objectid="2"/>)"
                                                  R"(</components>)"),
                     item(2)),
               {{"b.model", model(object(1, mesh), ""), true}}));
  write(root + "/amf", "all.amf",
        bytes_of(
            "<?xml version=\"1.0\"?><amf unit=\"inch\"><object id=\"1\"><metadata type=\"name\">a</metadata><color>"
            "<r>1</r><g>0</g><b>.5</b><a>1</a></color><mesh><vertices><vertex><coordinates><x>0</x><y>0</y><z>0</z>"
            "</coordinates><color><r>1</r></color></vertex><vertex><coordinates><x>1</x><y>0</y><z>0</z></coordinates>"
            "</vertex><vertex><coordinates><x>0</x><y>1</y><z>0</z></coordinates></vertex></vertices><volume "
            "materialid=\"2\"><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh></object><material "
            "id=\"2\"><color><r>1</r></color></material><constellation id=\"3\"><instance objectid=\"1\">"
            "<deltax>1</deltax><rz>30</rz></instance></constellation></amf>"));
  write(root + "/amf", "nested.amf",
        bytes_of("<amf><object id=\"1\"><mesh><vertices><vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates>"
                 "</vertex></vertices><volume><triangle><v1>0</v1><v2>9</v2><v3>0</v3></triangle></volume></mesh>"
                 "<constellation id=\"2\"><instance objectid=\"1\"/></constellation></object></amf>"));
}

}  // namespace

int main(int argc, char** argv) {
  LLVMFuzzerInitialize(&argc, &argv);
  const std::string root = argv[1];
  write(root + "/gltf", "everything", parts_of(everything()));
  write(root + "/gltf", "extended", parts_of(extended()));
  write(root + "/gltf", "packed", parts_of(packed()));
  write(root + "/gltf", "layered", parts_of(layered()));
  write(root + "/gltf", "triangle.glb", triangle_maker().glb());
  write(root + "/obj", "all.obj", bytes_of(obj));
  write(root + "/mtl", "all.mtl", bytes_of(mtl));
  write(root + "/ply", "ascii.ply", bytes_of(ascii_ply));
  write(root + "/ply", "little.ply", binary_ply(false));
  write(root + "/ply", "big.ply", binary_ply(true));
  write(root + "/stl", "ascii.stl", bytes_of(ascii_stl));
  write(root + "/stl", "binary.stl", binary_stl());
  write_weights(root);
  write_printed(root);
  write_images(root);
  write_light(root);
  write_answers(root);
  write_manifests(root);
  write_shapes(root);
}
