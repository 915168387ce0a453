#include <gtest/gtest.h>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/render/render.h"
#include "zoneplate/scene/builtin.h"

namespace zoneplate::antialias {
namespace {

LinearImage shot(const char* name, const char* method) {
  const Scene scene = *make_builtin_scene(name);
  const std::unique_ptr<Resolver> resolver = make_resolver(methods(), method);
  RenderOptions options;
  options.width = 160, options.height = 120;
  Frame frame = render(scene, scene.cameras.at(0), resolver->ask(0), options);
  return resolver->resolve(frame);
}

TEST(IdSraa, WithOneColourATriangleItIsMultisampling) {
  for (const char* name : {"triangles", "cyclic"})
    for (const auto& [own, multi] :
         {std::pair{"idsraa:n=4", "msaa:n=4"}, {"idsraa", "msaa:n=8"}, {"idsraa:n=16", "msaa:n=16"}}) {
      const LinearImage a = shot(name, own), b = shot(name, multi);
      int differing = 0, partial = 0;
      for (std::size_t i = 0; i < a.values().size(); ++i) {
        const Linear p = a.values()[i], q = b.values()[i];
        partial += q.a > 0 && q.a < 1;
        differing += std::abs(p.r - q.r) > 1e-5f || std::abs(p.g - q.g) > 1e-5f || std::abs(p.b - q.b) > 1e-5f ||
                     std::abs(p.a - q.a) > 1e-5f;
      }
      EXPECT_GT(partial, 100) << name;
      // Only a corner thinner than a pixel is shaded nowhere around.
      EXPECT_LE(differing, 8) << name << " " << own;
    }
}

TEST(IdSraa, PicturesWithinASurfaceKeepTheirBits) {
  const LinearImage a = shot("checkerboard", "idsraa"), b = shot("checkerboard", "none");
  int same = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) same += a.values()[i] == b.values()[i];
  EXPECT_GT(same, 160 * 120 * 8 / 10);
}

TEST(IdSraa, ThreadsLeaveNoTrace) {
  LinearImage one, many;
  with_threads(1, [&] { one = shot("cyclic", "idsraa"); });
  with_threads(5, [&] { many = shot("cyclic", "idsraa"); });
  EXPECT_EQ(one, many);
}

}  // namespace
}  // namespace zoneplate::antialias
