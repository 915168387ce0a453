// What methods that sample more than once a pixel must keep, on rendered scenes.
#include <gtest/gtest.h>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/render/picture.h"
#include "zoneplate/scene/builtin.h"

namespace zoneplate::antialias {
namespace {

struct Shot {
  LinearImage light;
  RenderCounts counts;
};

Shot shot(const Scene& scene, const std::string& method, RenderOptions options = {.width = 160, .height = 120}) {
  const std::unique_ptr<Resolver> resolver = make_resolver(methods(), method);
  Shot out;
  Frame frame =
      render_rounds(scene, scene.cameras.at(0), *resolver, resolver->ask(0), options, DisplayOptions{}, &out.counts);
  out.light = resolver->resolve(frame);
  return out;
}
Shot shot(const char* name, const std::string& method) { return shot(*make_builtin_scene(name), method); }

double greatest_difference(const LinearImage& a, const LinearImage& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) {
    const Linear p = a.values()[i], q = b.values()[i];
    for (const float d : {p.r - q.r, p.g - q.g, p.b - q.b, p.a - q.a}) most = std::max(most, std::abs(double{d}));
  }
  return most;
}

double mean_error(const LinearImage& a, const LinearImage& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i)
    sum += std::abs(double{a.values()[i].g} - double{b.values()[i].g});
  return sum / static_cast<double>(a.values().size());
}

/// One quad over the whole picture, there as far as its alpha says.
Scene veil(float alpha) {
  Scene scene;
  Material material;
  material.model = ShadingModel::Unlit;
  material.alpha_mode = AlphaMode::Mask;
  material.double_sided = true;
  material.base_color = {1, 1, 1, alpha};
  scene.materials.push_back(material);
  Mesh mesh;
  mesh.position = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
  mesh.normal.assign(4, {0, 0, 1});
  mesh.index = {0, 1, 2, 0, 2, 3};
  scene.objects.emplace_back("veil");
  scene.meshes.push_back(mesh);
  scene.instances.push_back({});
  Camera camera;
  camera.world_from_camera.column[3] = {0, 0, 5, 1};
  camera.is_orthographic = true;
  scene.cameras.push_back(camera);
  return scene;
}

TEST(Ssaa, ABoxOverThePixelIsThePlainMean) {
  // 64 samples in four rounds: their footprint is that of all together.
  for (const char* scene : {"cyclic", "checkerboard"})
    EXPECT_LT(greatest_difference(shot(scene, "ssaa:n=8").light, shot(scene, "ssaa:n=8,filter=box,radius=0.5").light),
              2e-6);
  EXPECT_EQ(shot("cyclic", "ssaa:n=8").counts.shaded, shot("cyclic", "ssaa:n=8,filter=tent").counts.shaded);
}

TEST(Ssaa, FiltersNeedARadiusOfTheirOwn) {
  EXPECT_THROW(make_resolver(methods(), "ssaa:radius=2"), Error);
  EXPECT_THROW(make_resolver(methods(), "ssaa:filter=tent,radius=5"), Error);
  EXPECT_THROW(make_resolver(methods(), "ssaa:filter=tent,radius=1.234"), Error);
  EXPECT_NO_THROW(make_resolver(methods(), "ssaa:filter=tent,radius=1.25"));
}

TEST(Adaptive, IsSupersampledWhereSamplesDisagreeAndOnlyThere) {
  const Shot own = shot("cyclic", "adaptive"), fine = shot("cyclic", "ssaa:n=4");
  const Shot coarse = shot("cyclic", "ssaa:pattern=rotated,samples=4");
  int refined = 0, plain = 0;
  for (std::size_t i = 0; i < own.light.values().size(); ++i) {
    const Linear c = own.light.values()[i];
    if (c == fine.light.values()[i] && !(c == coarse.light.values()[i])) ++refined;
    // The coarse samples' sums run in another order than the rotated grid's.
    else if (c == fine.light.values()[i] || std::abs(c.g - coarse.light.values()[i].g) < 1e-6f)
      ++plain;
  }
  EXPECT_EQ(refined + plain, 160 * 120);
  EXPECT_GT(refined, 300);
  EXPECT_LT(own.counts.shaded, fine.counts.shaded / 2);
  EXPECT_GT(own.counts.shaded, coarse.counts.shaded);
  EXPECT_LT(mean_error(own.light, fine.light), mean_error(coarse.light, fine.light) / 4);
}

TEST(Adaptive, WhereNothingDisagreesOneRoundIsEnough) {
  const Scene scene = veil(1);
  EXPECT_EQ(shot(scene, "adaptive").counts.shaded, shot(scene, "ssaa:pattern=rotated,samples=4").counts.shaded);
}

TEST(Csaa, WithASlotForEachSurfaceItIsMultisampling) {
  EXPECT_LT(greatest_difference(shot("cyclic", "csaa:n=8,slots=8").light, shot("cyclic", "msaa:n=8").light), 1e-6);
  // With two slots only pixels of three surfaces and more suffer.
  const LinearImage two = shot("cyclic", "csaa:n=8,slots=2").light, all = shot("cyclic", "msaa:n=8").light;
  int differing = 0;
  for (std::size_t i = 0; i < all.values().size(); ++i)
    differing += std::abs(all.values()[i].g - two.values()[i].g) > 1e-5f;
  EXPECT_GT(differing, 0);
  EXPECT_LT(differing, 100);
  EXPECT_THROW(make_resolver(methods(), "csaa:n=4,slots=8"), Error);
}

/// A fan of `parts` triangles around (0.3, 0.2) whose colour is a linear function of the place.
Scene slope_of(int parts) {
  Scene scene;
  Material material;
  material.model = ShadingModel::Unlit;
  material.double_sided = true;
  scene.materials.push_back(material);
  Mesh mesh;
  const auto add = [&](float x, float y) {
    mesh.position.push_back({x, y, 0});
    mesh.color.push_back({0.5f + x / 20, 0.5f + y / 20, 0.5f, 1});
  };
  add(0.3f, 0.2f);
  for (int i = 0; i < parts; ++i) {  // around the square from -9 to 9
    const float at = 4 * static_cast<float>(i) / static_cast<float>(parts), side = 18 * (at - std::floor(at)) - 9;
    const int of = static_cast<int>(at);
    add(of == 0 ? side : of == 1 ? 9 : of == 2 ? -side : -9, of == 0 ? -9 : of == 1 ? side : of == 2 ? 9 : -side);
    const auto n = static_cast<std::uint32_t>(i);
    mesh.index.insert(mesh.index.end(), {0, 1 + n, 1 + (n + 1) % static_cast<std::uint32_t>(parts)});
  }
  mesh.normal.assign(mesh.position.size(), {0, 0, 1});
  scene.objects.emplace_back("slope");
  scene.meshes.push_back(mesh);
  scene.instances.push_back({});
  Camera camera;
  camera.world_from_camera.column[3] = {0, 0, 5, 1};
  camera.is_orthographic = true;
  scene.cameras.push_back(camera);
  return scene;
}

TEST(Msaa, APlaneLooksTheSameHoweverManyTrianglesItIsMadeOf) {
  // Where a pixel is shared, places rounded to 1/256 pixel are all that differs: two pixels of the picture are 1e-3.
  for (const char* n : {"4", "8"}) {
    const std::string mean = std::string("msaa:n=") + n, first = mean + ",centroid=first";
    EXPECT_LT(greatest_difference(shot(slope_of(4), mean).light, shot(slope_of(40), mean).light), 5e-6) << n;
    EXPECT_GT(greatest_difference(shot(slope_of(4), first).light, shot(slope_of(40), first).light), 5e-5) << n;
  }
  // At the pixel's centre nothing can be seen of a plane's triangles either, but their own sides do not count.
  const std::string centre = "msaa:n=4,centroid=centre";
  EXPECT_LT(greatest_difference(shot(slope_of(4), centre).light, shot(slope_of(8), centre).light), 5e-4);
}

TEST(SharedSamples, SmoothEdgesAndKeepFlatColours) {
  const LinearImage none = shot("cyclic", "none").light, truth = shot("cyclic", "ssaa:n=16").light;
  for (const char* method : {"quincunx", "flipquad"}) {
    const LinearImage own = shot("cyclic", method).light;
    EXPECT_LT(mean_error(own, truth), 0.75 * mean_error(none, truth)) << method;
    // Away from edges nothing changes: most of the picture.
    int same = 0;
    for (std::size_t i = 0; i < own.values().size(); ++i)
      same += std::abs(own.values()[i].g - none.values()[i].g) < 1e-6f;
    EXPECT_GT(same, 160 * 120 * 9 / 10) << method;
  }
}

TEST(SharedSamples, ACropWithItsHaloIsThePartOfTheWhole) {
  const Scene scene = *make_builtin_scene("cyclic");
  for (const char* method : {"quincunx", "flipquad", "msaa:n=8,filter=mitchell", "ssaa:n=2,filter=tent", "adaptive"}) {
    const int halo = make_resolver(methods(), method)->ask(0).halo;
    const LinearImage whole = shot(scene, method).light;
    RenderOptions options{.width = 160, .height = 120};
    options.crop = Crop{51 - halo, 40 - halo, 30 + 2 * halo, 21 + 2 * halo};
    const LinearImage part = shot(scene, method, options).light;
    for (int y = 0; y < 21; ++y)
      for (int x = 0; x < 30; ++x) ASSERT_EQ(part(x + halo, y + halo), whole(51 + x, 40 + y)) << method;
  }
}

TEST(AlphaToCoverage, AsManySamplesAsAlphaSays) {
  const auto coverage = [](float alpha, const char* method) { return shot(veil(alpha), method).light(80, 60).a; };
  EXPECT_EQ(coverage(0.3f, "msaa:n=8"), 0);
  EXPECT_EQ(coverage(0.3f, "msaa:n=8,alpha=samples"), 0);
  EXPECT_EQ(coverage(0.3f, "msaa:n=8,alpha=coverage"), 0.25f);  // 2.4 of 8
  EXPECT_EQ(coverage(0.7f, "msaa:n=8,alpha=coverage"), 0.75f);  // 5.6 of 8
  EXPECT_EQ(coverage(0.7f, "msaa:n=16,alpha=coverage"), 0.6875f);
  EXPECT_EQ(coverage(1.0f, "msaa:n=4,alpha=coverage"), 1);
  EXPECT_EQ(coverage(0.3f, "msaa:n=8,alpha=sharp"), 0);  // no slope: a step at the cutoff
  EXPECT_EQ(coverage(0.7f, "msaa:n=8,alpha=sharp"), 1);
}

TEST(AlphaToCoverage, EveryWayComesNearerToTheTruthThanATestAPixel) {
  const LinearImage truth = shot("foliage", "ssaa:n=8").light;
  const double tested = mean_error(shot("foliage", "msaa:n=8").light, truth);
  EXPECT_LT(mean_error(shot("foliage", "msaa:n=8,alpha=samples").light, truth), 0.85 * tested);
  EXPECT_LT(mean_error(shot("foliage", "msaa:n=8,alpha=sharp").light, truth), 0.95 * tested);
}

TEST(Sampling, ThreadsAndInstructionSetsLeaveNoTrace) {
  const Scene scene = *make_builtin_scene("foliage");
  for (const char* method : {"adaptive", "csaa", "quincunx", "flipquad", "msaa:n=4,resolve=max3,alpha=sharp",
                             "ssaa:n=2,filter=mitchell,resolve=karis"}) {
    RenderOptions options{.width = 96, .height = 72};
    LinearImage one;
    with_threads(1, [&] { one = shot(scene, method, options).light; });
    for (const Isa isa : supported_isas()) {
      options.isa = isa;
      with_threads(3, [&] { EXPECT_EQ(shot(scene, method, options).light, one) << method << " " << name_of(isa); });
    }
  }
}

}  // namespace
}  // namespace zoneplate::antialias
