// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/backend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "zoneplate/image/tonemap.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/fit.h"

namespace zoneplate {
namespace {

constexpr int width = 32, height = 24;

/// A device that does not rasterize: every pixel has one colour. It records what it receives.
class FlatBackend : public Backend {
 public:
  struct Log {
    std::vector<std::size_t> samples;  ///< of each frame
    int recycled = 0;
  };
  explicit FlatBackend(Log& log) : log_(log) {}

  Frame render(const PreparedScene&, const Camera&, const Request& request, const RenderOptions& options,
               RenderCounts* counts) override {
    log_.samples.push_back(request.samples.size());
    Frame frame;
    frame.color = LinearImage(options.width, options.height, Linear{0.25f, 0.5f, 1, 1});
    if (request.writes_display8) frame.display8 = Rgba8Image(options.width, options.height, Rgba8{137, 188, 255, 255});
    if (counts) *counts = {.vertices = 7, .shaded = 11};
    return frame;
  }
  void recycle(Rgba8Image) override { ++log_.recycled; }

 private:
  Log& log_;
};

/// Eight samples per pixel and, if `filters`, a filter of the display-referred image that swaps red and blue.
class Method8 : public Resolver {
 public:
  explicit Method8(bool filters) : filters_(filters) {}
  Request request(const FrameContext&) override {
    return {.samples = standard_pattern(8), .resolves_per_pixel = !filters_, .is_display_referred = filters_};
  }
  DisplayImage post_process(DisplayImage image, const Frame&) override {
    for (Display& c : image.values()) std::swap(c.r, c.b);
    return image;
  }

 private:
  bool filters_;
};

TEST(Backend, RendersTheFramesOfARendererInPlaceOfTheProcessor) {
  FlatBackend::Log log;
  const Scene scene = *make_builtin_scene("triangles");
  const Camera camera = choose_camera(scene, {}, 4.0f / 3);
  for (const bool filters : {false, true}) {
    Renderer renderer(PreparedScene(scene), std::make_unique<Method8>(filters), std::make_unique<FlatBackend>(log));
    RenderedImage image = renderer.render(camera, {.options = {.width = width, .height = height}});
    ASSERT_EQ(image.display.width(), width);
    const Rgba8 expected = filters ? Rgba8{255, 188, 137, 255} : Rgba8{137, 188, 255, 255};
    for (const Rgba8 c : image.display.values()) ASSERT_EQ(c, expected);
    EXPECT_EQ(image.counts.vertices, 7u);
    EXPECT_EQ(image.counts.shaded, 11u);
    renderer.recycle(std::move(image.display));
  }
  EXPECT_EQ(log.samples, (std::vector<std::size_t>{8, 8}));
  EXPECT_EQ(log.recycled, 2);
}

TEST(Backend, OfTheProcessorGivesTheBitsOfRender) {
  const PreparedScene scene(*make_builtin_scene("triangles"));
  const Camera camera = choose_camera(scene.scene(), {}, 4.0f / 3);
  const Request request{.samples = standard_pattern(4)};
  const RenderOptions options{.width = width, .height = height};
  const std::unique_ptr<Backend> backend = make_cpu_backend();
  for (int frame = 0; frame < 2; ++frame)
    EXPECT_EQ(backend->render(scene, camera, request, options, nullptr).color,
              render(scene, camera, request, options).color);
}

/// Counts the pixels whose reversed depth is not the one to which the context's camera maps their distance.
class DepthChecker : public Resolver {
 public:
  struct Counts {
    int right = 0, wrong = 0;
  };
  explicit DepthChecker(Counts& counts) : counts_(counts) {}
  Request request(const FrameContext& context) override {
    context_ = context;
    Request request;
    request.planes.depth = true;
    return request;
  }
  LinearImage resolve(Frame& frame) override {
    const float4x4 clip = context_.camera.clip_from_camera(aspect_of(context_));
    for (std::size_t i = 0; i < frame.depth.values().size(); ++i) {
      const float distance = frame.depth.values()[i];
      if (!std::isfinite(distance)) continue;
      const float4 at = clip * float4{0, 0, -distance, 1};
      const float expected = at.z / at.w, found = frame.reversed_depth.values()[i];
      ++(std::abs(found - expected) <= 1e-4f * expected ? counts_.right : counts_.wrong);
    }
    return std::move(frame.color);
  }

 private:
  Counts& counts_;
  FrameContext context_;
};

TEST(FrameContext, ItsCameraHasTheDepthsOfTheFrame) {
  Scene scene = *make_builtin_scene("teapot:divisions=4");
  light_unlit(scene);
  const Camera camera = fit_camera(scene, 1.5f, {});
  for (const GroundKind ground : {GroundKind::None, GroundKind::Shadow}) {
    RenderSettings settings{.options = {.width = 60, .height = 40}};
    settings.options.shadows.method = ShadowMethod::Hard;
    settings.options.ground = ground;
    DepthChecker::Counts counts;
    Renderer renderer(PreparedScene(scene), std::make_unique<DepthChecker>(counts));
    renderer.render(camera, settings);
    renderer.render(camera, settings);
    EXPECT_GT(counts.right, 500);
    EXPECT_EQ(counts.wrong, 0) << static_cast<int>(ground);
  }
}

}  // namespace
}  // namespace zoneplate
