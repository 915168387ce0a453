// SPDX-License-Identifier: Apache-2.0
// Options of render that change files, materials and lights; configuration, dry runs, completions. Runs the built
// program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/report/json_for_test.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

constexpr const char* stl = R"(solid s
facet normal 0 0 1
outer loop
vertex -1 -1 0
vertex 1 -1 0
vertex 0 1 0
endloop
endfacet
endsolid
)";

class Options : public ProgramTest {
 protected:
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((place / name).parent_path());
    std::ofstream(place / name, std::ios::binary) << text;
  }
  std::vector<std::uint8_t> bytes(const std::string& name) const {
    const std::string text = text_of(place / name);
    return {text.begin(), text.end()};
  }
  Rgba8Image image(const std::string& name) const { return decode_png(bytes(name), name).pixels; }
  // Runs without output and gives the image.
  Rgba8Image rendered(const std::string& arguments) const {
    const ProgramAnswer answer = run(arguments + " -o image.png --size 64 --quiet");
    EXPECT_EQ(answer.code, 0) << arguments << '\n' << answer.out;
    return image("image.png");
  }
  static Rgba8 middle(const Rgba8Image& image) { return image(image.width() / 2, image.height() / 2); }
};

TEST_F(Options, QualityMakesFilesSmaller) {
  const auto size = [&](const std::string& name, const std::string& options) {
    EXPECT_EQ(run("teapot --size 200 -o " + name + " " + options).code, 0);
    return fs::file_size(place / name);
  };
  EXPECT_LT(size("a.jpg", "--jpeg-quality 50"), size("b.jpg", ""));
  EXPECT_EQ(size("c.jpg", "--jpeg-quality 92"), size("b.jpg", ""));
  EXPECT_LT(size("a.webp", "--webp-quality 50"), size("b.webp", "") / 2);
  EXPECT_LT(size("a.png", "--png-compression small"), size("b.png", ""));
  EXPECT_EQ(image("a.png"), image("b.png"));
}

TEST_F(Options, FewPointsAreAHundredthOfTheHeightWide) {
  write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\np 1 2 3 4\n");
  const auto area = [&](const std::string& options) {
    EXPECT_EQ(run("points.obj -o points.png --size 400 --aa none --quiet " + options).code, 0);
    const Rgba8Image picture = image("points.png");
    const Rgba8 background = picture(0, 0);
    return std::ranges::count_if(picture.values(), [&](Rgba8 c) { return c != background; });
  };
  EXPECT_EQ(area(""), 4 * 4 * 4);
  EXPECT_EQ(area("--point-size 1"), 4);
  EXPECT_EQ(area("--point-size 6"), 4 * 6 * 6);
}

TEST_F(Options, TexturesOfFilesAreFilteredWithAnisotropy4) {
  // Stripes along the view, on a floor seen at a grazing angle: without probes they are blurred to grey.
  Rgba8Image stripes(256, 256);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      const auto code = static_cast<std::uint8_t>(x / 4 % 2 == 0 ? 255 : 0);
      stripes(x, y) = {code, code, code, 255};
    }
  const std::vector<std::uint8_t> png = encode_png(stripes, {});
  write("stripes.png", {png.begin(), png.end()});
  write("floor.mtl", "newmtl floor\nKd 1 1 1\nmap_Kd stripes.png\n");
  write("floor.obj",
        "mtllib floor.mtl\nusemtl floor\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
  const auto floor = [&](const std::string& options) {
    EXPECT_EQ(
        run("floor.obj -o floor.png --size 400 --camera-azimuth-angle 0 --camera-elevation-angle 8 --quiet " + options)
            .code,
        0);
    return image("floor.png");
  };
  const auto contrast = [](const Rgba8Image& picture) {
    int low = 255, high = 0;
    for (int x = 190; x < 210; ++x) {
      const int code = picture(x, 200).r;
      low = std::min(low, code), high = std::max(high, code);
    }
    return high - low;
  };
  const Rgba8Image usual = floor("");
  EXPECT_GT(contrast(usual), 2 * contrast(floor("--anisotropy 1")));
  EXPECT_EQ(usual, floor("--anisotropy 4"));
  EXPECT_EQ(floor("--quality fast"), floor("--aa msaa:n=4 --anisotropy 1"));
  EXPECT_EQ(floor("--quality best --quality default"), usual);
}

TEST_F(Options, SurfacesWithoutAMaterialTakeTheOneOfTheOptions) {
  write("a.stl", stl);
  const auto color = [&](const std::string& options) {
    return middle(rendered("a.stl --camera-elevation-angle 60 " + options));
  };
  const Rgba8 grey = color(""), red = color("--color red");
  EXPECT_EQ(grey.r, grey.g);
  EXPECT_GT(red.r, 100);
  EXPECT_EQ(red.g, 0);
  EXPECT_NE(color("--metallic 1 --roughness 0.1"), grey);
  ASSERT_EQ(
      run("triangles -o texture.png --size 4 --background blue --camera-position 0,0,9 --camera-focal-point 0,0,99 -q")
          .code,
      0);
  const ProgramAnswer textured = run("a.stl -o b.png --size 32 --texture texture.png");
  EXPECT_EQ(textured.code, 0);
  EXPECT_TRUE(contains(textured.out, "the model has no texture coordinates")) << textured.out;
  EXPECT_EQ(run("a.stl -o b.png --texture missing.png").code, 3);
  EXPECT_TRUE(contains(run("teapot -o c.png --size 32 --color red").out, "no effect: the model has materials"));
}

TEST_F(Options, TheMaterialOfAnOffFileIsTheReadersOwn) {
  write("a.off", "OFF\n3 1 0\n-1 -1 0\n1 -1 0\n0 1 0\n3 0 1 2\n");
  const Rgba8 red = middle(rendered("a.off --color red"));
  EXPECT_GT(red.r, 100);
  EXPECT_EQ(red.g, 0);
}

TEST_F(Options, MetallicAndRoughnessAreRefusedForOtherShadingModels) {
  write("a.stl", stl);
  EXPECT_EQ(run("a.stl -o a.png --metallic 1 --shading-model pbr").code, 0);
  const ProgramAnswer answer = run("a.stl -o a.png --roughness 0.5 --shading-model phong");
  EXPECT_EQ(answer.code, 2);
  EXPECT_TRUE(contains(answer.out, "--metallic and --roughness are those of --shading-model pbr")) << answer.out;
}

TEST_F(Options, WhiteSurfacesAreNotClippedOnes) {
  write("a.stl", stl);
  const ProgramAnswer answer = run("a.stl -o a.png --size 64 --color white --shading-model unlit");
  EXPECT_EQ(middle(image("a.png")), (Rgba8{255, 255, 255, 255}));
  EXPECT_FALSE(contains(answer.out, "clipped")) << answer.out;
}

TEST_F(Options, AContactSheetReportsItsModels) {
  write("a.stl", stl), write("b.stl", "solid");
  const ProgramAnswer answer = run("contact-sheet a.stl b.stl -o sheet.png --size 32 --json");
  EXPECT_EQ(answer.code, 5);
  const std::size_t line = answer.out.find('{');
  ASSERT_NE(line, std::string::npos) << answer.out;
  const nlohmann::json report = parsed_json(answer.out.substr(line, answer.out.find('\n', line) - line));
  EXPECT_EQ(report["format"], "zoneplate-contact-sheet");
  ASSERT_EQ(report["items"].size(), 2u);
  EXPECT_EQ(report["items"][0]["status"], "done");
  EXPECT_EQ(report["items"][1]["status"], "failed");
  EXPECT_NE(report["items"][1]["error"], "");
}

TEST_F(Options, LightsOfAFileCanBeReplacedOrJoined) {
  write("bright.gltf", bright_gltf());
  const ProgramAnswer answer = run("bright.gltf -o a.png --size 64 --lights file");
  EXPECT_TRUE(contains(answer.out, " % of the surfaces are clipped to white; see --exposure auto")) << answer.out;
  EXPECT_EQ(middle(image("a.png")), (Rgba8{255, 255, 255, 255}));
  EXPECT_LT(middle(rendered("bright.gltf --lights default")).r, 255);
  EXPECT_EQ(middle(rendered("bright.gltf --lights both")), (Rgba8{255, 255, 255, 255}));
  EXPECT_EQ(middle(rendered("bright.gltf --lights default --environment black")), (Rgba8{0, 0, 0, 255}));
}

TEST_F(Options, LightsThatWouldClipASceneToWhiteAreDimmed) {
  write("bright.gltf", bright_gltf());
  const ProgramAnswer answer = run("bright.gltf -o a.png --size 64");
  EXPECT_TRUE(contains(answer.out, "its lights would clip 100 % of the surfaces to white and are dimmed"))
      << answer.out;
  EXPECT_FALSE(contains(answer.out, "are clipped")) << answer.out;
  const Rgba8 still = middle(image("a.png"));
  EXPECT_GT(still.r, 200);
  EXPECT_LT(still.r, 255);
  // All frames of a sequence, and a contact sheet, have the same light.
  ASSERT_EQ(run("bright.gltf -o t.##.png --size 64 --turntable 8 --frame-start 1 --frames 1").code, 0);
  EXPECT_GT(middle(image("t.01.png")).r, 100);
  EXPECT_LT(middle(image("t.01.png")).r, 255);
  ASSERT_EQ(run("contact-sheet bright.gltf -o sheet.png --size 64").code, 0);
  const Rgba8Image sheet = image("sheet.png");
  EXPECT_TRUE(std::ranges::find(sheet.values(), still) != sheet.values().end());
  // Options of brightness and linear images keep the file's units.
  for (const char* options : {"--exposure 0", "--light-intensity 1"})
    EXPECT_EQ(middle(rendered(fmt::format("bright.gltf {}", options))), (Rgba8{255, 255, 255, 255})) << options;
  EXPECT_FALSE(contains(run("bright.gltf -o a.exr --size 64").out, "dimmed"));
  // Coloured surfaces clip as grey ones do; what emits light of its own is not dimmed.
  const auto with_material = [](const std::string& text) {
    std::string file = bright_gltf();
    const std::string old = R"({"pbrMetallicRoughness": {"metallicFactor": 0}})";
    return file.replace(file.find(old), old.size(), text);
  };
  write("red.gltf",
        with_material(R"({"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [1, 0, 0, 1]}})"));
  EXPECT_TRUE(contains(run("red.gltf -o a.png --size 64").out, "dimmed"));
  write("glow.gltf", with_material(R"({"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "roughnessFactor": 1},
                                       "emissiveFactor": [1, 1, 1]})"));
  EXPECT_FALSE(contains(run("glow.gltf -o a.png --size 64").out, "dimmed"));
}

TEST_F(Options, ALightThatRisesDimsAllFramesOfASequence) {
  std::string text = bright_gltf();
  const auto after = [&](const std::string& what, const std::string& more) {
    text.insert(text.find(what) + what.size(), more);
  };
  after(R"("max": [1, 1, 0]})", R"(,
{"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
{"bufferView": 1, "byteOffset": 8, "componentType": 5126, "count": 2, "type": "SCALAR"})");
  after(R"({"buffer": 0, "byteLength": 36})", R"(, {"buffer": 1, "byteLength": 16})");
  after(R"(AAAAgD8AAAAA"})",
        R"(, {"byteLength": 16, "uri": "data:application/octet-stream;base64,AAAAAAAAgD8AAAAAAFDDRw=="})");
  after(R"("scenes": [{"nodes": [0, 1]}],)", R"(
"animations": [{"samplers": [{"input": 1, "output": 2}], "channels": [{"sampler": 0, "target": {"path": "pointer",
 "extensions": {"KHR_animation_pointer": {"pointer": "/extensions/KHR_lights_punctual/lights/0/intensity"}}}}]}],)");
  write("rising.gltf", text);
  const ProgramAnswer answer = run("rising.gltf -o r.#.png --size 64 --frames 3 --frame-rate 2");
  ASSERT_EQ(answer.code, 0) << answer.out;
  EXPECT_TRUE(contains(answer.out, "are dimmed")) << answer.out;
  EXPECT_LT(middle(image("r.1.png")).r, middle(image("r.2.png")).r);
  EXPECT_LT(middle(image("r.2.png")).r, 255);
}

TEST_F(Options, AModelThatCannotBeSeenIsWarnedAbout) {
  const auto with_material = [](const std::string& properties) {
    std::string text = bright_gltf();
    const std::string old = R"({"pbrMetallicRoughness": {"metallicFactor": 0}})";
    return text.replace(text.find(old), old.size(), properties);
  };
  const std::string clear = R"("pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0]})";
  write("blend.gltf", with_material(R"({"alphaMode": "BLEND", )" + clear + "}"));
  write("mask.gltf", with_material(R"({"alphaMode": "MASK", )" + clear + "}"));
  write("cutoff.gltf", with_material(R"({"alphaMode": "MASK", "alphaCutoff": 2})"));
  for (const char* name : {"blend", "mask", "cutoff"})
    for (const char* output : {"a.png", "a.png --no-background", "a.exr"}) {
      const ProgramAnswer answer = run(fmt::format("{}.gltf --size 32 -o {}", name, output));
      EXPECT_EQ(answer.code, 0);
      EXPECT_TRUE(contains(answer.out, "nothing of it can be seen: its surfaces are transparent")) << name << output;
    }
  write("bright.gltf", bright_gltf());
  for (const char* options : {"", "--background white", "--crop 0,0,2,2"})
    EXPECT_FALSE(contains(run(fmt::format("bright.gltf --size 32 -o a.png {}", options)).out, "be seen")) << options;
}

TEST_F(Options, AutomaticExposureFitsTheBrightSurfaces) {
  write("bright.gltf", bright_gltf());
  const ProgramAnswer answer = run("bright.gltf -o a.png --size 64 --exposure auto --json");
  EXPECT_FALSE(contains(answer.out, "clipped")) << answer.out;
  const double exposure = parsed_json(answer.out)["exposure"];
  EXPECT_LT(exposure, 0.001);
  const int code = middle(image("a.png")).r;  // the sRGB code of 0.8 is 231
  EXPECT_GT(code, 200);
  EXPECT_LE(code, 232);
  // A larger image is metered by the same small one.
  EXPECT_EQ(parsed_json(run("bright.gltf -o b.png --size 512 --exposure auto --json").out)["exposure"],
            parsed_json(run("bright.gltf -o b.png --size 256 --exposure auto --json").out)["exposure"]);
  ASSERT_EQ(run("teapot -o t.####.png --size 32 --frames 2 --exposure auto").code, 0);
}

// The value of an attribute of an OpenEXR header.
template <class T, std::size_t count>
std::optional<std::array<T, count>> attribute(const std::string& file, const std::string& name,
                                              const std::string& type) {
  const std::string key = name + '\0' + type + '\0';
  const std::size_t at = file.find(key);
  if (at == file.npos) return std::nullopt;
  std::array<T, count> values;
  std::memcpy(values.data(), file.data() + at + key.size() + 4, sizeof values);
  return values;
}

TEST_F(Options, AnExrIsTransparentAndHasItsCamera) {
  ASSERT_EQ(run("triangles -o a.exr --size 64x32 --camera-position 1,2,5 --camera-focal-point 1,2,0 --frames 1 "
                "--frame-rate 23.976")
                .code,
            0);
  const LinearImage image = decode_exr(bytes("a.exr"), "a.exr");
  EXPECT_TRUE(std::ranges::any_of(image.values(), [](const Linear& c) { return c.a == 0; }));
  ASSERT_EQ(run("triangles -o b.exr --size 64x32 --background red").code, 0);
  const LinearImage opaque = decode_exr(bytes("b.exr"), "b.exr");
  EXPECT_TRUE(std::ranges::all_of(opaque.values(), [](const Linear& c) { return c.a == 1; }));

  const std::string file = text_of(place / "a.exr");
  const auto camera = attribute<float, 16>(file, "worldToCamera", "m44f"),
             ndc = attribute<float, 16>(file, "worldToNDC", "m44f");
  ASSERT_TRUE(camera && ndc);
  const auto transformed = [](const std::array<float, 16>& m, std::array<float, 4> p) {
    std::array<float, 4> out{};
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t column = 0; column < 4; ++column) out[column] += p[row] * m[4 * row + column];
    return out;
  };
  const auto at = transformed(*camera, {2, 4, 0, 1});  // right, up and in front
  EXPECT_NEAR(at[0], 1, 1e-5);
  EXPECT_NEAR(at[1], 2, 1e-5);
  EXPECT_NEAR(at[2], 5, 1e-5);
  const auto place_of = [&](float x, float y) {
    const auto p = transformed(*ndc, {x, y, 0, 1});
    return std::array<float, 2>{p[0] / p[3], p[1] / p[3]};
  };
  EXPECT_NEAR(place_of(1, 2)[0], 0.5, 1e-5);
  EXPECT_NEAR(place_of(1, 2)[1], 0.5, 1e-5);
  const float top = 2 + 5 * std::tan(0.2617994f);  // half of the view angle, 15°
  EXPECT_NEAR(place_of(1, top)[1], 0, 1e-5);
  EXPECT_NEAR(place_of(1 + 2 * (top - 2), 2)[0], 1, 1e-5);
  EXPECT_EQ((attribute<std::uint32_t, 2>(file, "framesPerSecond", "rational")),
            (std::array<std::uint32_t, 2>{24000, 1001}));
  const auto near = attribute<float, 1>(file, "cameraNearClip", "float"),
             far = attribute<float, 1>(file, "cameraFarClip", "float");
  ASSERT_TRUE(near && far);
  EXPECT_TRUE(0 < (*near)[0] && (*near)[0] < (*far)[0]);
  EXPECT_EQ((attribute<std::uint32_t, 2>(file, "timeCode", "timecode")), (std::array<std::uint32_t, 2>{0, 0}));
  ASSERT_EQ(run("triangles -o t.####.exr --size 8x8 -s 88201 -e 88201").code, 0);  // an hour, a minute, 15 s, one frame
  EXPECT_EQ((attribute<std::uint32_t, 2>(text_of(place / "t.88201.exr"), "timeCode", "timecode")),
            (std::array<std::uint32_t, 2>{0x01011501, 0}));
  EXPECT_TRUE((attribute<float, 8>(file, "chromaticities", "chromaticities")));
  EXPECT_FALSE((attribute<std::uint32_t, 2>(text_of(place / "b.exr"), "framesPerSecond", "rational")));
}

TEST_F(Options, TheConfigurationHasOptionsAndPresets) {
  write("config/zoneplate/config", "size = 20\n[wide]\nsize = 30x10\nno-background\n");
  const auto size = [&](const std::string& options) {
    const ProgramAnswer answer = run("triangles -o a.png " + options);
    EXPECT_EQ(answer.code, 0) << answer.out;
    return int2{image("a.png").width(), image("a.png").height()};
  };
  EXPECT_EQ(size(""), (int2{20, 20}));
  EXPECT_EQ(size("--preset wide"), (int2{30, 10}));
  EXPECT_EQ(image("a.png")(0, 0).a, 0);
  EXPECT_EQ(size("--preset wide --size 8"), (int2{8, 8}));
  EXPECT_EQ(size("--no-config --size 9x7"), (int2{9, 7}));
  write("config/zoneplate/config", "\nsiez = 20\n");
  const ProgramAnswer wrong = run("triangles -o a.png");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_TRUE(contains(wrong.out, "config/zoneplate/config: line 2: unknown option --siez; did you mean --size?"))
      << wrong.out;
}

TEST_F(Options, ADryRunWritesNothing) {
  write("models/a.stl", stl);
  write("models/sub/b.stl", stl);
  write("models/notes.txt", "");
  ProgramAnswer answer = run("triangles -o a.png --size 64x48 --aa none --dry-run");
  EXPECT_EQ(answer.code, 0);
  EXPECT_EQ(answer.out, "triangles -> a.png, 64 × 48, none\n");
  answer = run("models -o 'out/{dir}/{model}.png' --dry-run");
  EXPECT_EQ(answer.code, 0) << answer.out;
  EXPECT_TRUE(contains(answer.out, R"("input":"models/a.stl","output":"out/models/a.png","status":"planned")"))
      << answer.out;
  EXPECT_TRUE(contains(answer.out, R"("output":"out/models/sub/b.png","status":"planned")")) << answer.out;
  EXPECT_FALSE(fs::exists(place / "out"));
  EXPECT_FALSE(fs::exists(place / "a.png"));
  EXPECT_EQ(run("missing.glb -o a.png --dry-run").code, 3);
  EXPECT_EQ(run("models missing.glb -o out/ --dry-run").code, 5);
}

TEST_F(Options, AFolderStandsForItsModels) {
  write("models/a.stl", stl);
  write("models/sub/b.stl", stl);
  write("none/notes.txt", "");
  EXPECT_EQ(run("models -o 'out/{dir}/{model}.png' --size 16").code, 0);
  EXPECT_TRUE(fs::exists(place / "out/models/sub/b.png"));
  EXPECT_TRUE(fs::exists(place / "out/models/a.png"));
  EXPECT_EQ(run("contact-sheet models -o sheet.png --size 16").code, 0);
  const ProgramAnswer none = run("none -o out/");
  EXPECT_EQ(none.code, 3);
  EXPECT_EQ(none.out, "zoneplate: error: none: a folder without models (zoneplate list formats)\n");
}

TEST_F(Options, TilesReportTheirProgress) {
  const ProgramAnswer answer = run("teapot -o a.png --size 512 -t 1 --progress json");
  ASSERT_EQ(answer.code, 0);
  EXPECT_GT(std::count(answer.out.begin(), answer.out.end(), '\n'), 15) << answer.out;
  EXPECT_TRUE(contains(answer.out, R"({"stage":"render","done":0.5})")) << answer.out;
}

TEST_F(Options, HelpOfOneGroup) {
  const ProgramAnswer answer = run("render --help=camera");
  EXPECT_EQ(answer.code, 0);
  EXPECT_TRUE(answer.out.starts_with("Camera:\n")) << answer.out;
  EXPECT_FALSE(contains(answer.out, "--threads"));
}

TEST_F(Options, BashCompletesVerbsOptionsAndValues) {
  ASSERT_EQ(run("completions bash > completions").code, 0);
  const auto completed = [&](const std::string& words) {
    write("complete", "source '" + (place / "completions").string() + "'\nCOMP_WORDS=(" + words +
                          ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_zoneplate\necho \"${COMPREPLY[@]}\"\n");
    EXPECT_EQ(
        std::system(("bash '" + (place / "complete").string() + "' > '" + (place / "words").string() + "'").c_str()),
        0);
    return text_of(place / "words");
  };
  EXPECT_EQ(completed("zoneplate rend"), "render\n");
  EXPECT_EQ(completed("zoneplate render a.glb --jpeg"), "--jpeg-quality\n");
  EXPECT_EQ(completed("zoneplate a.glb --jpeg"), "--jpeg-quality\n");
  EXPECT_EQ(completed("zoneplate render --quality ''"), "fast default best\n");
  EXPECT_EQ(completed("zoneplate render --quality = b"), "best\n");
  EXPECT_EQ(completed("zoneplate a.glb --tone-mapping ac"), "aces\n");
  EXPECT_EQ(completed("zoneplate sdf from"), "from-mask\n");
  EXPECT_EQ(completed("zoneplate sdf from-mask --inv"), "--invert\n");
  EXPECT_EQ(completed("zoneplate metrics --juni"), "--junit\n");
}

TEST_F(Options, CompletionsAndTheManualPageHaveEveryVerbAndOption) {
  const std::string zsh = run("completions zsh").out, fish = run("completions fish").out, man = run("man").out;
  EXPECT_TRUE(zsh.starts_with("#compdef zoneplate\n"));
  for (const char* text : {"_zoneplate_contact_sheet()", "_zoneplate_sdf_from_mask()", "--jpeg-quality="})
    EXPECT_TRUE(contains(zsh, text)) << text;
  for (const char* text :
       {" -l jpeg-quality -x ", "-a 'fast default best'", " -s o -r -F ", "seen_subcommand_from sdf; and"})
    EXPECT_TRUE(contains(fish, text)) << text;
  EXPECT_TRUE(man.starts_with(".TH ZONEPLATE 1 ")) << man.substr(0, 80);
  for (const char* text :
       {".SH \"ZONEPLATE SDF FROM-MASK\"", "\\fB\\-\\-jpeg\\-quality\\fR \\fIN\\fR", ".SH EXIT STATUS"})
    EXPECT_TRUE(contains(man, text)) << text;
}

}  // namespace
}  // namespace zoneplate
