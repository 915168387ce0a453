// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/capi/arrays.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"
#include "zoneplate/zoneplate.h"

namespace zoneplate {
namespace {

struct Free {
  void operator()(zoneplate_scene* scene) const { zoneplate_scene_free(scene); }
  void operator()(zoneplate_image* image) const { zoneplate_image_free(image); }
};
using SceneHandle = std::unique_ptr<zoneplate_scene, Free>;
using ImageHandle = std::unique_ptr<zoneplate_image, Free>;

SceneHandle load(const char* name) {
  zoneplate_scene* scene = nullptr;
  EXPECT_EQ(zoneplate_scene_load(name, nullptr, &scene), ZONEPLATE_OK) << zoneplate_error_text();
  return SceneHandle(scene);
}

ImageHandle render(zoneplate_scene* scene, const zoneplate_render_options& options) {
  zoneplate_image* image = nullptr;
  EXPECT_EQ(zoneplate_render(scene, nullptr, &options, &image), ZONEPLATE_OK) << zoneplate_error_text();
  return ImageHandle(image);
}

zoneplate_array array(const ImageHandle& image, const char* name) {
  zoneplate_array out{};
  EXPECT_EQ(zoneplate_image_array(image.get(), name, &out), ZONEPLATE_OK) << zoneplate_error_text();
  return out;
}

constexpr zoneplate_render_options small = {.size = sizeof(zoneplate_render_options), .width = 96, .height = 64};

// The bytes of the C++ interface: those of the command.
std::vector<std::uint8_t> png_by_renderer(const char* name, const char* method) {
  const PreparedScene scene(load_scene(name));
  const Lighting light = make_lighting(scene.scene());
  Renderer renderer(scene.lit(light), make_resolver(antialias::methods(), method));
  const Camera camera = choose_camera(scene.scene(), {}, 96.0f / 64);
  const DisplayOptions display{.mapping = light.tone_mapping, .background = default_background};
  const RenderedImage image = renderer.render(camera, {.options = {.width = 96, .height = 64, .display = display}});
  return encode_png(image.display, {.has_alpha = false});
}

TEST(Capi, PointsHaveTheSizeOfTheOptionsOrTheUsualOne) {
  const std::string path = testing::TempDir() + "zoneplate_capi_points.obj";
  std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\np 1 2 3 4\n";
  const SceneHandle scene = load(path.c_str());
  std::remove(path.c_str());
  zoneplate_render_options options = small;
  options.width = options.height = 400;
  options.method = "none";
  options.passes = "coverage";
  const auto area = [&](float point_size) {
    options.point_size = point_size;
    const ImageHandle image = render(scene.get(), options);
    const auto* const coverage = static_cast<const float*>(array(image, "coverage").data);
    return std::count_if(coverage, coverage + 400 * 400, [](float part) { return part > 0; });
  };
  EXPECT_EQ(area(0), 4 * 4 * 4);
  EXPECT_EQ(area(1), 4);
  options.point_size = -1;
  zoneplate_image* image = nullptr;
  EXPECT_EQ(zoneplate_render(scene.get(), nullptr, &options, &image), ZONEPLATE_USAGE);
}

TEST(Capi, DimsBrightLightsOfAFileAsTheCommandDoes) {
  const std::string path = testing::TempDir() + "zoneplate_capi_bright.gltf";
  std::ofstream(path) << bright_gltf();
  const SceneHandle scene = load(path.c_str());
  std::remove(path.c_str());
  const auto middle = [&](const zoneplate_render_options& options) {
    const ImageHandle image = render(scene.get(), options);
    const zoneplate_array color = array(image, "color");
    return static_cast<const std::uint8_t*>(
        color.data)[color.shape[0] / 2 * color.strides[0] + color.shape[1] / 2 * color.strides[1]];
  };
  zoneplate_render_options options = small;
  const int usual = middle(options);
  EXPECT_TRUE(usual > 200 && usual < 255) << usual;
  const float intensity = 1;
  options.light_intensity = &intensity;
  EXPECT_EQ(middle(options), 255);
  options = small, options.exposure = -1;
  EXPECT_EQ(middle(options), 255);
}

TEST(Capi, RendersTheBytesOfTheRenderer) {
  for (const char* method : {"msaa:n=8", "smaa"}) {
    zoneplate_render_options options = small;
    options.method = method;
    const ImageHandle image = render(load("teapot").get(), options);
    zoneplate_image* encoded = nullptr;
    ASSERT_EQ(zoneplate_image_encode(image.get(), "png", &encoded), ZONEPLATE_OK);
    const ImageHandle bytes(encoded);
    const zoneplate_array file = array(bytes, "bytes");
    const auto* const first = static_cast<const std::uint8_t*>(file.data);
    EXPECT_EQ(std::vector(first, first + file.shape[0]), png_by_renderer("teapot", method)) << method;
  }
}

// The formats without alpha refuse it in files and in memory alike, and take the image over a background.
TEST(Capi, FormatsWithoutAlphaRefuseIt) {
  const SceneHandle scene = load("teapot");
  const auto check = [&](const ImageHandle& image, const char* format, zoneplate_status expected) {
    const std::string path = testing::TempDir() + "zoneplate_capi_alpha." + format;
    const auto has_refused = [&](zoneplate_status status, const std::string& name) {
      EXPECT_EQ(status, expected) << name;
      if (expected == ZONEPLATE_OK) return;
      EXPECT_TRUE(std::string(zoneplate_error_text()).starts_with(name + ": the image is not opaque, and "))
          << zoneplate_error_text();
    };
    has_refused(zoneplate_image_save(image.get(), path.c_str()), path);
    EXPECT_EQ(std::ifstream(path).good(), expected == ZONEPLATE_OK) << path;
    std::remove(path.c_str());
    zoneplate_image* bytes = nullptr;
    has_refused(zoneplate_image_encode(image.get(), format, &bytes), std::string("'") + format + "'");
    EXPECT_EQ(bytes != nullptr, expected == ZONEPLATE_OK);
    zoneplate_image_free(bytes);
  };
  zoneplate_render_options options = small;
  for (const zoneplate_status expected : {ZONEPLATE_OK, ZONEPLATE_USAGE}) {
    options.is_transparent = expected == ZONEPLATE_USAGE;
    options.form = ZONEPLATE_SRGB8;
    const ImageHandle codes = render(scene.get(), options);
    for (const char* format : {"jpg", "jpeg"}) check(codes, format, expected);
    check(codes, "webp", ZONEPLATE_OK);
    options.form = ZONEPLATE_LINEAR;
    const ImageHandle light = render(scene.get(), options);
    check(light, "pfm", expected);
    check(light, "exr", ZONEPLATE_OK);
  }
}

TEST(Capi, GivesDataPassesAsViews) {
  zoneplate_render_options options = small;
  options.passes = "depth,normal,object-id,crypto-object";
  const SceneHandle scene = load("teapot");
  const ImageHandle image = render(scene.get(), options);
  std::string names;
  for (std::size_t i = 0; i < zoneplate_image_count(image.get()); ++i)
    names += std::string(zoneplate_image_name(image.get(), i)) + ' ';
  EXPECT_EQ(names, "color depth normal object-id CryptoObject00 CryptoObject01 CryptoObject02 ");
  EXPECT_EQ(zoneplate_image_name(image.get(), 7), nullptr);

  const zoneplate_array depth = array(image, "depth"), normal = array(image, "normal"), ids = array(image, "object-id");
  EXPECT_EQ(depth.type, ZONEPLATE_FLOAT32);
  EXPECT_EQ(depth.dimensions, 2);
  EXPECT_EQ(normal.dimensions, 3);
  EXPECT_EQ(normal.shape[2], 3);
  EXPECT_EQ(normal.strides[0], 96 * 12);
  EXPECT_EQ(ids.type, ZONEPLATE_UINT32);
  const auto at = [](const zoneplate_array& a, int x, int y, int k) {
    return static_cast<const std::byte*>(a.data) + y * a.strides[0] + x * a.strides[1] + k * a.strides[2];
  };
  const auto number = [&](const zoneplate_array& a, int x, int y, int k) {
    float value;
    std::memcpy(&value, at(a, x, y, k), sizeof value);
    return value;
  };
  EXPECT_TRUE(std::isinf(number(depth, 0, 0, 0)));
  EXPECT_GT(number(depth, 48, 32, 0), 0);
  const float x = number(normal, 48, 32, 0), y = number(normal, 48, 32, 1), z = number(normal, 48, 32, 2);
  EXPECT_NEAR(x * x + y * y + z * z, 1, 1e-5);
}

// A quad of float64 positions in columns and int64 indices, as Python's libraries have them.
TEST(Capi, ReadsArraysOfAnyTypeAndStride) {
  const std::array<double, 12> by_column = {-1, 1, 1, -1, -1, -1, 1, 1, 0, 0, 0, 0};
  const std::array<std::int64_t, 6> indices = {0, 1, 2, 0, 2, 3};
  zoneplate_scene* made = nullptr;
  ASSERT_EQ(zoneplate_scene_new(&made), ZONEPLATE_OK);
  const SceneHandle scene(made);
  zoneplate_mesh mesh = {.size = sizeof mesh, .name = "quad"};
  mesh.positions = {.data = const_cast<double*>(by_column.data()),
                    .type = ZONEPLATE_FLOAT64,
                    .dimensions = 2,
                    .shape = {4, 3},
                    .strides = {8, 32}};
  mesh.indices = capi::array_of(indices.data(), ZONEPLATE_INT64, {2, 3});
  std::int32_t index = -1;
  ASSERT_EQ(zoneplate_scene_add_mesh(made, &mesh, &index), ZONEPLATE_OK) << zoneplate_error_text();
  EXPECT_EQ(index, 0);
  const double matrix[] = {2, 0, 0, 5, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1};
  ASSERT_EQ(zoneplate_scene_add_instance(made, 0, matrix, nullptr, &index), ZONEPLATE_OK);
  double low[3], high[3];
  ASSERT_EQ(zoneplate_scene_bounds(made, low, high), ZONEPLATE_OK);
  EXPECT_EQ(low[0], 3);
  EXPECT_EQ(high[0], 7);
  const char* name = nullptr;
  ASSERT_EQ(zoneplate_scene_name(made, ZONEPLATE_OBJECTS, 0, &name), ZONEPLATE_OK);
  EXPECT_STREQ(name, "quad");

  const ImageHandle image = render(made, small);
  const auto* const centre = static_cast<const std::uint8_t*>(array(image, "color").data) + 4 * (32 * 96 + 48);
  EXPECT_GT(centre[0], 0x33);
  EXPECT_EQ(zoneplate_scene_add_mesh(made, &mesh, nullptr), ZONEPLATE_USAGE);
  EXPECT_STREQ(zoneplate_error_text(), "the scene has been rendered: it cannot change");
}

TEST(Capi, ReportsErrorsAsCodesWithText) {
  zoneplate_scene* scene = nullptr;
  EXPECT_EQ(zoneplate_scene_load("missing.glb", nullptr, &scene), ZONEPLATE_INPUT);
  EXPECT_NE(std::string(zoneplate_error_text()).find("missing.glb"), std::string::npos);
  EXPECT_EQ(scene, nullptr);
  EXPECT_EQ(zoneplate_scene_load(nullptr, nullptr, &scene), ZONEPLATE_USAGE);
  EXPECT_STREQ(zoneplate_error_text(), "name: is null");

  const SceneHandle teapot = load("teapot");
  zoneplate_image* image = nullptr;
  zoneplate_render_options options = small;
  options.method = "smma";
  EXPECT_EQ(zoneplate_render(teapot.get(), nullptr, &options, &image), ZONEPLATE_USAGE);
  EXPECT_STREQ(zoneplate_error_text(), "unknown method 'smma'; did you mean 'smaa'?");
  options = small;
  options.size = sizeof options + 8;
  EXPECT_EQ(zoneplate_render(teapot.get(), nullptr, &options, &image), ZONEPLATE_USAGE);
  options = small;
  options.form = static_cast<zoneplate_form>(3);
  EXPECT_EQ(zoneplate_render(teapot.get(), nullptr, &options, &image), ZONEPLATE_USAGE);
  options = small;
  options.crop[0] = 90, options.crop[2] = 10, options.crop[3] = 10;
  EXPECT_EQ(zoneplate_render(teapot.get(), nullptr, &options, &image), ZONEPLATE_USAGE);
  options = small;
  options.width = -1;
  EXPECT_EQ(zoneplate_render(teapot.get(), nullptr, &options, &image), ZONEPLATE_USAGE);
  EXPECT_EQ(image, nullptr);
  zoneplate_scene_free(nullptr);
  zoneplate_image_free(nullptr);
}

// A header from before a member existed passes a smaller size.
TEST(Capi, TakesTheNameOfAnAnimation) {
  zoneplate_load_options options{.size = sizeof(zoneplate_load_options), .animation_name = "Run"};
  zoneplate_scene* scene = nullptr;
  EXPECT_EQ(zoneplate_scene_load("teapot", &options, &scene), ZONEPLATE_USAGE);
  EXPECT_STREQ(zoneplate_error_text(), "only glTF files have scenes, variants and animations to choose from");
  const std::int32_t index = 0;
  options.animation = &index;
  EXPECT_EQ(zoneplate_scene_load("teapot", &options, &scene), ZONEPLATE_USAGE);
  EXPECT_STREQ(zoneplate_error_text(), "zoneplate_load_options: animation and animation_name exclude each other");
}

TEST(Capi, CompletesOptionsOfAnOlderHeader) {
  zoneplate_render_options options = small;
  options.size = offsetof(zoneplate_render_options, method);
  options.method = "no such method";
  EXPECT_EQ(array(render(load("teapot").get(), options), "color").shape[1], 96);
}

TEST(Capi, RefusesArraysThatAreNoMesh) {
  zoneplate_scene* scene = nullptr;
  ASSERT_EQ(zoneplate_scene_new(&scene), ZONEPLATE_OK);
  const SceneHandle owner(scene);
  const std::array<float, 9> positions = {};
  const std::array<std::int32_t, 3> indices = {0, 1, 3};
  zoneplate_mesh mesh = {.size = sizeof mesh};
  EXPECT_EQ(zoneplate_scene_add_mesh(scene, &mesh, nullptr), ZONEPLATE_USAGE);
  EXPECT_STREQ(zoneplate_error_text(), "positions: is missing");
  mesh.positions = capi::array_of(positions.data(), ZONEPLATE_FLOAT32, {3, 3});
  mesh.indices = capi::array_of(indices.data(), ZONEPLATE_INT32, {1, 3});
  EXPECT_EQ(zoneplate_scene_add_mesh(scene, &mesh, nullptr), ZONEPLATE_USAGE);
  EXPECT_STREQ(zoneplate_error_text(), "indices: has the index 3, expected 0 to 2");
  mesh.indices.shape[1] = 2;
  EXPECT_EQ(zoneplate_scene_add_mesh(scene, &mesh, nullptr), ZONEPLATE_USAGE);
  mesh.indices = {};
  mesh.material = 1;
  EXPECT_EQ(zoneplate_scene_add_mesh(scene, &mesh, nullptr), ZONEPLATE_USAGE);
  EXPECT_STREQ(zoneplate_error_text(), "mesh: material 1 does not exist, there are 0");
}

TEST(Capi, MeasuresAndFiltersArrays) {
  const SceneHandle scene = load("teapot");
  zoneplate_render_options options = small;
  options.method = "none";
  const ImageHandle aliased = render(scene.get(), options);
  options.method = "smaa";
  const ImageHandle smooth = render(scene.get(), options);
  const zoneplate_array a = array(aliased, "color"), b = array(smooth, "color");

  zoneplate_image* made = nullptr;
  ASSERT_EQ(zoneplate_filter(&a, "smaa", &made), ZONEPLATE_OK) << zoneplate_error_text();
  const ImageHandle filtered(made);
  EXPECT_EQ(std::memcmp(array(filtered, "color").data, b.data, 96 * 64 * 4), 0);
  EXPECT_EQ(zoneplate_filter(&a, "msaa:n=4", &made), ZONEPLATE_USAGE);

  double value = 0;
  zoneplate_image *map = nullptr, *figures = nullptr;
  ASSERT_EQ(zoneplate_measure(&a, &b, "flip", &value, &map, &figures), ZONEPLATE_OK) << zoneplate_error_text();
  const ImageHandle map_owner(map), figures_owner(figures);
  EXPECT_GT(value, 0);
  EXPECT_EQ(array(map_owner, "map").shape[0], 64);
  ASSERT_EQ(zoneplate_measure(&a, &a, "mse", &value, nullptr, nullptr), ZONEPLATE_OK);
  EXPECT_EQ(value, 0);
  EXPECT_EQ(zoneplate_measure(&a, &b, "flicker", &value, nullptr, nullptr), ZONEPLATE_INPUT);

  ASSERT_EQ(zoneplate_resample(&a, 48, 32, "tent", &made), ZONEPLATE_OK) << zoneplate_error_text();
  EXPECT_EQ(array(ImageHandle(made), "color").shape[1], 48);
}

TEST(Capi, MeasuresSilhouettesAndRefusesWhatIsNotFinite) {
  std::vector<std::uint8_t> black(4 * 16 * 16, 0), nothing(4 * 16 * 16, 0);
  for (std::size_t i = 3; i < black.size(); i += 4) black[i] = 255;
  const zoneplate_array logo = capi::array_of(black.data(), ZONEPLATE_UINT8, {16, 16, 4});
  const zoneplate_array gone = capi::array_of(nothing.data(), ZONEPLATE_UINT8, {16, 16, 4});
  double value = 0;
  ASSERT_EQ(zoneplate_measure(&logo, &gone, "mse", &value, nullptr, nullptr), ZONEPLATE_OK) << zoneplate_error_text();
  EXPECT_EQ(value, 1);  // over white

  std::vector<float> light(3 * 16 * 16, 0.5f), wrong = light;
  wrong[3] = std::nanf("");
  const zoneplate_array good = capi::array_of(light.data(), ZONEPLATE_FLOAT32, {16, 16, 3});
  const zoneplate_array bad = capi::array_of(wrong.data(), ZONEPLATE_FLOAT32, {16, 16, 3});
  for (const auto& [a, b] : {std::pair(&good, &bad), std::pair(&bad, &good), std::pair(&bad, &bad)}) {
    EXPECT_EQ(zoneplate_measure(a, b, "psnr", &value, nullptr, nullptr), ZONEPLATE_INPUT);
    EXPECT_NE(std::string(zoneplate_error_text()).find("has 1 pixels with NaN"), std::string::npos);
  }
}

TEST(Capi, TransformsPlanes) {
  std::vector<float> wave(32 * 16);
  for (std::size_t i = 0; i < wave.size(); ++i) wave[i] = i % 8 < 4 ? 1.0f : 0.0f;  // a period of 8 pixels along x
  const zoneplate_array plane = capi::array_of(wave.data(), ZONEPLATE_FLOAT32, {16, 32});
  zoneplate_image* made = nullptr;
  ASSERT_EQ(zoneplate_spectrum(&plane, &made), ZONEPLATE_OK) << zoneplate_error_text();
  const ImageHandle spectrum(made);
  const auto* const magnitude = static_cast<const float*>(array(spectrum, "magnitude").data);
  EXPECT_EQ(magnitude[8 * 32 + 16], 1);  // the mean
  EXPECT_GT(magnitude[8 * 32 + 20], 0.9f);
  EXPECT_LT(magnitude[8 * 32 + 18], 0.1f);

  ASSERT_EQ(zoneplate_frequency_filter(&plane, "low", 0, 0.06, "ideal", &made), ZONEPLATE_OK) << zoneplate_error_text();
  const ImageHandle mean(made);
  EXPECT_NEAR(*static_cast<const float*>(array(mean, "color").data), 0.5, 1e-6);
  EXPECT_EQ(zoneplate_frequency_filter(&plane, "band", 0.2, 0.1, nullptr, &made), ZONEPLATE_USAGE);
}

TEST(Capi, RendersOneSceneOnSeveralThreads) {
  const SceneHandle scene = load("teapot");
  std::vector<ImageHandle> images(4);
  {
    std::vector<std::jthread> threads;
    for (ImageHandle& image : images) threads.emplace_back([&] { image = render(scene.get(), small); });
  }
  for (const ImageHandle& image : images)
    EXPECT_EQ(std::memcmp(array(image, "color").data, array(images[0], "color").data, 96 * 64 * 4), 0);
}

TEST(Capi, ListsItsCatalogues) {
  for (int catalogue = ZONEPLATE_METHODS; catalogue <= ZONEPLATE_KERNELS; ++catalogue) {
    const char *name = nullptr, *summary = nullptr;
    std::size_t count = 0;
    while (zoneplate_list(static_cast<zoneplate_catalogue>(catalogue), count, &name, &summary) == ZONEPLATE_OK) {
      EXPECT_GT(std::strlen(name), 1u);
      EXPECT_GT(std::strlen(summary), 5u);
      ++count;
    }
    EXPECT_GT(count, 5u);
  }
}

/// A pyramid of float64 positions around a place, as an instance of a mesh in those coordinates or one that moves
/// there, with a light, from a camera next to it.
struct FarPyramid {
  SceneHandle scene;
  ImageHandle image;
  zoneplate_camera camera{};
};
FarPyramid far_pyramid(double3 at, bool is_moved) {
  zoneplate_scene* made = nullptr;
  EXPECT_EQ(zoneplate_scene_new(&made), ZONEPLATE_OK);
  FarPyramid out{.scene = SceneHandle(made), .image = nullptr};
  const double light[] = {at.x + 1, at.y + 2, at.z + 3};
  const zoneplate_light lamp = {.size = sizeof lamp, .kind = ZONEPLATE_POINT, .position = light};
  EXPECT_EQ(zoneplate_scene_add_light(made, &lamp), ZONEPLATE_OK);
  std::vector<double> positions;
  for (const double3 p : {double3{0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1}, {0.5, 0.7, -0.5}}) {
    const double3 q = is_moved ? p : p + at;
    positions.insert(positions.end(), {q.x, q.y, q.z});
  }
  constexpr std::array<std::int32_t, 12> indices = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
  zoneplate_mesh mesh = {.size = sizeof mesh};
  mesh.positions = capi::array_of(positions.data(), ZONEPLATE_FLOAT64, {5, 3});
  mesh.indices = capi::array_of(indices.data(), ZONEPLATE_INT32, {4, 3});
  mesh.has_flat_normals = 1;
  EXPECT_EQ(zoneplate_scene_add_mesh(made, &mesh, nullptr), ZONEPLATE_OK) << zoneplate_error_text();
  const double matrix[] = {1, 0, 0, at.x, 0, 1, 0, at.y, 0, 0, 1, at.z, 0, 0, 0, 1};
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(zoneplate_scene_add_instance(made, 0, is_moved ? matrix : nullptr, nullptr, nullptr), ZONEPLATE_OK);
  const double eye[] = {at.x + 2, at.y + 1, at.z + 2}, focus[] = {at.x + 0.5, at.y + 0.3, at.z - 0.5};
  const zoneplate_view view = {.size = sizeof view, .position = eye, .focal_point = focus};
  EXPECT_EQ(zoneplate_scene_camera(made, &view, 1.5, &out.camera), ZONEPLATE_OK);
  zoneplate_render_options options = small;
  options.passes = "position,depth";
  zoneplate_image* image = nullptr;
  EXPECT_EQ(zoneplate_render(made, &out.camera, &options, &image), ZONEPLATE_OK) << zoneplate_error_text();
  out.image.reset(image);
  return out;
}

TEST(Capi, AFarMeshThatIsMovedBackKeepsItsShape) {
  constexpr double3 at{500000.125, 5200000.25, 300.5};
  zoneplate_scene* made = nullptr;
  ASSERT_EQ(zoneplate_scene_new(&made), ZONEPLATE_OK);
  const SceneHandle scene(made);
  const double positions[] = {at.x, at.y, at.z, at.x + 1, at.y, at.z, at.x, at.y + 0.7, at.z};
  zoneplate_mesh mesh = {.size = sizeof mesh};
  mesh.positions = capi::array_of(positions, ZONEPLATE_FLOAT64, {3, 3});
  ASSERT_EQ(zoneplate_scene_add_mesh(made, &mesh, nullptr), ZONEPLATE_OK) << zoneplate_error_text();
  const double back[] = {1, 0, 0, -at.x, 0, 1, 0, -at.y, 0, 0, 1, -at.z, 0, 0, 0, 1};
  ASSERT_EQ(zoneplate_scene_add_instance(made, 0, back, nullptr, nullptr), ZONEPLATE_OK);
  double low[3], high[3];
  ASSERT_EQ(zoneplate_scene_bounds(made, low, high), ZONEPLATE_OK);
  EXPECT_NEAR(low[1], 0, 1e-6);
  EXPECT_NEAR(high[0], 1, 1e-6);
  EXPECT_NEAR(high[1], 0.7, 1e-6);
}

TEST(Capi, ScenesFarFromTheOriginLookAsNearIt) {
  constexpr double3 at{500000.125, 5200000.25, 300.5};
  const FarPyramid near = far_pyramid({}, false);
  const auto values = [](const FarPyramid& p, const char* name, auto zero) {
    const zoneplate_array a = array(p.image, name);
    const auto* const first = static_cast<const decltype(zero)*>(a.data);
    return std::vector(first, first + a.shape[0] * a.strides[0] / static_cast<std::int64_t>(sizeof zero));
  };
  for (const bool is_moved : {false, true}) {
    const FarPyramid far = far_pyramid(at, is_moved);
    double low[3], high[3];
    ASSERT_EQ(zoneplate_scene_bounds(far.scene.get(), low, high), ZONEPLATE_OK);
    EXPECT_NEAR(low[0], at.x, 1e-6);
    EXPECT_NEAR(high[1], at.y + 0.7, 1e-6);
    EXPECT_NEAR(far.camera.world_from_camera[3], at.x + 2, 1e-6);
    EXPECT_NEAR(far.camera.world_from_camera[7], at.y + 1, 1e-6);

    const auto wanted = values(near, "color", std::uint8_t{}), found = values(far, "color", std::uint8_t{});
    int differing = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) differing += std::abs(wanted[i] - found[i]) > 1;
    EXPECT_LT(differing, 20);
    // The array of positions has floats, which are multiples of 0.5 there, and 0 in empty pixels.
    const auto near_places = values(near, "position", float{}), places = values(far, "position", float{});
    for (std::size_t i = 1; i < places.size(); i += 3) {
      if (places[i] == 0 || near_places[i] == 0) continue;
      ASSERT_NEAR(static_cast<double>(places[i]), at.y + static_cast<double>(near_places[i]), 0.26);
    }
    EXPECT_EQ(places[1], 0);
    EXPECT_GT(*std::max_element(places.begin(), places.end()), 5.1e6f);
  }
}

}  // namespace
}  // namespace zoneplate
