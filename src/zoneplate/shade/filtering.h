#pragma once

#include <cstdint>

namespace zoneplate {

struct Sampler;
struct TextureView;

/// A sampler as kernels see it.
struct Filtering {
  bool mirror_u = false, clamp_u = false;  ///< neither: repeat
  bool mirror_v = false, clamp_v = false;
  bool nearest_magnify = false, nearest_minify = false;
  bool has_levels = true, blends_levels = true;
  bool operator==(const Filtering&) const = default;
};
Filtering make_filtering(const Sampler& sampler);

/// Where points look into a texture: its coordinates and their change per pixel.
struct Footprint {
  const float *u, *v;
  const float *dudx, *dvdx, *dudy, *dvdy;
};

/// The texels that points need, and how to weigh them: two levels of four texels (upper left, upper right, lower left,
/// lower right). Where `blend` is 0 the second level is not read.
struct Taps {
  static constexpr int capacity = 256;
  alignas(64) std::int32_t texel[2][4][capacity];
  alignas(64) float right[2][capacity], down[2][capacity];  ///< weights of the right and lower texels
  alignas(64) float blend[capacity];                        ///< weight of the second level
};

/// Texture look-up in two stages. Counts are at most Taps::capacity; stores may touch up to the next multiple of 8.
///
/// The level is log2 of the footprint: D = ½ log2 max(|∂(s,t)/∂x|², |∂(s,t)/∂y|²) with (s, t) in texels of level 0,
/// clamped to the levels there are. D > 0 minifies, else the picture is magnified. The coordinate is wrapped before
/// it is scaled to a level. Nearest takes the texel that holds the point; linear the four whose centres surround
/// it, mixed by their distances: first along x, then y, then between levels (floor D and the next; or, without
/// blending, the level nearest to D).
///
/// Edges     any coordinate and any derivative, infinities and NaN included, give texels inside the texture.
/// Exact     a point on a texel's centre (of a size that is a power of two) gives that texel; texels of one value give
///           that value. Values are code × (1 / 255) or code × (1 / 65535) in float; 0 and 1 are exact.
/// Source    Williams, Pyramidal Parametrics, SIGGRAPH 1983; OpenGL 4.6 core, section 8.14, with the isotropic
///           scale factor ρ of equation 8.8 and c = 0.
struct FilteringKernels {
  void (*find_taps)(const TextureView& texture, const Filtering& filtering, const Footprint& footprint, Taps& out,
                    int count);
  void (*mix_taps)(const TextureView& texture, const Taps& taps, float* const out[4], int count);
};

namespace scalar {
extern const FilteringKernels filtering_kernels;
}
namespace N_SSE4 {
extern const FilteringKernels filtering_kernels;
}
namespace N_AVX2 {
extern const FilteringKernels filtering_kernels;
}

}  // namespace zoneplate
