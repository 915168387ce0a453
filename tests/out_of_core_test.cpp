// SPDX-License-Identifier: Apache-2.0
// A scene whose triangles are read in parts has the image of one that is in memory: every size of the parts, every
// format that is read in parts, and by the command under --max-memory.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <span>
#include <string>

#include "planes_for_test.h"
#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/job/check.h"
#include "zoneplate/job/option_values.h"
#include "zoneplate/job/render_job.h"
#include "zoneplate/math/random.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/stream/streamed_backend.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/default_lights.h"
#include "zoneplate/scene/fit.h"
#include "zoneplate/scene/stream/mesh_stream_for_test.h"

namespace zoneplate {
namespace {

/// Triangles of any size through each other, around the camera too, several at the same place. Their alpha varies.
Scene crossing_triangles(AlphaMode alpha = AlphaMode::Opaque) {
  Scene scene;
  scene.materials.emplace_back().double_sided = true;
  scene.materials[0].alpha_mode = alpha;
  scene.objects.push_back("crossing");
  scene.instances.push_back({});
  scene.lights = default_lights();
  Mesh& mesh = scene.meshes.emplace_back();
  std::uint32_t number = 0;
  const auto random = [&] { return 2 * unit_float(hash(number++, 11)) - 1; };
  for (int i = 0; i < 500; ++i) {
    const float3 centre{2 * random(), 2 * random(), 3 * random()};
    const float size = i % 7 == 0 ? 1.5f : 0.2f;
    for (int k = 0; k < 3; ++k) mesh.position.push_back(centre + float3{random(), random(), random()} * size);
    // Another triangle at the same place, of another colour.
    if (i % 10 == 0)
      for (int k = 0; k < 3; ++k) mesh.position.push_back(float3(mesh.position[mesh.position.size() - 3]));
  }
  for (std::uint32_t v = 0; v < mesh.position.size(); ++v) {
    mesh.index.push_back(v);
    mesh.normal.push_back(normalize({random(), random(), 1}, {0, 0, 1}));
    mesh.color.push_back({std::abs(random()), std::abs(random()), 0.5f, std::abs(random())});
    mesh.uv0.push_back({random(), random()});
  }
  return scene;
}

constexpr Planes data_planes = [] {
  Planes planes = surface_planes;
  planes.motion = planes.sample_triangles = true;
  return planes;
}();

RenderedImage draw(const PreparedScene& scene, const Camera& camera, const std::string& method,
                   const RenderSettings& settings, std::unique_ptr<Backend> backend) {
  return Renderer(scene, make_resolver(antialias::methods(), method), std::move(backend))
      .render_still(camera, settings);
}

void expect_same(const Scene& scene, const std::string& method, RenderSettings settings) {
  settings.options.width = 150, settings.options.height = 100;
  const Camera camera = fit_camera(scene, 1.5f, {});
  RenderedImage whole = draw(PreparedScene(scene), camera, method, settings, make_cpu_backend());
  const auto stream = std::make_shared<MeshStream>(scene);
  for (const StreamCapacity capacity : {StreamCapacity{.part = 7, .visible = 50}, {.part = 100, .visible = 1}, {}}) {
    SCOPED_TRACE(fmt::format("{} in parts of {}", method, capacity.part));
    RenderedImage streamed =
        draw(PreparedScene(stream->head()), camera, method, settings, make_streamed_backend(stream, capacity));
    EXPECT_TRUE(has_same_bytes(streamed.display, whole.display));
    EXPECT_TRUE(has_same_bytes(streamed.linear, whole.linear));
    EXPECT_EQ(streamed.counts.triangles, whole.counts.triangles);
    ASSERT_EQ(streamed.data.sample_triangle.size(), whole.data.sample_triangle.size());
    int plane = 0;
    Frame::for_data_planes(streamed.data, whole.data, [&](const auto& a, const auto& b) {
      EXPECT_TRUE(has_same_bytes(a, b)) << "plane " << plane;
      ++plane;
    });
  }
}

TEST(OutOfCore, PartsOfAnySizeHaveTheImageOfTheWhole) {
  for (const char* const method : {"none", "msaa:n=8", "ssaa:n=2", "smaa"})
    expect_same(crossing_triangles(), method, {.form = ImageForm::Display8});
  expect_same(crossing_triangles(), "msaa:n=4", {.planes = data_planes, .form = ImageForm::Linear});
  for (const AlphaMode alpha : {AlphaMode::Mask, AlphaMode::Blend}) {
    expect_same(crossing_triangles(alpha), "ssaa:n=2", {.form = ImageForm::Display8});
    expect_same(crossing_triangles(alpha), "msaa:n=4", {.planes = data_planes, .form = ImageForm::Linear});
  }
  RenderSettings crop{.planes = data_planes};
  crop.options.crop = Crop{13, 7, 90, 71};
  expect_same(crossing_triangles(), "fxaa", crop);
}

TEST(OutOfCore, EachMethodGivesTheSameBytesOrIsRefused) {
  const Scene scene = crossing_triangles();
  const auto stream = std::make_shared<MeshStream>(scene);
  const Camera camera = fit_camera(scene, 1.2f, {});
  const RenderSettings settings{.options = {.width = 60, .height = 50}, .planes = {.depth = true}};
  int refused = 0;
  for (const Method& method : antialias::methods()) {
    SCOPED_TRACE(std::string(method.name));
    RenderedImage streamed;
    try {
      streamed = draw(PreparedScene(stream->head()), camera, std::string(method.name), settings,
                      make_streamed_backend(stream, {.part = 50, .visible = 20}));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Usage);
      EXPECT_TRUE(contains(error.what(), "the whole scene in memory")) << error.what();
      ++refused;
      continue;
    }
    RenderedImage whole = draw(PreparedScene(scene), camera, std::string(method.name), settings, make_cpu_backend());
    EXPECT_TRUE(has_same_bytes(streamed.display, whole.display));
    EXPECT_TRUE(has_same_bytes(streamed.data.depth, whole.data.depth));
  }
  EXPECT_GT(refused, 3);
  EXPECT_LT(refused, static_cast<int>(antialias::methods().size()) - 10);
}

/// A wavy closed surface of 2 rows × columns triangles, with folds that hide each other.
class Waves {
 public:
  explicit Waves(std::uint32_t rows, std::uint32_t columns) : rows_(rows), columns_(columns) {}

  std::uint32_t vertices() const { return (rows_ + 1) * columns_; }
  std::uint32_t triangles() const { return 2 * rows_ * columns_; }
  float3 vertex(std::uint32_t v) const {
    const auto wave = [](float t) { return 4 * t * (1 - t); };
    const auto part = [](float x) { return x - std::floor(x); };
    const float across = static_cast<float>(v % columns_) / static_cast<float>(columns_);
    const float along = static_cast<float>(v / columns_) / static_cast<float>(rows_);
    const float radius = 1 + 0.3f * wave(part(8 * along + 2 * across)) + 0.002f * unit_float(hash(v));
    const float x = 2 * wave(part(across)) - 1, z = 2 * wave(part(across + 0.25f)) - 1;
    return {radius * x, 4 * along, radius * z};
  }
  std::array<std::uint32_t, 3> triangle(std::uint32_t t) const {
    const std::uint32_t square = t / 2, row = square / columns_, column = square % columns_;
    const std::uint32_t next = (column + 1) % columns_;
    const std::uint32_t a = row * columns_ + column, b = row * columns_ + next, c = a + columns_, d = b + columns_;
    return t % 2 == 0 ? std::array{a, c, b} : std::array{b, c, d};
  }

  void save_ply(const std::filesystem::path& path) const {
    std::ofstream out(path, std::ios::binary);
    out << fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
        "z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face {}\nproperty list uchar int "
        "vertex_indices\nend_header\n",
        vertices(), triangles());
    for (std::uint32_t v = 0; v < vertices(); ++v) {
      const float3 p = vertex(v);
      const std::uint8_t color[] = {static_cast<std::uint8_t>(v / columns_), 200, static_cast<std::uint8_t>(v)};
      out.write(reinterpret_cast<const char*>(&p), sizeof p);
      out.write(reinterpret_cast<const char*>(color), sizeof color);
    }
    for (std::uint32_t t = 0; t < triangles(); ++t) {
      const auto corners = triangle(t);
      out.put(3);
      out.write(reinterpret_cast<const char*>(corners.data()), sizeof corners);
    }
  }
  void save_stl(const std::filesystem::path& path) const {
    std::ofstream out(path, std::ios::binary);
    const std::uint32_t count = triangles();
    out << std::string(80, ' ');
    out.write(reinterpret_cast<const char*>(&count), sizeof count);
    for (std::uint32_t t = 0; t < count; ++t) {
      char facet[50] = {};
      float3 corners[3];
      std::ranges::transform(triangle(t), corners, [&](std::uint32_t v) { return vertex(v); });
      std::memcpy(facet + 12, corners, sizeof corners);
      out.write(facet, sizeof facet);
    }
  }
  /// Two primitives, of flat triangles and of textured ones with normals, and a mirrored copy of both. `alpha_mode` is
  /// that of the latter.
  void save_glb(const std::filesystem::path& path, const std::string& alpha_mode = "OPAQUE") const {
    GltfMaker m;
    std::vector<float> position, normal, uv;
    std::vector<std::uint32_t> index;
    for (std::uint32_t v = 0; v < vertices(); ++v) {
      const float3 p = vertex(v), n = normalize({p.x, unit_float(hash(v, 3)), p.z}, {0, 1, 0});
      position.insert(position.end(), {p.x, p.y, p.z}), normal.insert(normal.end(), {n.x, n.y, n.z});
      uv.insert(uv.end(), {p.x + p.z, p.y});
    }
    for (std::uint32_t t = 0; t < triangles(); ++t)
      for (const std::uint32_t v : triangle(t)) index.push_back(v);
    const std::vector<std::uint32_t> low(index.begin(), index.begin() + index.size() / 6 * 3);
    const std::vector<std::uint32_t> high(index.begin() + static_cast<std::ptrdiff_t>(low.size()), index.end());
    const std::string positions = m.floats("VEC3", position);
    m.meshes = fmt::format(
        R"({{"primitives":[{{"attributes":{{"POSITION":{0}}},"indices":{1},"material":0}},
        {{"attributes":{{"POSITION":{0},"NORMAL":{2},"TEXCOORD_0":{3}}},"indices":{4},"material":1}}]}})",
        positions, m.values("SCALAR", low), m.floats("VEC3", normal), m.floats("VEC2", uv), m.values("SCALAR", high));
    m.nodes = R"({"mesh":0},{"mesh":0,"scale":[-1,0.5,1],"translation":[2.5,0,0]})";
    m.scene_nodes = "0,1";
    m.materials = R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0.2,0,1],"metallicFactor":0.3}},
      {"doubleSided":true,"alphaMode":")" +
                  alpha_mode + R"(","pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicFactor":0}})";
    Rgba8Image checks(8, 8);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) checks(x, y) = (x + y) % 2 == 0 ? Rgba8{255, 255, 255, 255} : Rgba8{20, 90, 200, 90};
    m.rest = R"(,"textures":[{"source":0}],"images":[{"mimeType":"image/png","bufferView":)" +
             m.view(encode_png(checks)) + "}]";
    const std::vector<std::uint8_t> bytes = m.glb();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  /// Two objects of two materials, whose normals are made.
  void save_obj(const std::filesystem::path& path, float opacity = 1) const {
    std::ofstream(path.string() + ".mtl")
        << fmt::format("newmtl red\nKd 1 0.2 0\nNs 40\nKs 1 1 1\nd {}\nnewmtl blue\nKd 0 0 1\n", opacity);
    std::ofstream out(path);
    out << fmt::format("mtllib {}.mtl\n", path.filename().string());
    for (std::uint32_t v = 0; v < vertices(); ++v) {
      const float3 p = vertex(v);
      out << fmt::format("v {} {} {}\nvt {} {}\n", p.x, p.y, p.z, p.x, p.y);
    }
    for (std::uint32_t t = 0; t < triangles(); ++t) {
      if (t % 5000 == 0) out << fmt::format("o half{}\nusemtl {}\n", t / 20000, t % 10000 == 0 ? "red" : "blue");
      out << "f";
      for (const std::uint32_t v : triangle(t)) out << fmt::format(" {0}/{0}", v + 1);
      out << "\n";
    }
  }

 private:
  std::uint32_t rows_, columns_;
};

class CollectedFiles : public JobSink {
 public:
  void file(int, int layer, std::span<const std::uint8_t> bytes) override {
    files[layer] = {bytes.begin(), bytes.end()};
  }
  void film_frame(const Rgba8Image&) override {}
  std::map<int, std::vector<std::uint8_t>> files;  ///< by data pass
};

class OutOfCoreProgram : public ProgramTest {
 protected:
  /// The files of a job under a limit of memory, and whether its triangles were read in parts.
  std::pair<std::map<int, std::vector<std::uint8_t>>, bool> files_of(Job job, std::uint64_t memory) {
    job.load.limits.memory = memory;
    check_job(job);
    CollectedFiles out;
    const Summary summary = RenderJobs().run(job, out);
    const bool is_streamed =
        std::ranges::any_of(summary.warnings, [](const std::string& w) { return contains(w, "drawn in parts"); });
    return {out.files, is_streamed};
  }
};

TEST_F(OutOfCoreProgram, AJobHasTheSameFilesWithLittleMemory) {
  const Waves waves(120, 160);
  waves.save_ply(place / "waves.ply");
  waves.save_stl(place / "waves.stl");
  waves.save_glb(place / "waves.glb");
  waves.save_glb(place / "masked.glb", "MASK"), waves.save_glb(place / "blended.glb", "BLEND");
  waves.save_obj(place / "waves.obj"), waves.save_obj(place / "blended.obj", 0.4f);
  for (const char* name :
       {"waves.ply", "waves.stl", "waves.glb", "masked.glb", "blended.glb", "waves.obj", "blended.obj"})
    for (const int view : {0, 1, 2, 3, 4}) {
      SCOPED_TRACE(fmt::format("{} {}", name, view));
      Job job;
      job.input = (place / name).string(), job.output = view == 3 ? "out.exr" : "out.png";
      job.options.width = 64, job.options.height = 48;
      job.method = "msaa:n=4";
      job.aovs = parse_aovs(view == 1 ? "depth,normal,uv,primitive-id" : "depth,material-id,primitive-id,object-id");
      if (view == 1) job.view.azimuth = 2.0f, job.view.is_orthographic = true;
      if (view == 2) job.view.position = double3{0, 2, 2.5}, job.options.crop = Crop{10, 10, 30, 20};
      if (view == 4) job.view.position = double3{0, 2, 9}, job.view.focal_point = double3{0, 2, 20};  // nothing is seen
      if (view == 3) job.shading_model = ShadingModel::MetallicRoughness, job.default_material.roughness = 0.3f;
      const auto [expected, is_whole_streamed] = files_of(job, std::uint64_t{1} << 30);
      // Of what is not opaque, the triangles behind others are needed too.
      const bool is_opaque = std::string(name).starts_with("waves");
      const auto [found, is_streamed] = files_of(job, is_opaque ? 1'200'000 : 5'000'000);
      EXPECT_FALSE(is_whole_streamed);
      EXPECT_TRUE(is_streamed);
      EXPECT_EQ(found.size(), view == 3 ? 1u : 5u);
      EXPECT_TRUE(found == expected);
    }
}

TEST_F(OutOfCoreProgram, DrawsAMillionTrianglesInAFractionOfTheirMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer takes memory of its own";
#endif
  const Waves waves(700, 800);
  waves.save_stl(place / "waves.stl");
  const auto render = [&](const std::string& options) {
    return run("render waves.stl --no-config --size 320x240 --progress none " + options);
  };
  ASSERT_EQ(render("-o whole.png").out, "");
  const ProgramAnswer parts = render("-o parts.png --max-memory 100M");
  EXPECT_EQ(parts.code, 0);
  EXPECT_TRUE(contains(parts.out, "its 1120000 triangles may take")) << parts.out;
  EXPECT_EQ(std::ranges::count(parts.out, '\n'), 1) << parts.out;
  EXPECT_EQ(text_of(place / "parts.png"), text_of(place / "whole.png"));

  // The memory that the same triangles take as a whole.
  const ProgramAnswer whole = render("-o other.png --max-memory 100M --shadows hard");
  EXPECT_EQ(whole.code, 2);
  EXPECT_TRUE(contains(whole.out, "shadows and ambient occlusion need the whole scene in memory")) << whole.out;
  EXPECT_FALSE(exists("other.png"));
  EXPECT_EQ(render("-o other.png --max-memory 2G --shadows hard").code, 0);
}

TEST_F(OutOfCoreProgram, RefusesByNameWhatNeedsTheWholeScene) {
  const Waves waves(200, 300);
  waves.save_ply(place / "waves.ply");
  for (const auto& [options, cause] : std::map<std::string, std::string>{{"--turntable 3 -o {frame}.png", "a sequence"},
                                                                         {"--exposure auto", "--exposure auto"},
                                                                         {"--aov crypto-object", "crypto-object"},
                                                                         {"--ambient-occlusion rays", "occlusion"},
                                                                         {"--aa analytic", "antialiasing method"},
                                                                         {"--aa taa", "antialiasing method"},
                                                                         {"--edges mesh", "lines along edges"},
                                                                         {"--section 1,0,0,0", "--section"}}) {
    const ProgramAnswer answer = run("render waves.ply --no-config --size 32 --max-memory 4M -o a.exr " + options);
    EXPECT_EQ(answer.code, 2) << options << ": " << answer.out;
    EXPECT_TRUE(contains(answer.out, cause)) << options << ": " << answer.out;
    EXPECT_TRUE(contains(answer.out, "error: waves.ply: ")) << options << ": " << answer.out;
    EXPECT_TRUE(contains(answer.out, "whole scene in memory, for which --max-memory is too small")) << answer.out;
  }
}

/// ctest -C Long
TEST_F(OutOfCoreProgram, DISABLED_TenMillionTrianglesHaveTheImageOfTheWhole) {
  const Waves waves(2000, 2500);
  waves.save_stl(place / "waves.stl");
  waves.save_ply(place / "waves.ply");
  for (const std::string name : {"waves.stl", "waves.ply"})
    for (const char* options : {"", "--aa msaa:n=8"}) {
      const std::string common = fmt::format("render {} --size 1920x1080 --no-config --quiet {} ", name, options);
      ASSERT_EQ(run(common + "-o whole.png --max-memory 8G").out, "");
      ASSERT_EQ(run(common + "-o parts.png --max-memory 500M").out, "");
      EXPECT_EQ(text_of(place / "parts.png"), text_of(place / "whole.png")) << name << options;
    }
}

}  // namespace
}  // namespace zoneplate
