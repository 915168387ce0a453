// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/renderer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/default_lights.h"
#include "zoneplate/scene/fit.h"

namespace zoneplate {
namespace {

constexpr int frame_width = 96, frame_height = 72;
constexpr float aspect = 4.0f / 3;

PreparedScene prepared(const std::string& name) {
  Scene scene = *make_builtin_scene(name);
  if (scene.lights.empty()) scene.lights = default_lights();  // filtering the studio takes longer than a test
  light_unlit(scene);
  return PreparedScene(std::move(scene));
}

Camera camera_of(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene();
  return scene.cameras.empty() ? fit_camera(scene, aspect, {}) : scene.cameras[0];
}

RenderSettings settings_for(ImageForm form, Planes planes = {}) {
  return {.options = {.width = frame_width, .height = frame_height}, .planes = planes, .form = form};
}

constexpr Planes all_data{.depth = true,
                          .normal = true,
                          .albedo = true,
                          .uv = true,
                          .object_id = true,
                          .material_id = true,
                          .primitive_id = true,
                          .coverage = true,
                          .position = true};

void expect_same_data(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.albedo, b.albedo);
  EXPECT_EQ(a.uv, b.uv);
  EXPECT_EQ(a.object_id, b.object_id);
  EXPECT_EQ(a.material_id, b.material_id);
  EXPECT_EQ(a.primitive_id, b.primitive_id);
  EXPECT_EQ(a.coverage, b.coverage);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.sample_triangle, b.sample_triangle);
}

/// The camera moved to its right by a number of pixels.
Camera moved_right(Camera camera, float pixels) {
  const float world_per_pixel = 2 * camera.half_height / frame_height;
  camera.world_from_camera = camera.world_from_camera * translation({pixels * world_per_pixel, 0, 0});
  return camera;
}

/// Accumulates frames, jittered, where the surface of the last frame is found again by its motion and depth.
class Accumulation : public Resolver {
 public:
  struct Record {
    int index;
    bool is_first, has_previous;
    SamplePosition jitter;
    int accepted;
  };

  Request request(const FrameContext& context) override {
    context_ = context;
    if (context.is_first) history_ = {};
    Request request;
    request.samples = {context.jitter};
    request.planes.depth = request.planes.motion = request.planes.object_id = true;
    request.keeps_planes = true;
    return request;
  }

  LinearImage resolve(Frame& frame) override {
    int accepted = 0;
    LinearImage out = std::move(frame.color);
    if (!context_.is_first) {
      const Frame& last = *context_.previous;
      const float weight = 1 / static_cast<float>(context_.index + 1);
      for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) {
          const int from_x = x - static_cast<int>(std::lround(frame.motion(x, y).x));
          const int from_y = y - static_cast<int>(std::lround(frame.motion(x, y).y));
          if (from_x < 0 || from_x >= out.width() || from_y < 0 || from_y >= out.height()) continue;
          const bool is_seen = std::isfinite(frame.depth(x, y));
          const bool is_same = frame.object_id(x, y) == last.object_id(from_x, from_y) &&
                               (!is_seen || std::abs(frame.depth(x, y) / last.depth(from_x, from_y) - 1) < 0.05f);
          if (!is_same) continue;
          accepted += is_seen;
          out(x, y) = out(x, y) * weight + history_(from_x, from_y) * (1 - weight);
        }
    }
    history_ = out;
    records.push_back({context_.index, context_.is_first, context_.previous != nullptr, context_.jitter, accepted});
    return out;
  }

  static inline std::vector<Record> records;

 private:
  FrameContext context_;
  LinearImage history_;
};

TEST(Renderer, AMethodSeesItsSequence) {
  const PreparedScene scene = prepared("cyclic");
  Camera camera = camera_of(scene);
  camera.is_orthographic = true, camera.half_height = 2;
  Accumulation::records.clear();
  Renderer renderer(scene, std::make_unique<Accumulation>());
  const RenderSettings settings = settings_for(ImageForm::Linear);
  for (int i = 0; i < 3; ++i) renderer.render(camera, settings);
  renderer.render(moved_right(camera, 4), settings);
  renderer.begin_sequence();
  const LinearImage after_cut = renderer.render(moved_right(camera, -9), settings).linear;
  renderer.render(moved_right(camera, -9), settings);

  const std::vector<Accumulation::Record> records = Accumulation::records;
  ASSERT_EQ(records.size(), 6u);
  const int indices[] = {0, 1, 2, 3, 0, 1};
  int covered = 0;
  Renderer fresh(scene, std::make_unique<Accumulation>());
  const RenderedImage alone = fresh.render(moved_right(camera, -9), settings_for(ImageForm::Linear, {.depth = true}));
  for (const float depth : alone.data.depth.values()) covered += std::isfinite(depth);
  ASSERT_GT(covered, 500);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(records[i].index, indices[i]);
    EXPECT_EQ(records[i].is_first, indices[i] == 0);
    EXPECT_EQ(records[i].has_previous, indices[i] != 0);
    EXPECT_EQ(records[i].jitter, named_pattern("halton", 8)[static_cast<std::size_t>(indices[i])]);
    // Nearly every surface is found again, also where the camera has moved: but for edges, which the jitter crosses.
    if (indices[i] == 0) {
      EXPECT_EQ(records[i].accepted, 0);
    } else {
      EXPECT_GT(records[i].accepted, covered * 6 / 10) << i;
    }
  }
  EXPECT_EQ(after_cut, alone.linear);
}

TEST(Renderer, FramesOfAStillSceneAccumulateToTheirMean) {
  const PreparedScene scene = prepared("teapot:divisions=6");
  const Camera camera = camera_of(scene);
  const RenderSettings settings = settings_for(ImageForm::Linear);
  Accumulation::records.clear();
  Renderer renderer(scene, std::make_unique<Accumulation>());
  LinearImage last;
  for (int i = 0; i < 4; ++i) last = renderer.render(camera, settings).linear;
  std::vector<LinearImage> single;
  for (int i = 0; i < 4; ++i) {
    const Request request{.samples = {named_pattern("halton", 8)[static_cast<std::size_t>(i)]}};
    single.push_back(render(scene, camera, request, settings.options).color);
  }
  int inside = 0;
  for (int y = 0; y < frame_height; ++y)
    for (int x = 0; x < frame_width; ++x) {
      Linear sum{0, 0, 0, 0};
      for (const LinearImage& image : single) sum = sum + image(x, y) * 0.25f;
      if (sum.a == 1) inside += std::abs(sum.g - last(x, y).g) < 1e-5f;
    }
  EXPECT_GT(inside, 800);
}

TEST(Renderer, AnotherSizeBeginsASequence) {
  Accumulation::records.clear();
  const PreparedScene scene = prepared("cyclic");
  Renderer renderer(scene, std::make_unique<Accumulation>());
  RenderSettings settings = settings_for(ImageForm::Linear);
  renderer.render(camera_of(scene), settings);
  settings.options.width = frame_width / 2;
  renderer.render(camera_of(scene), settings);
  settings.options.crop = Crop{1, 2, 20, 20};
  renderer.render(camera_of(scene), settings);
  renderer.render(camera_of(scene), settings);
  std::vector<int> indices;
  for (const Accumulation::Record& record : Accumulation::records) indices.push_back(record.index);
  EXPECT_EQ(indices, (std::vector<int>{0, 0, 0, 1}));
}

/// Sixteen samples where the first round's four disagree, and a blur of the display-referred image that reads two
/// pixels beyond its own.
class TwoRounds : public Resolver {
 public:
  Request request(const FrameContext&) override {
    first_ = {};
    return {.samples = standard_pattern(4), .halo = 2};
  }
  std::optional<Request> refine(Frame& frame) override {
    if (!first_.empty()) return std::nullopt;
    first_ = std::move(frame.color);
    Request more{.samples = standard_pattern(16), .halo = 2};
    more.pixel_mask = Plane<std::uint8_t>(first_.width(), first_.height());
    for (std::size_t i = 0; i < first_.values().size(); ++i) more.pixel_mask.values()[i] = first_.values()[i].a < 1;
    return more;
  }
  LinearImage resolve(Frame& frame) override {
    for (std::size_t i = 0; i < first_.values().size(); ++i)
      if (first_.values()[i].a == 1) frame.color.values()[i] = first_.values()[i];
    return std::move(frame.color);
  }
  DisplayImage post_process(DisplayImage image, const Frame&) override {
    DisplayImage out = image;
    for (int y = 2; y < image.height() - 2; ++y)
      for (int x = 2; x < image.width() - 2; ++x) out(x, y).g = (image(x - 2, y).g + image(x + 2, y + 2).g) / 2;
    return out;
  }

 private:
  LinearImage first_;
};

// Not of blended layers, of which hidden ones are shaded or not as rows or as single points.
TEST(Renderer, DataPassesNeverShadeASecondTime) {
  for (const char* name : {"teapot:divisions=6", "city", "foliage"}) {
    const PreparedScene scene = prepared(name);
    for (const bool is_cropped : {false, true}) {
      RenderSettings settings = settings_for(ImageForm::Display8);
      if (is_cropped) settings.options.crop = Crop{20, 15, 41, 33};
      Renderer renderer(scene, std::make_unique<TwoRounds>());
      const RenderedImage plain = renderer.render(camera_of(scene), settings);
      settings.planes = all_data;
      settings.planes.sample_triangles = true;
      const RenderedImage with_data = renderer.render(camera_of(scene), settings);
      EXPECT_EQ(with_data.display, plain.display) << name;
      EXPECT_EQ(with_data.counts.shaded, plain.counts.shaded) << name;
      // The data are those of the first round, of the crop.
      const Request first{.samples = standard_pattern(4), .planes = settings.planes};
      expect_same_data(with_data.data, render(scene, camera_of(scene), first, settings.options));
      EXPECT_EQ(with_data.data.depth.width(), plain.display.width());
      EXPECT_EQ(with_data.data.x, is_cropped ? 20 : 0);
    }
  }
}

TEST(Renderer, ACropHasTheWholePicturesBits) {
  const PreparedScene scene = prepared("teapot:divisions=6");
  RenderSettings settings = settings_for(ImageForm::Display8, all_data);
  Renderer renderer(scene, std::make_unique<TwoRounds>());
  const RenderedImage whole = renderer.render(camera_of(scene), settings);
  settings.options.crop = Crop{20, 15, 41, 33};
  const RenderedImage part = renderer.render(camera_of(scene), settings);
  for (int y = 0; y < 33; ++y)
    for (int x = 0; x < 41; ++x) {
      ASSERT_EQ(part.display(x, y), whole.display(20 + x, 15 + y));
      ASSERT_EQ(part.data.normal(x, y), whole.data.normal(20 + x, 15 + y));
    }
}

TEST(Renderer, FormsAreOfOnePicture) {
  const PreparedScene scene = prepared("teapot:divisions=6");
  Renderer renderer(scene, std::make_unique<Resolver>());
  const auto image = [&](ImageForm form) { return renderer.render(camera_of(scene), settings_for(form)); };
  const RenderedImage codes = image(ImageForm::Display8), deep = image(ImageForm::Display16),
                      light = image(ImageForm::Linear), dithered = image(ImageForm::Display8Dithered);
  EXPECT_TRUE(codes.display16.empty() && codes.linear.empty() && deep.display.empty() && light.display.empty());
  ASSERT_EQ(light.linear.values().size(), codes.display.values().size());
  for (std::size_t i = 0; i < codes.display.values().size(); ++i) {
    ASSERT_NEAR(deep.display16.values()[i].g / 257.0, codes.display.values()[i].g, 0.51);
    ASSERT_LE(std::abs(dithered.display.values()[i].g - codes.display.values()[i].g), 1);
  }
}

TEST(Renderer, AnErrorThatNoMethodEstimatesIsRefused) {
  const PreparedScene scene = prepared("cyclic");
  Renderer renderer(scene, std::make_unique<Resolver>());
  EXPECT_THROW(renderer.render(camera_of(scene), settings_for(ImageForm::Display8, {.error = true})), Error);
}

TEST(Renderer, TheMeanOfMomentsIsTheirsInLinearLight) {
  const PreparedScene scene = prepared("cyclic");
  const Camera camera = camera_of(scene);
  Renderer renderer(scene, std::make_unique<Resolver>());
  const RenderSettings settings = settings_for(ImageForm::Linear);
  const Camera cameras[] = {camera, moved_right(camera, 3)};
  const LinearImage mean = renderer
                               .render_mean(
                                   2,
                                   [&](int i) {
                                     return SceneView{scene, cameras[i]};
                                   },
                                   settings)
                               .linear;
  const LinearImage a = renderer.render(cameras[0], settings).linear, b = renderer.render(cameras[1], settings).linear;
  for (std::size_t i = 0; i < mean.values().size(); ++i)
    ASSERT_EQ(mean.values()[i], (a.values()[i] + b.values()[i]) * 0.5f);
}

// What a data-only job finds is what a coloured frame has found, without any light.
TEST(DataOnly, NothingIsShaded) {
  for (const char* name : {"teapot:divisions=6", "city", "fillblend", "cyclic", "foliage", "wires"}) {
    const PreparedScene scene = prepared(name);
    const Camera camera = camera_of(scene);
    const RenderOptions options{.width = frame_width, .height = frame_height};
    for (const Rate rate : {Rate::Surface, Rate::Sample})
      for (const SamplePattern& samples : {SamplePattern{SamplePosition{}}, standard_pattern(4), grid_pattern(5)}) {
        Request colored{.samples = samples, .rate = rate, .planes = all_data};
        colored.planes.sample_triangles = true;
        Request alone = colored;
        alone.content = Content::Data;
        RenderCounts shaded, counts;
        const Frame expected = render(scene, camera, colored, options, &shaded);
        const Frame data = render(scene, camera, alone, options, &counts);
        expect_same_data(data, expected);
        EXPECT_TRUE(data.color.empty());
        EXPECT_EQ(counts.shaded, 0u);
        EXPECT_GT(shaded.shaded, 0u);
        // One point a pixel, however many samples: and where alpha is tested, those tests.
        std::uint64_t covered = 0;
        for (const std::uint32_t id : data.primitive_id.values()) covered += id != Frame::no_id;
        const bool has_masks = std::string_view(name) == "foliage";
        if (!has_masks) {
          EXPECT_EQ(counts.geometric, covered) << name;
        }

        alone.planes = {.depth = true, .object_id = true};
        const Frame ids = render(scene, camera, alone, options, &counts);
        EXPECT_EQ(ids.depth, expected.depth);
        EXPECT_EQ(ids.object_id, expected.object_id);
        if (!has_masks) {
          EXPECT_EQ(counts.geometric, 0u) << name;
        }
      }
  }
}

TEST(PreparedScene, CopiesShareWhatWasMade) {
  const PreparedScene scene = prepared("checkerboard");
  const PreparedScene dark = scene.lit({});
  EXPECT_EQ(&dark.textures(), &scene.textures());
  EXPECT_EQ(&dark.vertices(), &scene.vertices());
  EXPECT_TRUE(dark.lighting().lights.empty());
  EXPECT_FALSE(scene.lighting().lights.empty());
  const PreparedScene later(scene.scene(), scene);
  EXPECT_EQ(&later.textures(), &scene.textures());
  EXPECT_NE(&later.vertices(), &scene.vertices());
  for (const TextureImage& image : scene.scene().images) EXPECT_TRUE(image.pixels.empty());
  const RenderOptions options{.width = frame_width, .height = frame_height};
  EXPECT_EQ(render(later, camera_of(scene), {}, options).color, render(scene, camera_of(scene), {}, options).color);
}

/// A metal sphere of this roughness in an environment of one colour, given as a colour or as an image.
LinearImage sphere_in_light(float3 light, bool is_image) {
  Scene scene = *make_builtin_scene("sphere:triangles=2000");
  scene.materials[0] = {.model = ShadingModel::MetallicRoughness, .metallic = 0.5f, .roughness = 0.4f};
  scene.environment.color = light;
  if (is_image) {
    scene.environment.color = light * 0.5f;
    scene.environment.image = static_cast<int>(scene.images.size());
    scene.images.push_back({.name = "grey", .pixels = Plane<float4>(8, 4, {2, 2, 2, 1})});
  }
  const PreparedScene prepared(std::move(scene));
  return render(prepared, camera_of(prepared), {}, {.width = frame_width, .height = frame_height}).color;
}

TEST(PreparedScene, AnEnvironmentImageOfOneColourLightsAsThatColour) {
  const LinearImage plain = sphere_in_light({0.5f, 1, 0.25f}, false), image = sphere_in_light({0.5f, 1, 0.25f}, true);
  for (int y = 0; y < frame_height; ++y)
    for (int x = 0; x < frame_width; ++x) {
      ASSERT_NEAR(image(x, y).g, plain(x, y).g, 2e-4f) << x << ' ' << y;
      ASSERT_NEAR(image(x, y).b, plain(x, y).b, 1e-4f) << x << ' ' << y;
    }
}

TEST(PreparedScene, AnEnvironmentImageWithoutTexelsIsAnError) {
  Scene scene = *make_builtin_scene("sphere:triangles=100");
  scene.environment.image = static_cast<int>(scene.images.size());
  scene.images.push_back({.name = "sky"});
  EXPECT_THROW(PreparedScene(std::move(scene)), Error);
}

TEST(Lights, InCameraSpaceTurnWithTheCamera) {
  // The default lights are those that stand where the camera's axes put them.
  Scene fixed = *make_builtin_scene("teapot:divisions=4"), turning = fixed;
  light_unlit(turning);
  const Camera camera = fit_camera(fixed, aspect, {});
  fixed.environment = turning.environment, fixed.ambient_light = turning.ambient_light;
  for (const Light& light : turning.lights) fixed.lights.push_back(in_world_space(light, camera.world_from_camera));
  const RenderOptions options{.width = frame_width, .height = frame_height};
  const PreparedScene a(std::move(fixed)), b(std::move(turning));
  EXPECT_EQ(render(a, camera, {}, options).color, render(b, camera, {}, options).color);
  const Camera other = fit_camera(a.scene(), aspect, {.azimuth = 2});
  EXPECT_NE(render(a, other, {}, options).color, render(b, other, {}, options).color);
}

}  // namespace
}  // namespace zoneplate
