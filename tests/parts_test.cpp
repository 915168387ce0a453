// SPDX-License-Identifier: Apache-2.0
// An image whose triangles several ranks draw has the bytes of one process: every number of ranks, every distribution,
// every kind of surface and every method.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "planes_for_test.h"
#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/base/ranks/ranks_for_test.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/frame_parts.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/default_lights.h"
#include "zoneplate/scene/fit.h"

namespace zoneplate {
namespace {

constexpr int image_width = 150, image_height = 100;
constexpr float aspect = static_cast<float>(image_width) / image_height;
constexpr int counts_of_ranks[] = {1, 2, 3, 5, 8};
constexpr Partition partitions[] = {Partition::Node, Partition::Index, Partition::Interleaved};
constexpr const char* partition_names[] = {"node", "index", "interleaved"};

constexpr Planes all_data = [] {
  Planes planes = surface_planes;
  planes.mip_level = planes.anisotropy = planes.sample_triangles = true;
  return planes;
}();

/// A chequer whose odd squares are transparent.
TextureImage chequer() {
  Rgba8Image image(32, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      image(x, y) = {static_cast<std::uint8_t>(40 + 6 * x), static_cast<std::uint8_t>(255 - 6 * y), 90,
                     static_cast<std::uint8_t>((x / 4 + y / 4) % 2 ? 30 : 230)};
  return {"chequer", std::move(image)};
}

/// Triangles of any size through each other, around the camera too: opaque, alpha-tested, blended; lines and points;
/// and several at the same place, where the first one counts.
Scene soup() {
  Scene scene;
  scene.images.push_back(chequer());
  for (const AlphaMode mode : {AlphaMode::Opaque, AlphaMode::Mask, AlphaMode::Blend, AlphaMode::Opaque}) {
    Material& material = scene.materials.emplace_back();
    material.alpha_mode = mode;
    material.double_sided = scene.materials.size() != 4;
    material.base_color = {0.3f * static_cast<float>(scene.materials.size()), 0.5f, 0.4f,
                           mode == AlphaMode::Blend ? 0.6f : 1.0f};
    if (mode != AlphaMode::Opaque) material.base_color_texture.image = 0;
  }
  std::uint32_t number = 0;
  const auto random = [&] { return 2 * unit_float(hash(number++, 7)) - 1; };
  for (int m = 0; m < 4; ++m) {
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.material = m;
    for (int i = 0; i < 90; ++i) {
      const float3 centre{2 * random(), 2 * random(), 3 * random()};
      const float size = i % 5 == 0 ? 1.5f : 0.2f;
      for (int k = 0; k < 3; ++k) {
        mesh.index.push_back(static_cast<std::uint32_t>(mesh.position.size()));
        mesh.position.push_back(centre + float3{random(), random(), random()} * size);
        mesh.normal.push_back({0, 0, 1});
        mesh.uv0.push_back({random(), random()});
      }
    }
    // Ties of depth: each of some triangles again, and for one kind in another colour.
    for (std::uint32_t i = 0; i < 30; ++i) mesh.index.push_back(mesh.index[6 * (i / 3) + i % 3]);
    if (m == 3) mesh.position = scene.meshes[0].position;
    for (int copy = 0; copy < 2; ++copy) {
      scene.objects.push_back("object");
      Instance& instance = scene.instances.emplace_back();
      instance.mesh = m, instance.object = static_cast<int>(scene.objects.size()) - 1;
      if (copy == 1) instance.world_from_object = translation({0.5f, 0, -0.5f});
    }
    scene.instances.push_back(scene.instances.back());
  }
  for (const Topology topology : {Topology::Lines, Topology::Points}) {
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.topology = topology;
    for (std::uint32_t i = 0; i < 80; ++i) {
      mesh.index.push_back(i);
      mesh.position.push_back({2 * random(), 2 * random(), 2 * random()});
    }
    Instance& instance = scene.instances.emplace_back();
    instance.mesh = static_cast<int>(scene.meshes.size()) - 1;
  }
  scene.lights = default_lights();
  light_unlit(scene);
  return scene;
}

/// Six blended spheres, one in the other, cut anywhere by the ranks; and an opaque one inside.
Scene shells() {
  Scene scene;
  for (int s = 0; s < 7; ++s) {
    Material& material = scene.materials.emplace_back();
    material.alpha_mode = s == 0 ? AlphaMode::Opaque : AlphaMode::Blend;
    material.double_sided = true;
    material.base_color = {0.2f + 0.1f * static_cast<float>(s), 0.9f - 0.1f * static_cast<float>(s), 0.5f, 0.35f};
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.material = s;
    constexpr int rows = 12, columns = 24;
    const float radius = 0.4f + 0.1f * static_cast<float>(s);
    for (int i = 0; i <= rows; ++i)
      for (int j = 0; j <= columns; ++j) {
        const float a = 3.14159265f * static_cast<float>(i) / rows, b = 6.2831853f * static_cast<float>(j) / columns;
        const float3 n{sin(a) * cos(b), cos(a), sin(a) * sin(b)};
        mesh.position.push_back(n * radius), mesh.normal.push_back(n);
      }
    for (std::uint32_t i = 0; i < rows; ++i)
      for (std::uint32_t j = 0; j < columns; ++j) {
        const std::uint32_t v = i * (columns + 1) + j, below = v + columns + 1;
        for (const std::uint32_t k : {v, below, v + 1, v + 1, below, below + 1}) mesh.index.push_back(k);
      }
    scene.objects.push_back("shell");
    Instance& instance = scene.instances.emplace_back();
    instance.mesh = instance.object = s;
  }
  scene.lights = default_lights();
  light_unlit(scene);
  return scene;
}

struct Case {
  std::string name, method;
  RenderSettings settings;
  int frames = 1;  ///< the last one is compared
};

RenderSettings settings_for(ImageForm form, Planes planes = {}) {
  return {.options = {.width = image_width, .height = image_height}, .planes = planes, .form = form};
}

void expect_same(RenderedImage& a, RenderedImage& b) {
  EXPECT_TRUE(has_same_bytes(a.display, b.display));
  EXPECT_TRUE(has_same_bytes(a.display16, b.display16));
  EXPECT_TRUE(has_same_bytes(a.linear, b.linear));
  ASSERT_EQ(a.data.sample_triangle.size(), b.data.sample_triangle.size());
  int plane = 0;
  Frame::for_data_planes(a.data, b.data, [&](const auto& p, const auto& q) {
    EXPECT_TRUE(has_same_bytes(p, q)) << "plane " << plane;
    ++plane;
  });
}

RenderedImage draw(const PreparedScene& scene, const Case& of, std::unique_ptr<Backend> backend) {
  const Camera camera = fit_camera(scene.scene(), aspect, {});
  Renderer renderer(scene, make_resolver(antialias::methods(), of.method), std::move(backend));
  for (int frame = 1; frame < of.frames; ++frame) renderer.render(camera, of.settings);
  return renderer.render(camera, of.settings);
}

/// The pixels that differ from the first one.
std::ptrdiff_t visible_pixels(const RenderedImage& image) {
  const auto count = [](const auto& plane) {
    const auto values = plane.values();
    return std::ranges::count_if(values, [&](const auto& c) { return !(c == values[0]); });
  };
  return image.linear.empty() ? count(image.display) : count(image.linear);
}

/// Renders by ranks in threads, and compares rank 0's image with that of one process.
void expect_same_by_ranks(const PreparedScene& scene, const Case& of, RenderedImage& whole, int count,
                          Partition partition) {
  SCOPED_TRACE(of.name + " " + of.method + " " + std::to_string(count) + " ranks, " +
               partition_names[static_cast<int>(partition)]);
  RenderedImage merged;
  ThreadRanks(count).run([&](Ranks& ranks) {
    with_threads(1, [&] {
      RenderedImage own = draw(scene, of, make_cpu_backend(FrameParts{.ranks = ranks, .partition = partition}));
      if (ranks.rank() == 0) merged = std::move(own);
    });
  });
  expect_same(merged, whole);
}

void expect_same_everywhere(const PreparedScene& scene, const Case& of) {
  RenderedImage whole = draw(scene, of, make_cpu_backend());
  EXPECT_GT(visible_pixels(whole), image_width * image_height / 10);
  for (const int count : counts_of_ranks)
    for (const Partition partition : partitions) expect_same_by_ranks(scene, of, whole, count, partition);
}

TEST(Parts, TheImageOfAnyKindOfSurfaceIsThatOfOneProcess) {
  const PreparedScene scene(soup());
  for (const char* const method : {"none", "msaa:n=8", "ssaa:n=2"})
    expect_same_everywhere(scene, {"soup", method, settings_for(ImageForm::Display8)});
  expect_same_everywhere(scene, {"soup", "msaa:n=4", settings_for(ImageForm::Linear)});
}

TEST(Parts, SixShellsThatRanksCutAreComposited) {
  const PreparedScene scene(shells());
  for (const char* const method : {"none", "msaa:n=8", "ssaa:n=2"})
    expect_same_everywhere(scene, {"shells", method, settings_for(ImageForm::Linear)});
}

TEST(Parts, DataPassesAreThoseOfOneProcess) {
  const PreparedScene scene(soup());
  for (const char* const method : {"none", "msaa:n=8", "ssaa:n=5"})  // 25 samples take two passes
    expect_same_everywhere(scene, {"soup", method, settings_for(ImageForm::Linear, all_data)});
}

TEST(Parts, EveryMethodGivesTheSameBytes) {
  const PreparedScene scene(soup());
  for (const Method& method : antialias::methods()) {
    Case of{"soup", std::string(method.name), settings_for(ImageForm::Display8, {.depth = true, .coverage = true})};
    of.frames = 2;
    of.settings.options.width = 70, of.settings.options.height = 66;
    RenderedImage whole = draw(scene, of, make_cpu_backend());
    expect_same_by_ranks(scene, of, whole, 3, Partition::Interleaved);
  }
}

TEST(Parts, ShadowsUseTheWholeSceneOnEveryRank) {
  const PreparedScene scene(soup());
  Case of{"shadows", "msaa", settings_for(ImageForm::Display8)};
  of.settings.options.shadows.method = ShadowMethod::Hard;
  of.settings.options.occlusion.samples = 4;
  RenderedImage whole = draw(scene, of, make_cpu_backend());
  expect_same_by_ranks(scene, of, whole, 3, Partition::Interleaved);
}

TEST(Parts, ACropHasTheBytesOfOneProcess) {
  const PreparedScene scene(soup());
  Case of{"crop", "msaa", settings_for(ImageForm::Display8, all_data)};
  of.settings.options.crop = Crop{13, 7, 90, 71};
  RenderedImage whole = draw(scene, of, make_cpu_backend());
  for (const int count : {2, 5}) expect_same_by_ranks(scene, of, whole, count, Partition::Interleaved);
}

TEST(Parts, SmallCapacitiesChangeNothing) {
  const PreparedScene scene(shells());
  Case of{"capacities", "msaa", settings_for(ImageForm::Linear)};
  RenderedImage whole = draw(scene, of, make_cpu_backend());
  of.settings.options.capacity = {.layer_samples = 50, .screen_vertices = 100};
  for (const int count : {1, 3}) expect_same_by_ranks(scene, of, whole, count, Partition::Interleaved);
}

TEST(Parts, AFieldOfSmallTrianglesIsThatOfOneProcess) {
  Scene sphere = *make_builtin_scene("sphere:triangles=20000");
  if (sphere.lights.empty()) sphere.lights = default_lights();
  light_unlit(sphere);
  const PreparedScene scene(std::move(sphere));
  expect_same_everywhere(scene, {"sphere", "msaa:n=4", settings_for(ImageForm::Display8, {.primitive_id = true})});
}

}  // namespace
}  // namespace zoneplate
