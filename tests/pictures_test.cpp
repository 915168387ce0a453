// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/golden_for_test.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/default_lights.h"

namespace zoneplate {
namespace {

/// An image of a built-in scene with its own camera, or else the whole of it, lit if it has no lights.
struct Shot {
  PreparedScene scene;
  Camera camera;
  RenderOptions options;
  explicit Shot(const std::string& name, int width = 96, int height = 72) : scene(lit(name)) {
    options.width = width, options.height = height;
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    const Scene& s = scene.scene();
    camera = s.cameras.empty() ? fit_camera(s.bounds(), aspect, {}) : s.cameras[0];
  }
  static PreparedScene lit(const std::string& name) {
    Scene scene = *make_builtin_scene(name);
    if (scene.lights.empty()) {
      scene.lights = default_lights();
      scene.environment.color = {default_environment, default_environment, default_environment};
    }
    return PreparedScene(std::move(scene));
  }
  /// The first round of the method.
  Frame frame(const std::string& method, Planes planes = {}) const {
    Request request = make_resolver(antialias::methods(), method)->request({});
    request.planes = planes;
    return render(scene, camera, request, options);
  }
};

struct Golden {
  const char* scene;
  const char* method;
  std::uint64_t hash;
};

/// Changed bits are a reviewed change: the test prints the new hashes.
constexpr Golden goldens[] = {
    {"teapot", "none", 0x36d6ab9da33554beu},
    {"teapot", "msaa:n=4", 0x8d290cf7ed232fb6u},
    {"teapot", "ssaa:n=3", 0xa61c4c3b43337313u},
    {"checkerboard", "msaa:n=8", 0xdfd8d2e528edbe9du},
    {"checkerboard", "ssaa:pattern=halton,samples=24", 0x6d37e74e1b328214u},
    {"triangles", "msaa:grid=4", 0x3eb3916ef6c22d66u},
    {"cyclic", "msaa:n=2", 0x92f5bb4b933c32cu},
    {"sphere:triangles=5000", "msaa:n=16", 0x7ae16a666539cf8du},
    {"city-trilinear", "msaa:n=4", 0x672f128d3fec74ccu},
    {"fillblend", "msaa:n=4", 0xc23b4abc086ad0bfu},
};

TEST(Pictures, TenPicturesHaveTheirBits) {
  for (const Golden& g : goldens)
    expect_golden(std::string(g.scene) + ' ' + g.method, Shot(g.scene).frame(g.method).color, g.hash);
}

/// How light is shown: over the usual grey, over nothing, or by a tone curve.
enum class Look { Plain, Transparent, Aces, Neutral };

DisplayOptions display_of(Look look) {
  DisplayOptions display{.is_transparent = look == Look::Transparent, .background = {0.2f, 0.2f, 0.2f, 1}};
  if (look == Look::Aces) display.mapping = ToneMapping::Aces;
  if (look == Look::Neutral) display.mapping = ToneMapping::Neutral;
  return display;
}

struct ShownGolden {
  const char *scene, *method;
  Look look;
  int width, height;
  std::uint64_t hash;
};

/// Masked surfaces in every way, anisotropic and mipmapped textures, tone curves, blended layers, shared samples and
/// filters of the shown image, at sizes that end within tiles and vectors. Changed bits are a reviewed change.
constexpr ShownGolden shown_goldens[] = {
    {"foliage", "none", Look::Plain, 97, 61, 0xe72413720a9fe7bu},
    {"foliage", "msaa:n=4", Look::Plain, 97, 61, 0xaf2085241a36460u},
    {"foliage", "msaa:n=4,alpha=samples", Look::Plain, 97, 61, 0x147630f0f77f5f8bu},
    {"foliage", "msaa:n=8,alpha=coverage", Look::Transparent, 33, 17, 0xfddd2af2e15f2942u},
    {"foliage", "msaa:n=4,alpha=sharp", Look::Aces, 97, 61, 0xf64e8c86b607ec70u},
    {"foliage", "ssaa:n=2,resolve=karis", Look::Neutral, 33, 17, 0xd473b1c03c9fb6f9u},
    {"foliage", "smaa", Look::Plain, 97, 61, 0x751d87f8fb27f53cu},
    {"city", "none", Look::Plain, 256, 144, 0xa5e7a3482f738123u},
    {"city", "msaa:n=4", Look::Plain, 97, 61, 0xc6945b55fbfb7a4u},
    {"city", "ssaa:n=2", Look::Aces, 33, 17, 0x30fcad2f272c91f0u},
    {"city", "fxaa:preset=39", Look::Plain, 97, 61, 0xe654ff4b5a984918u},
    {"metal", "msaa:n=4", Look::Aces, 97, 61, 0x24568127db0fcac0u},
    {"metal", "msaa:n=2,filter=mitchell", Look::Neutral, 97, 61, 0x28c477096b3ec3e2u},
    {"sun-roof", "msaa:n=8,resolve=max3", Look::Neutral, 33, 17, 0x52a04c562a1886edu},
    {"sun-roof", "csaa", Look::Aces, 97, 61, 0xeacecddfaa1f8fe4u},
    {"tiles", "quincunx", Look::Plain, 97, 61, 0xd998fc8c49b88c42u},
    {"fillblend", "none", Look::Transparent, 97, 61, 0xf24f79633b326660u},
    {"fillblend", "msaa:n=8", Look::Plain, 33, 17, 0x372b07dd629c3a0cu},
    {"wires", "smaa:preset=ultra", Look::Plain, 256, 144, 0x74a6215838fdb98du},
    {"near-axis", "smaa:mode=s2x", Look::Plain, 97, 61, 0xa8ae0447dc068cc4u},
    {"wheel", "smaa-exact:mode=4x", Look::Plain, 97, 61, 0xd0617c449097fb77u},
    {"thin-diagonal", "mlaa", Look::Plain, 97, 61, 0xf90fa67923f6d520u},
    {"thin-diagonal", "mlaa:kind=reshetov", Look::Transparent, 33, 17, 0x988c04161ee64b86u},
    {"teapot", "cmaa2", Look::Aces, 97, 61, 0x7f18341ce4e7a919u},
    {"text-ui:width=256,height=144", "cmaa2:preset=ultra,sharp=1", Look::Plain, 256, 144, 0xfb8db8f6f7eb72eu},
    {"cyclic", "fxaa", Look::Transparent, 33, 17, 0xb218b57210c9867bu},
    {"stars", "ddaa", Look::Neutral, 97, 61, 0x66d2a1cc307bc6c4u},
    {"triangles", "dlaa", Look::Plain, 33, 17, 0xf8b74f69221d9bc4u},
    {"crossing", "adaptive", Look::Plain, 97, 61, 0xde77670562d7d8ceu},
};

TEST(Pictures, ShownPicturesHaveTheirBitsForAnyThreadsAndInstructionSet) {
  for (const ShownGolden& g : shown_goldens) {
    Shot shot(g.scene, g.width, g.height);
    shot.options.display = display_of(g.look);
    for (const Isa isa : supported_isas())
      for (const int threads : {1, 2, 7}) {
        Rgba8Image picture;
        const auto render = [&] {
          Renderer renderer(shot.scene, make_resolver(antialias::methods(), g.method));
          picture = renderer.render(shot.camera, {.options = shot.options}).display;
        };
        with_isa(isa, [&] { with_threads(threads, render); });
        ASSERT_EQ(picture.width(), g.width);
        expect_golden(std::string(g.scene) + ' ' + g.method + ' ' + std::to_string(g.width) + ' ' +
                          std::string(name_of(isa)) + ' ' + std::to_string(threads),
                      picture, g.hash);
      }
  }
}

TEST(Pictures, ThreadsAndInstructionSetsLeaveNoTrace) {
  for (const char* name : {"teapot:divisions=6", "checkerboard", "fillblend"}) {
    const Shot shot(name, 160, 130);
    const std::uint64_t expected = hash_of(shot.frame("msaa:n=4").color);
    for (const Isa isa : supported_isas())
      for (const int threads : {1, 2, 3, 7}) {
        std::uint64_t hash = 0;
        with_isa(isa, [&] { with_threads(threads, [&] { hash = hash_of(shot.frame("msaa:n=4").color); }); });
        EXPECT_EQ(hash, expected) << name << ", " << name_of(isa) << ", " << threads;
      }
  }
}

/// A shot with all that rays decide.
Shot shadowed_shot(ShadowOptions shadows) {
  Shot shot("teapot:divisions=6", 97, 61);
  shot.options.shadows = shadows;
  shot.options.occlusion = {.samples = 5};
  shot.options.ground = GroundKind::Shadow;
  return shot;
}

TEST(Pictures, ShadowsHaveTheirBits) {
  const std::pair<ShadowOptions, std::uint64_t> shadow_goldens[] = {
      {{.method = ShadowMethod::Hard}, 0x3a8887ed43872dd8u},
      {{.method = ShadowMethod::Soft, .samples = 9, .angle = 0.2f}, 0x7044246cd7bebddeu},
      {{.method = ShadowMethod::Map, .map = {.filter = ShadowFilter::Nearest, .size = 64}}, 0xf967ccafbd03ed4bu},
      {{.method = ShadowMethod::Map, .map = {.filter = ShadowFilter::Pcf, .size = 64}}, 0xb4a614e32938e5b2u},
      {{.method = ShadowMethod::Map, .angle = 0.0523599f, .map = {.filter = ShadowFilter::Pcss, .size = 64}},
       0x2034c4bafa4f8fdcu},
      {{.method = ShadowMethod::Map, .map = {.filter = ShadowFilter::Evsm, .size = 64}}, 0x7809dd3cc54ae652u},
  };
  int number = 0;
  for (const auto& [shadows, hash] : shadow_goldens)
    expect_golden("shadows " + std::to_string(++number), shadowed_shot(shadows).frame("msaa:n=4").color, hash);
}

TEST(Pictures, CropsOfShadowsHaveTheirBits) {
  for (const int spacing : {1, 4}) {
    Shot shot = shadowed_shot({.method = ShadowMethod::Soft, .samples = 16, .spacing = spacing});
    shot.options.occlusion = {.samples = 16, .spacing = spacing};
    const Frame whole = shot.frame("msaa:n=4");
    shot.options.crop = Crop{37, 10, 50, 41};
    const Frame part = shot.frame("msaa:n=4");
    for (int y = 0; y < 41; ++y)
      for (int x = 0; x < 50; ++x) ASSERT_EQ(part.color(x, y), whole.color(37 + x, 10 + y));
  }
}

TEST(Pictures, DataPlanesDoNotChangeTheColour) {
  // With planes each pixel goes its own way, without them rows of pixels go together.
  for (const char* name : {"teapot:divisions=6", "city-trilinear", "fillblend", "cyclic"})
    for (const char* method : {"none", "msaa:n=4", "ssaa:n=2"}) {
      const Shot shot(name, 150, 130);
      EXPECT_EQ(hash_of(shot.frame(method).color), hash_of(shot.frame(method, {.depth = true, .uv = true}).color))
          << name << ", " << method;
    }
}

TEST(Pictures, WhatTilesShowIsTheDisplayedColour) {
  for (const DisplayOptions& display :
       {DisplayOptions{.mapping = ToneMapping::Aces, .background = {0.2f, 0.4f, 0.1f, 1}},
        DisplayOptions{.is_transparent = true, .background = {0, 0, 0, 1}}}) {
    Shot shot("cyclic", 150, 130);
    const Rgba8Image expected = quantize8(make_display(shot.frame("msaa:n=4").color, display));
    Request request = make_resolver(antialias::methods(), "msaa:n=4")->request({});
    request.writes_display8 = true;
    shot.options.display = display;
    const Frame frame = render(shot.scene, shot.camera, request, shot.options);
    EXPECT_TRUE(frame.color.empty());
    EXPECT_EQ(frame.display8, expected);
  }
}

TEST(Pictures, TrianglesOfTheHomeworkHaveNoBlackEdge) {
  // Where all 16 samples are covered, every channel lies between those of the two triangles.
  const Shot shot("triangles", 700, 700);
  const Frame frame = shot.frame("msaa:grid=4");
  const float low[] = {decode_srgb8(185), decode_srgb8(217), decode_srgb8(185)};
  const float high[] = {decode_srgb8(217), decode_srgb8(238), decode_srgb8(238)};
  int whole = 0, mixed = 0;
  for (const Linear& c : frame.color.values()) {
    if (c.a != 1) continue;
    ++whole;
    const float rgb[] = {c.r, c.g, c.b};
    for (int k = 0; k < 3; ++k) {
      ASSERT_GE(rgb[k], low[k] - 1e-6f);
      ASSERT_LE(rgb[k], high[k] + 1e-6f);
    }
    mixed += c.r > low[0] + 0.01f && c.r < high[0] - 0.01f;
  }
  EXPECT_GT(whole, 50000);
  EXPECT_GT(mixed, 100);
}

TEST(Pictures, CropHasTheWholePicturesBits) {
  Shot shot("teapot:divisions=8", 150, 120);
  const Frame whole = shot.frame("msaa:n=4", {.depth = true, .normal = true});
  shot.options.crop = Crop{37, 50, 70, 41};
  const Frame part = shot.frame("msaa:n=4", {.depth = true, .normal = true});
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 70; ++x) {
      ASSERT_EQ(part.color(x, y), whole.color(37 + x, 50 + y));
      ASSERT_EQ(part.depth(x, y), whole.depth(37 + x, 50 + y));
      ASSERT_EQ(part.normal(x, y), whole.normal(37 + x, 50 + y));
    }
  shot.options.crop = Crop{100, 100, 51, 10};
  EXPECT_THROW(shot.frame("none"), Error);
}

TEST(Pictures, DataPlanesSayWhatIsThere) {
  // Homework 2: the green triangle stands at z = -2, the blue one at z = -5, the eye at z = 5.
  const Shot shot("triangles", 200, 200);
  const Planes planes{.depth = true,
                      .normal = true,
                      .albedo = true,
                      .object_id = true,
                      .material_id = true,
                      .primitive_id = true,
                      .coverage = true};
  const Frame f = shot.frame("msaa:n=8", planes);
  std::set<std::uint32_t> seen;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) {
      const bool is_there = f.coverage(x, y) > 0;
      ASSERT_EQ(is_there, f.object_id(x, y) != Frame::no_id);
      ASSERT_EQ(is_there, std::isfinite(f.depth(x, y)));
      if (!is_there) continue;
      seen.insert(f.object_id(x, y) * 16 + f.material_id(x, y));
      const float d = f.depth(x, y);
      ASSERT_TRUE(std::abs(d - 7) < 1e-3f || std::abs(d - 10) < 1e-3f) << d;
      ASSERT_NEAR(std::abs(f.normal(x, y).z), 1, 1e-6);
      ASSERT_NEAR(f.albedo(x, y).x, decode_srgb8(std::abs(d - 7) < 1 ? 217 : 185), 1e-6);
      ASSERT_NEAR(f.coverage(x, y), f.color(x, y).a, 1e-6);
    }
  EXPECT_EQ(seen.size(), 2u);
}

/// The distance along the view axis of a place in the world.
float distance_of(const Shot& shot, float3 p) {
  return -(inverse(shot.camera.world_from_camera) * float4{p.x, p.y, p.z, 1}).z;
}

// However many samples a pixel has: within a surface its data are those of its centre, and depth is that of the
// position.
TEST(Pictures, DataAreOfOnePoint) {
  const Planes planes{.depth = true,
                      .normal = true,
                      .albedo = true,
                      .uv = true,
                      .primitive_id = true,
                      .coverage = true,
                      .position = true};
  for (const char* name : {"checkerboard", "teapot:divisions=6", "city"}) {
    const Shot shot(name, 160, 120);
    const Frame centre = shot.frame("none", planes);
    for (const char* method : {"msaa:n=4", "msaa:n=8", "ssaa:n=2", "ssaa:pattern=halton,samples=24", "analytic"}) {
      const Frame f = shot.frame(method, planes);
      int inside = 0, edges = 0, apart = 0;
      for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) {
          if (f.primitive_id(x, y) == Frame::no_id) continue;
          const float d = f.depth(x, y);
          apart += std::abs(distance_of(shot, f.position(x, y)) - d) > 0.002f * d;
          const bool is_inside = f.data_position(x, y) == SamplePosition{} &&
                                 f.primitive_id(x, y) == centre.primitive_id(x, y) &&
                                 f.instance(x, y) == centre.instance(x, y);
          edges += !is_inside;
          inside += is_inside;
          if (!is_inside) continue;
          ASSERT_EQ(d, centre.depth(x, y)) << name << ", " << method << ": " << x << " " << y;
          ASSERT_EQ(f.position(x, y), centre.position(x, y));
          ASSERT_EQ(f.normal(x, y), centre.normal(x, y));
          ASSERT_EQ(f.uv(x, y), centre.uv(x, y));
        }
      EXPECT_GT(inside, 1000) << name << ", " << method;
      EXPECT_GT(edges, 20) << name << ", " << method;
      // Snapped to 1/256 pixel, and seen nearly edge on, a plane lies elsewhere.
      EXPECT_LE(apart, inside / 200) << name << ", " << method;
    }
  }
}

TEST(Pictures, SamplePlanesResolveToTheColour) {
  const Shot shot("teapot:divisions=5");
  const Frame f = shot.frame("msaa:n=4", {.samples = true});
  ASSERT_EQ(f.sample_color.size(), 4u);
  for (std::size_t i = 0; i < f.color.values().size(); ++i) {
    float sum = 0;
    for (const LinearImage& s : f.sample_color) sum += s.values()[i].g;
    ASSERT_NEAR(f.color.values()[i].g, sum / 4, 1e-6);
    for (std::size_t s = 0; s < 4; ++s)
      ASSERT_EQ(f.sample_depth[s].values()[i] > 0, f.sample_triangle[s].values()[i] != Frame::no_id);
  }
}

TEST(Pictures, SupersamplingAndMultisamplingAgreeOnEdges) {
  // An unlit scene has one colour a surface, so that only coverage counts: the two methods must be the same image.
  const Shot shot("cyclic");
  const LinearImage ms = shot.frame("msaa:grid=4").color, ss = shot.frame("ssaa:n=4").color;
  for (std::size_t i = 0; i < ms.values().size(); ++i) {
    ASSERT_NEAR(ms.values()[i].r, ss.values()[i].r, 1e-6);
    ASSERT_NEAR(ms.values()[i].a, ss.values()[i].a, 1e-6);
  }
}

Scene one_mesh(Topology topology, std::vector<float3> position) {
  Scene scene;
  Mesh mesh;
  mesh.topology = topology;
  mesh.position = std::move(position);
  for (std::uint32_t i = 0; i < mesh.position.size(); ++i) mesh.index.push_back(i);
  scene.meshes.push_back(mesh);
  scene.materials.push_back({.model = ShadingModel::Unlit});
  scene.instances.push_back({});
  scene.objects.push_back("it");
  return scene;
}

/// The area of the image that is covered, in pixels, by 256 samples a pixel.
double area_of(const Scene& scene, const Camera& camera, const RenderOptions& options) {
  const Request request{.samples = grid_pattern(16), .rate = Rate::Sample};
  double area = 0;
  const Frame frame = render(PreparedScene(scene), camera, request, options);
  for (const Linear& c : frame.color.values()) area += static_cast<double>(c.a);
  return area;
}

TEST(Pictures, LinesAndPointsHaveTheirWidthInPixels) {
  Camera camera;
  camera.is_orthographic = true;
  camera.half_height = 1;
  camera.near = 0.1f, camera.far = 10;
  camera.world_from_camera = translation({0, 0, 5});
  RenderOptions options;
  options.width = options.height = 100;
  options.line_width = 3, options.point_size = 4;
  // From (-0.6, -0.4) to (0.6, 0.5) on an image of 50 pixels a unit: 75 pixels long.
  EXPECT_NEAR(area_of(one_mesh(Topology::Lines, {{-0.6f, -0.4f, 0}, {0.6f, 0.5f, 0}}), camera, options), 75 * 3, 0.5);
  EXPECT_NEAR(area_of(one_mesh(Topology::Points, {{0.113f, 0.2f, 0}, {-0.5f, 0.31f, 1}}), camera, options), 2 * 16,
              0.3);
  // In perspective a line that runs past the eye is as wide as any other.
  camera = {};
  camera.near = 0.1f, camera.far = 100;
  EXPECT_NEAR(area_of(one_mesh(Topology::Lines, {{0.05f, -1, 3}, {0.05f, -1, -90}}), camera, options) / 3, 47, 3);
}

TEST(Pictures, RequestsAndSizesOutOfRangeAreRefused) {
  Shot shot("triangles");
  shot.options.width = 40000;
  EXPECT_THROW(shot.frame("none"), Error);
  shot.options.width = 0;
  EXPECT_THROW(shot.frame("none"), Error);
}

}  // namespace
}  // namespace zoneplate
