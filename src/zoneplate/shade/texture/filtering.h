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
  std::int32_t anisotropy = 1;  ///< most probes along a footprint, up to most_anisotropy; 1: isotropic
  static constexpr std::int32_t most_anisotropy = 16;
  bool operator==(const Filtering&) const = default;
};
/// `anisotropy`: asked for beside the sampler's own; the greater counts. Only samplers that blend levels have any.
Filtering make_filtering(const Sampler& sampler, int anisotropy = 1);

/// Where points look into a texture: its coordinates and their change per pixel.
struct Footprint {
  const float *u, *v;
  const float *dudx, *dvdx, *dudy, *dvdy;

  /// By group of eight points, or null: the changes of all of its points are those of the point before it, and not
  /// told.
  const bool* repeats = nullptr;
};

/// The texels that points need, and how to weigh them: of two levels the upper left and the lower left texel of four.
/// The right ones follow them; what has no weight may lie outside the level. Where no blend weight is above 0 the
/// second level is not read.
///
/// Units     weights in 1/32768.
struct Taps {
  static constexpr int capacity = 256;
  static constexpr int groups = capacity / 8;
  static constexpr int room = capacity + 16;  ///< as Batch::room
  alignas(64) std::int32_t upper[2][room], lower[2][room];
  alignas(64) std::int16_t side[2][2 * room];  ///< weights of the right texels, of the lower texels: by fours
  alignas(64) std::int16_t blend[2 * room];    ///< weight of the second level, the same twice: by fours
  alignas(64) float detail[room];              ///< log2 of the footprint, on the way there

  /// Where point i's first number stands among numbers by fours: the first of four points, then their second.
  static constexpr int by_fours(int i) { return i / 4 * 8 + i % 4; }
  std::int32_t right(int level, int i) const { return side[level][by_fours(i)]; }
  std::int32_t down(int level, int i) const { return side[level][by_fours(i) + 4]; }
};

/// Texture look-up in two stages. Counts are multiples of 8, at most Taps::capacity; what stands in a footprint's
/// arrays up to the next multiple of 16 may be read.
///
/// The level is log2 of the footprint: D = ½ log2 max(|∂(s,t)/∂x|², |∂(s,t)/∂y|²) with (s, t) in texels of level 0,
/// clamped to the levels there are. D > 0 minifies, else the picture is magnified. The coordinate is wrapped before
/// it is scaled to a level. Nearest takes the texel that holds the point; linear the four whose centres surround
/// it, mixed by their distances: first along y, then x, then between levels (floor D and the next; or, without
/// blending, the level nearest to D).
///
/// Level and weights are cut off after 15 bits; log2 is that of coarse_log2.
///
/// Edges     any coordinate and any derivative, infinities and NaN included, give texels inside the texture.
/// Exact     a point on a texel's centre (of a size that is a power of two) gives that texel; texels of one value give
///           that value; 0 and 1 are exact. Mixing is in fixed point: codes of 8 bits with 7 more below them, codes of
///           15 bits as they are, weights of 15 bits, each of the mixes rounded to the nearest. A value is off by at
///           most 2 units of 1/32640 or 1/32767, where graphics interfaces ask for weights of 8 bits. Textures of
///           floats are mixed in floats, with the same weights.
/// Source    Williams, Pyramidal Parametrics, SIGGRAPH 1983; OpenGL 4.6 core, section 8.14, with the isotropic
///           scale factor ρ of equation 8.8 and c = 0.
struct FilteringKernels {
  void (*find_taps)(const TextureView& texture, const Filtering& filtering, const Footprint& footprint, Taps& out,
                    int count);
  void (*mix_taps)(const TextureView& texture, const Taps& taps, float* const out[4], int count);

  /// Both stages for footprints that are longer than wide: the mean of N probes along the longer axis, at the level of
  /// an N-th of its length: N = ceil(longer / shorter), at most `anisotropy` and ceil(longer) in texels of level 0.
  /// Probe i of N lies at i / (N + 1) - 1/2 of the axis.
  /// Source    EXT_texture_filter_anisotropic (but for the last bound, which only spares probes nearer than a texel).
  void (*sample_anisotropic)(const TextureView& texture, const Filtering& filtering, const Footprint& footprint,
                             float* const out[4], int count);

  static const FilteringKernels N_SSE4, N_AVX2, N_AVX3, N_NEON, N_WASM;  ///< one for each instruction set (base/isa.h)
};

namespace scalar {
extern const FilteringKernels filtering_kernels;
}

}  // namespace zoneplate
