// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/3mf/3mf.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/3mf/maker_for_test.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate {
namespace {

using namespace maker_3mf;

Scene load(const Bytes& bytes, const LoadLimits& limits = {}) {
  const MemoryFile file;
  Scene scene = load_3mf(file.write(bytes), limits);
  expect_sound(scene);
  return scene;
}

/// The cause of a refusal, without the name of the file.
std::string refusal(const Bytes& bytes, const LoadLimits& limits = {}) {
  const MemoryFile file;
  const std::string path = file.write(bytes);
  try {
    load_3mf(path, limits);
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    EXPECT_TRUE(text.starts_with(path + ": ")) << text;
    return text.substr(std::min(text.size(), path.size() + 2));
  }
  return "";
}

/// The warnings, without the name of the file.
std::vector<std::string> warnings_of(const Scene& scene) {
  std::vector<std::string> out;
  for (const std::string& w : scene.warnings) out.push_back(w.substr(w.find(": ") + 2));
  return out;
}
using Texts = std::vector<std::string>;

const Material& material_of(const Scene& s, std::size_t mesh) {
  return s.materials.at(static_cast<std::size_t>(s.meshes.at(mesh).material));
}

void expect_tower(const Scene& s) {
  EXPECT_EQ(s.up, (float3{0, 0, 1}));
  EXPECT_EQ(s.bounds().low, (float3{0, 0, 0}));
  EXPECT_EQ(s.bounds().high, (float3{10, 10, 30}));
  std::size_t triangles = 0;
  for (const Instance& i : s.instances) triangles += s.meshes[static_cast<std::size_t>(i.mesh)].primitives();
  EXPECT_EQ(triangles, 12u);
  EXPECT_EQ(warnings_of(s), Texts{});
}

TEST(Load3mf, ATowerIsUpright) {
  const Scene s = load(plain());
  expect_tower(s);
  EXPECT_TRUE(s.materials.at(0).is_default);
  EXPECT_EQ(s.objects[0], "object 1");
  EXPECT_EQ(s.meshes[0].position.size(), 24u) << "edges are sharp";
}

// PrusaSlicer, Bambu Studio, Orca, Cura and 3D Builder write one.
TEST(Load3mf, AThumbnailChangesNothing) {
  expect_tower(load(package(model(object(1, tower()), item(1)),
                            {{"Metadata/thumbnail.png", "\x89PNG"}, {"Metadata/Slic3r_PE.config", "; a=b"}},
                            {{"http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail",
                              "/Metadata/thumbnail.png"}})));
}

TEST(Load3mf, PartsOfTheProductionExtension) {
  const std::string part = model(object(1, tower()), item(1));
  const std::string root = model(object(2, R"(<components><component objectid="1" p:path="/3D/Objects/a.model"/>)"
                                           R"(</components>)"),
                                 item(2), R"(requiredextensions="p")");
  expect_tower(load(package(root, {{"3D/Objects/a.model", part, true}})));
  expect_tower(load(package(model("", item(1, R"(p:path="/3d/objects/A.model")")), {{"3D\\Objects\\a.model", part}})));
  EXPECT_EQ(refusal(package(root)),
            "model 3d/objects/a.model is not in the package: its objects are left out; nothing "
            "is left to draw");
}

TEST(Load3mf, BaseMaterialsOfTriangles) {
  const Scene s =
      load(package(model(R"(<basematerials id="5"><base name="red" displaycolor="#FF0000FF"/>)"
                         R"(<base name="blue" displaycolor="#0000FF80"/></basematerials>)" +
                             object(1, tower([](int k) { return k % 2 != 0 ? R"(pid="5" p1="1" p2="0" p3="0")" : ""; }),
                                    R"(pid="5" pindex="0" name="part")"),
                         item(1))));
  expect_tower(s);
  ASSERT_EQ(s.meshes.size(), 2u);
  EXPECT_EQ(material_of(s, 0).name, "red");
  EXPECT_EQ(material_of(s, 0).base_color, (float4{1, 0, 0, 1}));
  EXPECT_FALSE(material_of(s, 0).is_default);
  EXPECT_EQ(material_of(s, 1).base_color, (float4{0, 0, 1, 128.0f / 255}));
  EXPECT_EQ(material_of(s, 1).alpha_mode, AlphaMode::Blend);
  EXPECT_TRUE(s.meshes[1].color.empty());
  EXPECT_EQ(s.meshes[0].primitives(), 6u);
  EXPECT_LE(s.meshes[0].position.size(), 18u) << "vertices that the part does not use are left out";
  EXPECT_EQ(s.objects.size(), 1u);
  EXPECT_EQ(s.objects[0], "part");
  EXPECT_EQ(s.instances[1].part, 1);
}

TEST(Load3mf, AMaterialThatWouldHideEverythingIsOpaque) {
  const Scene s =
      load(package(model(R"(<basematerials id="5"><base name="a" displaycolor="#FF000000"/></basematerials>)" +
                             object(1, tower(), R"(pid="5" pindex="0")"),
                         item(1))));
  EXPECT_EQ(material_of(s, 0).base_color, (float4{1, 0, 0, 1}));
  EXPECT_EQ(warnings_of(s), Texts{"the alpha of a base material is 0, taken as 1"});
}

TEST(Load3mf, ColorsAreInterpolated) {
  const Scene s = load(package(model(
      R"(<m:colorgroup id="3"><m:color color="#FF0000"/><m:color color="#00FF0000"/>)"
      R"(<m:color color="#808080"/></m:colorgroup>)" +
          object(1, tower([](int k) { return k == 4 ? R"(p1="0" p2="1" p3="2")" : ""; }), R"(pid="3" pindex="2")"),
      item(1))));
  expect_tower(s);
  ASSERT_EQ(s.meshes.size(), 1u);
  const Mesh& m = s.meshes[0];
  ASSERT_EQ(m.color.size(), m.position.size());
  const float grey = decode_srgb8(0x80);
  EXPECT_EQ(m.color[m.index[0]], (float4{grey, grey, grey, 1}));
  EXPECT_EQ(m.color[m.index[12]], (float4{1, 0, 0, 1}));
  EXPECT_EQ(m.color[m.index[13]], (float4{0, 1, 0, 1})) << "colours alone are opaque";
  EXPECT_EQ(m.color[m.index[14]], (float4{grey, grey, grey, 1}));
  EXPECT_EQ(material_of(s, 0).alpha_mode, AlphaMode::Opaque);
}

std::string texture(const std::string& group, const std::string& attributes = "") {
  return R"(<m:texture2d id="8" path="/3D/Textures/a.png" contenttype="image/png" )" + attributes + "/>" +
         R"(<m:texture2dgroup id="9" texid="8"><m:tex2coord u="0" v="0"/><m:tex2coord u="1" v="0"/>)"
         R"(<m:tex2coord u="0" v="0.75"/></m:texture2dgroup>)" +
         group + object(1, tower([](int) { return R"(p1="0" p2="1" p3="2")"; }), R"(pid="9" pindex="0")");
}
ZipMember png(const Rgba8Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  return {"3D/Textures/a.png", {bytes.begin(), bytes.end()}};
}

TEST(Load3mf, TexturesOfThePackage) {
  const Scene s =
      load(package(model(texture("", R"(tilestyleu="mirror" tilestylev="clamp" filter="nearest")"), item(1)),
                   {png(Rgba8Image(2, 1, {200, 0, 0, 255}))}));
  expect_tower(s);
  ASSERT_EQ(s.images.size(), 1u);
  EXPECT_EQ(s.images[0].pixels.as<Rgba8>()(0, 0), (Rgba8{200, 0, 0, 255}));
  const TextureUse& use = material_of(s, 0).base_color_texture;
  EXPECT_EQ(use.image, 0);
  EXPECT_EQ(use.sampler.wrap_u, Wrap::Mirror);
  EXPECT_EQ(use.sampler.wrap_v, Wrap::Clamp);
  EXPECT_EQ(use.sampler.magnify, TexelFilter::Nearest);
  EXPECT_EQ(s.meshes[0].uv0[s.meshes[0].index[2]], (float2{0, 0.25f})) << "(0,0) is at the lower left";
}

TEST(Load3mf, AMissingTextureDoesNotCostTheModel) {
  const Bytes bytes = package(model(texture(""), item(1)));
  EXPECT_EQ(warnings_of(load(bytes)), Texts{"texture 3d/textures/a.png is not in the package"});
  EXPECT_EQ(refusal(bytes, {.is_strict = true}), "texture 3d/textures/a.png is not in the package");
  const Scene s = load(package(model(texture(""), item(1)), {{"3D/Textures/a.png", "GIF89a"}}));
  EXPECT_EQ(s.warnings.size(), 1u);
  EXPECT_EQ(material_of(s, 0).base_color, plain_material("").base_color);
}

TEST(Load3mf, CompositeMaterialsAreTheMeanOfTheirParts) {
  const Scene s =
      load(package(model(R"(<basematerials id="5"><base name="a" displaycolor="#FF0000"/>)"
                         R"(<base name="b" displaycolor="#0000FF"/></basematerials>)"
                         R"(<m:compositematerials id="6" matid="5" matindices="0 1"><m:composite values="1 3"/>)"
                         R"(<m:composite values="0.25 0.75"/></m:compositematerials>)" +
                             object(1, tower(), R"(pid="6" pindex="1")"),
                         item(1))));
  EXPECT_EQ(material_of(s, 0).base_color, (float4{0.25f, 0, 0.75f, 1}));
}

TEST(Load3mf, LayersOfMultiproperties) {
  const std::string layers =
      R"(<basematerials id="5"><base name="a" displaycolor="#FF0000"/></basematerials>)"
      R"(<m:colorgroup id="3"><m:color color="#0000FF33"/></m:colorgroup>)"
      R"(<m:multiproperties id="6" pids="5 3"><m:multi pindices="0 0"/></m:multiproperties>)"
      R"(<m:multiproperties id="7" pids="3 3" blendmethods="multiply"><m:multi pindices="0 0"/>)"
      R"(</m:multiproperties>)"
      R"(<m:multiproperties id="10" pids="5 9"><m:multi pindices="0 0"/><m:multi pindices="0 1"/>)"
      R"(</m:multiproperties>)";
  const auto color_of = [&](const char* pid) {
    return load(package(model(layers + object(1, tower(), std::string("pindex=\"0\" pid=\"") + pid + "\""), item(1))))
        .meshes.at(0)
        .color.at(0);
  };
  const float4 mixed = color_of("6");
  EXPECT_NEAR(mixed.x, 0.8f, 1e-6f);
  EXPECT_NEAR(mixed.z, 0.2f, 1e-6f);
  EXPECT_EQ(mixed.w, 1);
  EXPECT_EQ(xyz(color_of("7")), (float3{0, 0, 1}));
  // A texture with alpha lies on the material.
  const std::string decal = texture(layers);
  std::string text = model(decal, item(1));
  text.replace(text.find("pid=\"9\""), 7, "pid=\"10\"");
  text.replace(text.find("p3=\"2\""), 6, "p3=\"1\"");
  const Scene s = load(package(text, {png(Rgba8Image(2, 1, {0, 255, 0, 0}))}));
  EXPECT_EQ(s.images.at(0).pixels.as<Rgba8>()(0, 0), (Rgba8{255, 0, 0, 255}));
  // So does one of 16 bits, and one of floats.
  const auto on_red = [&](const Bytes& image) {
    return load(package(text, {{"3D/Textures/a.png", {image.begin(), image.end()}}})).images.at(0).pixels;
  };
  const TexelImage wide = on_red(encode_png(Rgba16Image(2, 1, {0, 65535, 0, 0})));
  EXPECT_EQ(wide.as<Rgba16>()(1, 0), (Rgba16{65535, 0, 0, 65535}));
  const TexelImage half = on_red(encode_png(Rgba16Image(2, 1, {0, 65535, 0, 32768})));
  EXPECT_NEAR(decode_srgb(static_cast<float>(half.as<Rgba16>()(0, 0).r) / 65535), 0.5f, 1e-4f);
  const LinearImage premultiplied(2, 1, {0, 0.125f, 0, 0.25f});
  const TexelImage light = on_red(encode_exr(2, 1, rgba_channels(premultiplied)));
  EXPECT_EQ(light.as<float4>()(0, 0), (float4{0.75f, 0.125f, 0, 1}));
}

TEST(Load3mf, GroupsTakeTheirOwnElementsOnly) {
  const std::string wrong = R"(<m:color color="#FF0000"/><base name="a" displaycolor="#FF0000"/>)"
                            R"(<m:multi pindices="0"/><m:composite values="1"/><m:tex2coord u="0" v="0"/>)";
  for (const char* group :
       {"m:texture2dgroup", "m:colorgroup", "basematerials", "m:compositematerials", "m:multiproperties"})
    load(package(model(
        fmt::format(R"(<{0} id="5" pids="5">{1}{1}</{0}>)", group, wrong) +
            object(1, tower([](int k) { return fmt::format(R"(p1="{0}" p2="{0}")", k % 4); }), R"(pid="5" pindex="0")"),
        item(1))));
}

TEST(Load3mf, TransformsOfItemsAndComponents) {
  const std::string turned = R"(transform="0 1 0 -1 0 0 0 0 1 100 0 0")";  // x to y, y to -x, then 100 along x
  const Scene s = load(package(
      model(object(1, tower()) +
                object(2, R"(<components><component objectid="1" transform="1 0 0 0 1 0 0 0 2 5 0 0"/></components>)"),
            item(2, turned) + item(2))));
  ASSERT_EQ(s.instances.size(), 2u);
  EXPECT_EQ(s.meshes.size(), 1u) << "a mesh is there once";
  EXPECT_EQ(s.instances[0].world_from_object * float4({10, 0, 30, 1}), (float4{100, 15, 60, 1}));
  EXPECT_EQ(s.instances[1].world_from_object * float4({10, 0, 30, 1}), (float4{15, 0, 60, 1}));
  EXPECT_EQ(s.objects[1], "object 1");
}

TEST(Load3mf, UnitsBecomeMillimetres) {
  std::string text = model(object(1, tower()), item(1, R"(transform="1 0 0 0 1 0 0 0 1 1 0 0")"));
  text.replace(text.find("millimeter"), 10, "inch");
  EXPECT_EQ(load(package(text)).bounds().high, (float3{11 * 25.4f, 10 * 25.4f, 30 * 25.4f}));
}

/// The vertices of a strip of 4 mm x 1 mm, 300 columns of two, after others; all of them are in triangles.
std::string strip(double3 at, const std::string& others = "") {
  std::string vertices = others, triangles;
  const auto count = 600 + std::count(others.begin(), others.end(), '<');
  for (int i = 0; i < 600; ++i)
    vertices += fmt::format(R"(<vertex x="{:.3f}" y="{:.3f}" z="{:.3f}"/>)", at.x + i / 2 * 0.01, at.y + i % 2, at.z);
  for (std::ptrdiff_t i = 0; i + 2 < count; ++i)
    triangles += fmt::format(R"(<triangle v1="{}" v2="{}" v3="{}"/>)", i, i + 1, i + 2);
  return "<mesh><vertices>" + vertices + "</vertices><triangles>" + triangles + "</triangles></mesh>";
}

TEST(Load3mf, VerticesFarFromTheOriginLoseNothing) {
  const double3 at{500000.125, 5200000.25, 300.5};
  for (const char* transform : {"", R"(transform="1 0 0 0 1 0 0 0 1 -500000.125 -5200000.25 -300.5")"}) {
    const Scene s = load(package(model(object(1, strip(at)), item(1, transform))));
    const double3 low = *transform == 0 ? at : double3{};
    EXPECT_EQ(s.origin == double3{}, *transform != 0);
    for (const int column : {0, 1, 150, 299}) {
      const auto vertex = static_cast<std::size_t>(2 * column);
      const double3 found = s.in_file(transform_point(s.instances[0].world_from_object, s.meshes[0].position[vertex]));
      EXPECT_NEAR(found.x, low.x + column * 0.01, 1e-6);
      EXPECT_NEAR(found.y, low.y, 1e-6);
      EXPECT_NEAR(found.z, low.z, 1e-6);
    }
  }
}

TEST(Load3mf, APartNearTheOriginKeepsTheFloatsOfAnObject) {
  const std::string near = R"(<vertex x="0" y="0" z="0"/>)";
  const double3 at{5000.1, 0, 0};
  for (const Bytes& file : {package(model(object(1, strip(at, near)), item(1))),
                            package(model(object(1, strip(at, near)) + object(2, strip(at)), item(1) + item(2)))}) {
    const Scene s = load(file);
    EXPECT_EQ(s.origin, double3{});
    EXPECT_EQ(s.instances[0].world_from_object, float4x4{});
    EXPECT_EQ(s.meshes[0].position[1], (float3{5000.1f, 0, 0}));
  }
}

TEST(Load3mf, AnObjectThatContainsItselfIsLeftOutByName) {
  const Bytes bytes = package(model(object(1, tower()) +
                                        object(2,
                                               R"(<components><component objectid="1"/><component objectid="3"/>)"
                                               R"(</components>)",
                                               R"(name="ring")") +
                                        object(3, R"(<components><component objectid="2"/></components>)"),
                                    item(2)));
  const Scene s = load(bytes);
  EXPECT_EQ(warnings_of(s), Texts{"ring contains itself: the component is left out"});
  EXPECT_EQ(s.instances.size(), 1u);
  EXPECT_EQ(refusal(bytes, {.is_strict = true}), "ring contains itself: the component is left out");
}

TEST(Load3mf, ComponentsAreAsDeepAsTheLimit) {
  std::string objects = object(1, tower());
  for (int i = 2; i <= 20; ++i)
    objects += object(i, fmt::format(R"(<components><component objectid="{}"/></components>)", i - 1));
  EXPECT_EQ(load(package(model(objects, item(20))), {.node_depth = 19}).instances.size(), 1u);
  EXPECT_EQ(refusal(package(model(objects, item(20))), {.node_depth = 18}), "object 1: components deeper than 18");
}

TEST(Load3mf, EmptyObjectsAreNotVisitedTwice) {
  std::string objects;
  for (int i = 2; i <= 60; ++i)
    objects += object(i, fmt::format(R"(<components><component objectid="{0}"/><component objectid="{0}"/>)"
                                     R"(</components>)",
                                     i - 1));
  EXPECT_EQ(
      refusal(package(model(object(1, "<mesh><vertices/><triangles/></mesh>") + objects, item(60))), {.seconds = 5}),
      "holds nothing to draw");
  const std::string other = R"(<object id="1" type="other">)" + tower() + "</object>";
  EXPECT_EQ(refusal(package(model(other + objects, item(60) + item(60))), {.seconds = 5}),
            "object 1 is of the type \"other\", which is not built: it is left out; nothing is left to draw");
}

// An object that nothing but a ring contains is drawn once.
TEST(Load3mf, ARingWithoutABuildDoesNotCostTheModel) {
  const auto part = [](int id, const std::string& components) {
    std::string text = "<components>";
    for (const char c : components) text += fmt::format(R"(<component objectid="{}"/>)", c);
    return object(id, text + "</components>");
  };
  for (const std::string& rings : {part(2, "12"), part(2, "3") + part(3, "21"), part(2, "2") + part(3, "21")}) {
    const Scene s = load(package(model(object(1, tower()) + rings, "")));
    EXPECT_EQ(s.instances.size(), 1u) << rings;
    const Texts warnings = warnings_of(s);
    ASSERT_EQ(warnings.size(), 2u) << rings;
    EXPECT_EQ(warnings[0], "object 2 contains itself: the component is left out") << rings;
    EXPECT_EQ(warnings[1], "its build has no items: the objects that are no components are drawn") << rings;
  }
}

TEST(Load3mf, OneFlawDoesNotCostTheModel) {
  const auto with = [](const std::string& triangle, const std::string& vertices = "") {
    std::string mesh = tower();
    mesh.insert(mesh.find("</triangles>"), triangle);
    mesh.insert(mesh.find("</vertices>"), vertices);
    return package(model(object(1, mesh), item(1)));
  };
  const std::pair<Bytes, std::string> cases[] = {
      {with(R"(<triangle v1="0" v2="1" v3="8"/><triangle v1="9" v2="1" v3="8"/>)"),
       "object 1, triangle 12 uses vertex 8, there are 8: it is dropped (and 1 more)"},
      {with(R"(<triangle v1="0" v2="-1" v3="2"/>)"), "object 1, triangle 12: a corner is no number: it is dropped"},
      {with(R"(<triangle v1="0" v2="1" v3="8"/>)", R"(<vertex x="nan" y="0" z="0"/>)"),
       "object 1, triangle 12: a vertex is not finite or no number: it is dropped"},
      {with(R"(<triangle v1="0" v2="1" v3="2" pid="77" p1="0"/>)"),
       "object 1 has property 0 of group 77, which has 0: it is left out"},
      {package(model(object(1, tower()), item(1) + item(4))), "object 4 is not in 3d/3dmodel.model: it is left out"},
      {package(model(object(1, tower()), item(1, R"(transform="1 2 3")"))),
       "item of object 1: its transform is not twelve numbers: it is left out"},
      {package(model(object(1, tower()), "")), "its build has no items: the objects that are no components are drawn"},
      {package(
           model(object(1, tower()) + R"(<object id="2" type="other">)" + tower() + "</object>", item(1) + item(2))),
       "object 2 is of the type \"other\", which is not built: it is left out"},
      {package(model(object(1, tower()), item(1), R"(xmlns:s="some://where" requiredextensions="p s m")")),
       "requires the extension some://where, which is not read: what is known of it is drawn"},
  };
  for (const auto& [bytes, warning] : cases) {
    EXPECT_EQ(warnings_of(load(bytes)), Texts{warning});
    EXPECT_EQ(load(bytes).bounds().high, (float3{10, 10, 30}));
    const std::string first = warning.substr(0, warning.find(" (and"));
    EXPECT_EQ(refusal(bytes, {.is_strict = true}), first);
  }
}

TEST(Load3mf, NamesOfTheFileStayOnOneLine) {
  const std::string named = R"(name="a&#10;b" pid="5" pindex="0")";
  const Bytes flawed = package(model(object(1, tower(), named), item(1)));
  EXPECT_EQ(refusal(flawed, {.is_strict = true}), "a?b has property 0 of group 5, which has 0: it is left out");
  EXPECT_EQ(warnings_of(load(flawed)), Texts{"a?b has property 0 of group 5, which has 0: it is left out"});
  const std::string image = texture("");
  std::string text = model(image, item(1));
  text.replace(text.find("a.png"), 5, "a&#10;b.png");
  EXPECT_EQ(refusal(package(text), {.is_strict = true}), "texture 3d/textures/a?b.png is not in the package");
  const Bytes corrupt = package(text, {{"3D/Textures/a\nb.png", "GIF89a"}});
  EXPECT_EQ(refusal(corrupt, {.is_strict = true}).find('\n'), std::string::npos);
  EXPECT_EQ(load(corrupt).warnings.at(0).find('\n'), std::string::npos);
}

TEST(Load3mf, AnObjectInsideAnotherOneIsSafe) {
  std::string mesh = tower();
  mesh.insert(mesh.find("</triangles>"), R"(<triangle v1="60" v2="1" v3="2"/>)");
  for (const auto& [inner, flaw] : {std::pair(2, " (and 1 more)"), std::pair(1, " (and 2 more)")}) {
    const Scene s = load(package(model(object(1, mesh + object(inner, "") + tower()), item(1) + item(7))));
    EXPECT_EQ(warnings_of(s),
              (Texts{fmt::format("object {} is inside object 1: what follows it there is left out{}", inner, flaw),
                     "object 1, triangle 12 uses vertex 60, there are 8: it is dropped"}));
    EXPECT_EQ(s.meshes.at(0).primitives(), 12u);
    EXPECT_EQ(s.bounds().high, (float3{10, 10, 30}));
  }
}

TEST(Load3mf, WhatIsNotDrawnIsNamed) {
  std::string mesh = tower();
  mesh.insert(mesh.find("</mesh>"),
              R"(<b:beamlattice radius="1"><b:beams><b:beam v1="0" v2="7"/></b:beams></b:beamlattice>)");
  const Scene s =
      load(package(model(R"(<s:slicestack id="4"><s:slice ztop="1"/></s:slicestack>)" + object(1, mesh), item(1),
                         R"(xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02")"
                         R"( xmlns:s="http://schemas.microsoft.com/3dmanufacturing/slice/2015/07")")));
  EXPECT_EQ(warnings_of(s), (Texts{"beam lattices (of the beam lattice extension) are not drawn",
                                   "slices (of the slice extension) are not drawn"}));
}

TEST(Load3mf, ReadsWhatProgramsWrite) {
  const std::string root = model(object(1, tower()), item(1));
  const std::string start = relationships({{model_type, "3D/3dmodel.model"}});
  std::string wide = "\xff\xfe";
  for (const char c : root.substr(root.find("<model"))) wide += c, wide += '\0';
  expect_tower(load(zip_of({{"_rels\\.rels", start}, {"3D\\3DModel.Model", root, true, true}})));
  expect_tower(
      load(zip_of({{"_rels/.rels", "\xef\xbb\xbf" + start, true}, {"/3D/3dmodel.model", "\xef\xbb\xbf" + root}})));
  expect_tower(load(zip_of({{"_rels/.rels", start}, {"3D/3dmodel.model", wide, true, false, true}})));
  expect_tower(
      load(zip_of({{"_rels/.rels", relationships({{model_type, "/3D/./x/../a%20b.model"}})}, {"3D/a b.model", root}})));
  // Names of others: attributes and elements.
  expect_tower(load(package(
      model(object(1, tower([](int) { return R"(paint_color="4" slic3rpe:custom_supports="8")"; }), R"(p:UUID="1")"),
            item(1, R"(printable="1")"), R"(xmlns:BambuStudio="http://schemas.bambulab.com/package/2021")"))));
  EXPECT_EQ(warnings_of(load(zip_of({{"3D/other.model", root}}))),
            Texts{"its relationships name no model that is there: 3d/other.model is drawn"});
  EXPECT_EQ(
      warnings_of(load(zip_of({{"_rels/.rels", start}, {.name = "3D/3dmodel.model", .text = root, .crc_change = 1}}))),
      Texts{"3D/3dmodel.model: its checksum is wrong"});
}

TEST(Load3mf, RefusalsNameTheCause) {
  EXPECT_EQ(refusal({'P', 'K', 3, 4}), "is no ZIP archive, or cut off");
  EXPECT_EQ(refusal({'s', 'o', 'l', 'i', 'd'}), "is no 3MF package: no ZIP archive");
  EXPECT_EQ(refusal(zip_of({{"word/document.xml", "<a/>"}})), "has no 3MF model");
  EXPECT_EQ(refusal(package("<model>\n</mode>")), "3D/3dmodel.model: line 2: is not well-formed XML: mismatched tag");
  EXPECT_EQ(refusal(package("<!DOCTYPE a><model/>")),
            "3D/3dmodel.model: line 1: has a document type declaration, which is not read");
  EXPECT_EQ(refusal(package(model("", ""))), "holds nothing to draw");
  EXPECT_EQ(refusal(package(model("", item(1, R"(p:path="/a&#10;b.model")")))),
            "model a?b.model is not in the package: its objects are left out; nothing is left to draw");
}

TEST(Load3mf, ABombIsRefused) {
  const Bytes bytes = package(model(object(1, tower()) + std::string(20 << 20, ' '), item(1)));
  EXPECT_LT(bytes.size(), std::size_t{1} << 20);
  EXPECT_EQ(refusal(bytes, {.memory = 8 << 20}),
            "3D/3dmodel.model: the archive unpacks to more than the limit of 8 MB (--max-memory)");
}

TEST(Load3mf, IsFoundByItsEndingInAnyCaseAndByItsContent) {
  const TestFolder folder;
  expect_tower(load_scene(folder.write("a.3MF", plain())));
  expect_tower(load_scene(folder.write("upload.bin", plain())));
  expect_tower(load_scene(folder.write("upload", plain()), {.is_sandboxed = true}));
}

}  // namespace
}  // namespace zoneplate
