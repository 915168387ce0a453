// SPDX-License-Identifier: Apache-2.0
// Coverage of four samples a pixel beside an independent rasterizer: Mesa's llvmpipe, where libosmesa6 is installed.
//
// Vertices on the lattice of 1/16 pixel in an image of 64 × 64 are exact in both, and edges often go through samples,
// so that the rule of ties is tested too. Each sample is asked for by itself, by a mask. Rows of OpenGL's framebuffer
// objects count as ours do here: its first row is laid on our first one, and both rules are then the same.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

#include "zoneplate/math/random.h"
#include "zoneplate/raster/tile/rasterize.h"

namespace zoneplate {
namespace {

constexpr int side = 64, samples = 4;

using Points = std::array<std::array<int, 2>, 3>;  ///< a triangle's corners in sixteenths of a pixel
using Covered = std::array<Plane<std::uint8_t>, samples>;

/// The part of OpenGL that is needed, looked up at run time: the build needs no Mesa.
class Llvmpipe {
 public:
  Llvmpipe() {
    for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6"})
      if (!library_) library_ = ::dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (!library_) return;
    ::setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    const auto create = symbol<void* (*)(unsigned, int, int, int, void*)>("OSMesaCreateContextExt");
    const auto make_current = symbol<unsigned char (*)(void*, void*, unsigned, int, int)>("OSMesaMakeCurrent");
    find_ = symbol<void* (*)(const char*)>("OSMesaGetProcAddress");
    if (!create || !make_current || !find_) return;
    context_ = create(rgba, 0, 0, 0, nullptr);
    if (context_ && make_current(context_, window_.data(), unsigned_byte, side, side)) is_ready_ = make_buffers();
  }
  ~Llvmpipe() {
    if (context_) symbol<void (*)(void*)>("OSMesaDestroyContext")(context_);
  }
  Llvmpipe(const Llvmpipe&) = delete;
  Llvmpipe& operator=(const Llvmpipe&) = delete;

  bool is_ready() const { return is_ready_; }

  Covered covered(const Points& triangle) const {
    Covered out;
    for (unsigned s = 0; s < samples; ++s) out[s] = sample(triangle, s);
    return out;
  }

 private:
  static constexpr unsigned rgba = 0x1908, rgba8 = 0x8058, unsigned_byte = 0x1401, framebuffer = 0x8D40,
                            renderbuffer = 0x8D41, color0 = 0x8CE0, read_buffer = 0x8CA8, draw_buffer = 0x8CA9,
                            complete = 0x8CD5, multisample = 0x809D, sample_mask = 0x8E51, color_bit = 0x4000,
                            nearest = 0x2600, triangles = 4;

  template <class F>
  F symbol(const char* name) const {
    return reinterpret_cast<F>(::dlsym(library_, name));
  }
  template <class... Types>
  void call(const char* name, Types... values) const {
    reinterpret_cast<void (*)(Types...)>(find_(name))(values...);
  }

  unsigned make_buffer(int count) {
    unsigned frame = 0, render = 0;
    call("glGenFramebuffers", 1, &frame);
    call("glGenRenderbuffers", 1, &render);
    call("glBindFramebuffer", framebuffer, frame);
    call("glBindRenderbuffer", renderbuffer, render);
    call("glRenderbufferStorageMultisample", renderbuffer, count, rgba8, side, side);
    call("glFramebufferRenderbuffer", framebuffer, color0, renderbuffer, render);
    return frame;
  }
  bool make_buffers() {
    for (const char* name : {"glRenderbufferStorageMultisample", "glBlitFramebuffer", "glSampleMaski"})
      if (!find_(name)) return false;
    many_ = make_buffer(samples);
    one_ = make_buffer(0);
    call("glBindFramebuffer", framebuffer, many_);
    const auto status = reinterpret_cast<unsigned (*)(unsigned)>(find_("glCheckFramebufferStatus"))(framebuffer);
    call("glViewport", 0, 0, side, side);
    call("glEnable", multisample);
    call("glEnable", sample_mask);
    return status == complete;
  }

  /// 1 where this sample is covered.
  Plane<std::uint8_t> sample(const Points& triangle, unsigned s) const {
    call("glBindFramebuffer", framebuffer, many_);
    call("glSampleMaski", 0u, ~0u);
    call("glClearColor", 0.0f, 0.0f, 0.0f, 0.0f);
    call("glClear", color_bit);
    call("glSampleMaski", 0u, 1u << s);
    call("glBegin", triangles);
    call("glColor4f", 1.0f, 1.0f, 1.0f, 1.0f);
    for (const auto& p : triangle)
      call("glVertex2f", static_cast<float>(p[0]) / (8 * side) - 1, static_cast<float>(p[1]) / (8 * side) - 1);
    call("glEnd");
    call("glBindFramebuffer", read_buffer, many_);
    call("glBindFramebuffer", draw_buffer, one_);
    call("glBlitFramebuffer", 0, 0, side, side, 0, 0, side, side, color_bit, nearest);
    call("glBindFramebuffer", framebuffer, one_);
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(4 * side * side));
    call("glReadPixels", 0, 0, side, side, rgba, unsigned_byte, bytes.data());
    Plane<std::uint8_t> out(side, side);
    for (std::size_t i = 0; i < out.values().size(); ++i) out.values()[i] = bytes[4 * i] > 0;
    return out;
  }

  void* library_ = nullptr;
  void* context_ = nullptr;
  void* (*find_)(const char*) = nullptr;
  bool is_ready_ = false;
  unsigned many_ = 0, one_ = 0;
  std::vector<std::uint8_t> window_ = std::vector<std::uint8_t>(static_cast<std::size_t>(4 * side * side));
};

struct White : FragmentShader {
  void shade(const FragmentBatch& batch, OutputMask, FragmentOutputs& out) const override {
    for (int i = 0; i < batch.padded(); ++i) out.r[i] = out.g[i] = out.b[i] = out.a[i] = 1;
  }
  float alpha(const FragmentBatch&, float*) const override { return 0; }
};

Covered ours(const Points& triangle) {
  std::array<float4, 3> clip;
  for (std::size_t k = 0; k < 3; ++k)
    clip[k] = {static_cast<float>(triangle[k][0]) / (8 * side) - 1, 1 - static_cast<float>(triangle[k][1]) / (8 * side),
               0.5f, 1};
  constexpr std::uint32_t index[] = {0, 1, 2};
  Draw draw;
  draw.clip = clip;
  draw.index = index;
  std::vector<LinearImage> color(samples, LinearImage(side, side, Linear{0, 0, 0, 0}));
  std::vector<Plane<float>> depth(samples, Plane<float>(side, side));
  std::vector<Plane<std::uint32_t>> id(samples, Plane<std::uint32_t>(side, side, Target::no_id));
  LinearImage image(side, side, Linear{0, 0, 0, 0});
  Target target;
  target.viewport = {side, side};
  target.width = target.height = side;
  target.samples = standard_pattern(samples);
  target.color = &image;
  target.sample_color = &color, target.sample_depth = &depth, target.sample_triangle = &id;
  rasterize(std::span(&draw, 1), White{}, {}, target);
  Covered out;
  for (std::size_t s = 0; s < samples; ++s) {
    out[s] = Plane<std::uint8_t>(side, side);
    for (std::size_t i = 0; i < id[s].values().size(); ++i) out[s].values()[i] = id[s].values()[i] != Target::no_id;
  }
  return out;
}

TEST(Llvmpipe, CoversTheSameSamples) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "Mesa is not built for sanitizers";
#endif
  const Llvmpipe mesa;
  if (!mesa.is_ready()) GTEST_SKIP() << "libosmesa6 is not installed";
  constexpr std::uint32_t count = 200;
  std::uint64_t covered = 0, differing = 0;
  for (std::uint32_t t = 0; t < count; ++t) {
    Points triangle;
    for (std::uint32_t k = 0; k < 6; ++k) triangle[k / 2][k % 2] = static_cast<int>(hash(t, k, 2026) % (16 * side + 1));
    // Every other one on whole pixels and halves, where edges meet samples most often; some level, some upright.
    if (t % 2 == 0)
      for (auto& p : triangle) p = {p[0] / 8 * 8, p[1] / 8 * 8};
    if (t % 5 == 0) triangle[1][1] = triangle[0][1];
    if (t % 7 == 0) triangle[2][0] = triangle[1][0];
    const Covered theirs = mesa.covered(triangle), own = ours(triangle);
    for (std::size_t s = 0; s < samples; ++s)
      for (std::size_t i = 0; i < own[s].values().size(); ++i) {
        covered += own[s].values()[i];
        differing += own[s].values()[i] != theirs[s].values()[i];
      }
  }
  EXPECT_GT(covered, std::uint64_t{count} * side * side / 16);
  EXPECT_EQ(differing, 0u) << "of " << covered << " samples";
}

}  // namespace
}  // namespace zoneplate
