// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/scene/builtin/make.h"

namespace zoneplate {

/// Functions of the benchmark scenes. The scenes are computed by integer hashes and float operations in a fixed order,
/// so that other renderers can reproduce the vertices exactly; their colours are to be drawn without sRGB decoding.

/// A 32-bit hash of one word.
///
/// Source    the finaliser of math/random.h.
constexpr std::uint32_t hash_word(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

/// Four octaves of smooth lattice noise, each with half the amplitude and 2.1 times the frequency of the previous one.
float bumps(float x, float y, float z);

/// 1024 × 1024 texels of bricks and mortar with noise; alpha is 96 to 159.
TextureImage brick_texture();

/// One indexed triangle list with all vertex attributes of these scenes.
struct BenchMesh {
  explicit BenchMesh(std::size_t vertices = 0, std::size_t indices = 0);
  Mesh mesh;

  /// Adds a quad of counter-clockwise corners: lower left, lower right, upper right, upper left.
  void add_quad(const float3 (&corner)[4], float3 normal, const float2 (&uv)[4]);
};

/// Writes the two triangles of every cell of a grid of (nx + 1) × (ny + 1) vertices, row by row.
///
/// `index` has 6 nx ny elements; `first` is the index of the grid's first vertex.
void fill_grid(std::span<std::uint32_t> index, std::uint32_t first, int nx, int ny);

/// The Blinn-Phong material and the light of the lit scenes: base (ambient + N·L) + specular (N·H)^shininess.
struct BenchLook {
  float3 base{0.80f, 0.55f, 0.30f};
  float3 light{0.40824829f, 0.81649658f, 0.40824829f};  ///< towards the light
  float ambient = 0.15f, specular = 0.35f, exponent = 40;
  bool textured = false, double_sided = false;
  int anisotropy = 1;
};
Scene lit_scene(const char* name, Mesh mesh, const BenchLook& look);

}  // namespace zoneplate
