// SPDX-License-Identifier: Apache-2.0
// What frames without colour hold: geometry, edge distances and visibility, each against what it is made from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/render.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/facing_for_test.h"

namespace zoneplate {
namespace {

constexpr int content_width = 160, content_height = 120;

/// Triangles that face an orthographic camera whose image has a unit a pixel; (0, 0) is the image's top-left corner
/// and y goes down.
Scene flat_scene(std::vector<float3> corners, Material material = {}) {
  Mesh mesh;
  for (std::uint32_t i = 0; const float3 p : corners) {
    mesh.position.push_back({p.x - content_width / 2.0f, content_height / 2.0f - p.y, p.z});
    mesh.index.push_back(i++);
  }
  Scene scene = facing_scene(std::move(mesh), std::move(material));
  scene.cameras[0].half_height = content_height / 2.0f;
  return scene;
}

Frame frame_of(const Scene& scene, const Camera& camera, const Request& request, RenderCounts* counts = nullptr) {
  return render(PreparedScene(scene), camera, request, {.width = content_width, .height = content_height}, counts);
}

Camera camera_of(const Scene& scene) {
  return scene.cameras.empty() ? fit_camera(scene.bounds(), 4 / 3.0f, {}) : scene.cameras[0];
}

Request request_for(Content content, SamplePattern samples = {SamplePosition{}}) {
  Request request;
  request.content = content;
  request.samples = std::move(samples);
  return request;
}

TEST(EdgeDistances, AreThoseOfTheTriangleByHand) {
  // Corners on whole 1/256 pixel: the snap changes nothing.
  const double p[3][2] = {{20.25, 10.5}, {140.75, 33.125}, {61.5, 109.75}};
  std::vector<float3> corners;
  for (const auto& c : p) corners.push_back({static_cast<float>(c[0]), static_cast<float>(c[1]), 0});
  const Scene scene = flat_scene(corners);
  RenderCounts counts;
  const Frame frame = frame_of(scene, scene.cameras[0], request_for(Content::EdgeDistances), &counts);
  EXPECT_TRUE(frame.color.empty());
  EXPECT_EQ(counts.shaded, 0u);
  EXPECT_GT(counts.geometric, 3000u);
  int inside = 0;
  for (int y = 0; y < content_height; ++y)
    for (int x = 0; x < content_width; ++x) {
      double nearest = 1e9;
      bool is_along_row = false, is_inside = true;
      for (int k = 0; k < 3; ++k) {
        const double *a = p[k], *b = p[(k + 1) % 3], dx = b[0] - a[0], dy = b[1] - a[1];
        const double cx = x + 0.5, cy = y + 0.5;
        is_inside = is_inside && dx * (cy - a[1]) - dy * (cx - a[0]) > 0;
        // Where the edge's line has the pixel's y, or its x.
        const double along_row = a[0] + dx / dy * (cy - a[1]) - cx, along_column = a[1] + dy / dx * (cx - a[0]) - cy;
        const bool is_steep = std::abs(dy) > std::abs(dx);
        const double d = is_steep ? along_row : along_column;
        if (std::abs(d) < std::abs(nearest)) nearest = d, is_along_row = is_steep;
      }
      const float2 found = frame.edge_distance(x, y);
      if (!is_inside) {
        ASSERT_EQ(found, (float2{Frame::no_edge, Frame::no_edge})) << x << "," << y;
        continue;
      }
      ++inside;
      // A 16-bit float has eleven bits.
      ASSERT_NEAR(is_along_row ? found.x : found.y, nearest, std::abs(nearest) * 0x1p-11 + 1e-6) << x << "," << y;
      ASSERT_EQ(is_along_row ? found.y : found.x, Frame::no_edge) << x << "," << y;
    }
  EXPECT_GT(inside, 3000);
}

TEST(EdgeDistances, ATriangleThroughTheEyesPlaneHasItsEdges) {
  // A road to the horizon that begins behind the eye: its sides are x = ±2 at y = -1.
  Scene scene = flat_scene({});
  scene.meshes[0].position = {{-2, -1, 50}, {2, -1, 50}, {2, -1, -50}, {-2, -1, -50}};
  scene.meshes[0].normal.assign(4, {0, 1, 0});
  scene.meshes[0].index = {0, 1, 2, 0, 2, 3};
  Camera camera;
  camera.vertical_fov = 1.5707964f;
  const Frame frame = frame_of(scene, camera, request_for(Content::EdgeDistances));
  int checked = 0;
  for (int y = 70; y < 115; ++y)
    for (int x = 1; x < content_width - 1; ++x) {
      // Of the two pixels about a side of the road, that on it stores how far the side is.
      const double below = (y + 0.5 - 60) / 60, side = 80 + 2 * below * 60;
      if (side > content_width - 2 || x != static_cast<int>(side - 0.5)) continue;
      ASSERT_NEAR(frame.edge_distance(x, y).x, side - (x + 0.5), 2e-3) << x << "," << y;
      ++checked;
    }
  EXPECT_GT(checked, 20);
}

TEST(EdgeDistances, AlphaHasAnEdgeWhereItFallsToTheCutoff) {
  // Alpha falls from 1 to 0 over 160 pixels; the cutoff is reached at x = 80.3.
  Material material;
  material.alpha_mode = AlphaMode::Mask;
  material.alpha_cutoff = 1 - 80.3f / 160;
  Scene scene = flat_scene({{0, 0, 0}, {160, 0, 0}, {160, 120, 0}, {0, 0, 0}, {160, 120, 0}, {0, 120, 0}}, material);
  for (const float3 p : scene.meshes[0].position)
    scene.meshes[0].color.push_back({1, 1, 1, 1 - (p.x + content_width / 2.0f) / content_width});
  const Frame frame = frame_of(scene, scene.cameras[0], request_for(Content::EdgeDistances));
  for (int y = 3; y < content_height - 3; ++y)
    for (int x = 78; x < 83; ++x) {
      // The diagonal between the two triangles is an edge too.
      const float centre = static_cast<float>(x) + 0.5f;
      if (std::abs(static_cast<float>(y) - centre * 0.75f) < 4) continue;
      ASSERT_NEAR(frame.edge_distance(x, y).x, centre <= 80.3f ? 80.3f - centre : Frame::no_edge, 5e-3f)
          << x << "," << y;
    }
}

TEST(Geometry, OfASphereIsTheSpheres) {
  // A round one is made of the scene's bumpy one, and moved.
  Scene scene = *make_builtin_scene("sphere:triangles=200000");
  constexpr float3 centre{0.5f, -0.25f, 2};
  constexpr float radius = 2;
  for (Mesh& mesh : scene.meshes) {
    for (float3& p : mesh.position) p = normalize(p, {0, 0, 1});
    mesh.normal = mesh.position;
  }
  for (Instance& instance : scene.instances)
    instance.world_from_object.column = {
        {{0, 0, -radius, 0}, {0, radius, 0, 0}, {radius, 0, 0, 0}, {centre.x, centre.y, centre.z, 1}}};
  const Camera camera = fit_camera(scene.bounds(), 4 / 3.0f, {});
  RenderCounts counts;
  const Frame frame = frame_of(scene, camera, request_for(Content::Geometry, standard_pattern(4)), &counts);
  EXPECT_TRUE(frame.color.empty());
  EXPECT_EQ(counts.shaded, 0u);
  ASSERT_EQ(frame.sample_geometry.size(), 4u);
  const float3 eye = xyz(camera.world_from_camera.column[3]), back = xyz(camera.world_from_camera.column[2]);
  std::size_t seen = 0;
  for (const LinearImage& plane : frame.sample_geometry)
    for (const Linear& g : plane.values()) {
      const float3 normal{g.r, g.g, g.b};
      if (normal == float3{}) {
        ASSERT_EQ(g.a, 0);
        continue;
      }
      ASSERT_NEAR(dot(normal, normal), 1, 1e-5f);
      // The point of that normal on the sphere is as far along the view axis.
      ASSERT_NEAR(g.a, -dot(centre + normal * radius - eye, back), 2e-3f * radius);
      ++seen;
    }
  EXPECT_GT(seen, 15000u);
  EXPECT_EQ(counts.geometric, seen);
}

TEST(Visibility, IsWhatAColouredFrameHasSeen) {
  for (const char* name : {"cyclic", "foliage", "wires"}) {
    const Scene scene = *make_builtin_scene(name);
    Request colored = request_for(Content::Colour, standard_pattern(8));
    colored.planes.samples = true;
    Request alone = colored;
    alone.content = Content::Visibility;
    RenderCounts counts;
    const Frame a = frame_of(scene, camera_of(scene), colored);
    const Frame b = frame_of(scene, camera_of(scene), alone, &counts);
    EXPECT_EQ(a.sample_triangle, b.sample_triangle) << name;
    EXPECT_EQ(a.sample_depth, b.sample_depth) << name;
    EXPECT_TRUE(b.sample_color.empty());
    EXPECT_TRUE(b.color.empty());
    EXPECT_EQ(counts.shaded, 0u);
    alone.planes = {};
    alone.planes.sample_triangles = true;
    const Frame ids = frame_of(scene, camera_of(scene), alone);
    EXPECT_EQ(ids.sample_triangle, b.sample_triangle);
    EXPECT_TRUE(ids.sample_depth.empty());
  }
}

TEST(Content, ThreadsAndInstructionSetsLeaveNoTrace) {
  for (const char* name : {"cyclic", "foliage", "city"}) {
    const Scene scene = *make_builtin_scene(name);
    const Camera camera = camera_of(scene);
    // Seventeen samples take two passes of the tiles.
    SamplePattern many = standard_pattern(16);
    many.push_back({});
    Frame geometry, few, edges;
    with_threads(1, [&] {
      few = frame_of(scene, camera, request_for(Content::Geometry, {many.begin(), many.begin() + 5}));
      with_isa(Isa::Scalar, [&] {
        geometry = frame_of(scene, camera, request_for(Content::Geometry, many));
        edges = frame_of(scene, camera, request_for(Content::EdgeDistances));
      });
    });
    for (std::size_t s = 0; s < few.sample_geometry.size(); ++s)
      EXPECT_EQ(few.sample_geometry[s], geometry.sample_geometry[s]) << name << " " << s;
    for (const Isa isa : supported_isas())
      with_isa(isa, [&] {
        with_threads(3, [&] {
          EXPECT_EQ(frame_of(scene, camera, request_for(Content::Geometry, many)).sample_geometry,
                    geometry.sample_geometry)
              << name << " " << name_of(isa);
          EXPECT_EQ(frame_of(scene, camera, request_for(Content::EdgeDistances)).edge_distance, edges.edge_distance)
              << name << " " << name_of(isa);
        });
      });
  }
}

}  // namespace
}  // namespace zoneplate
