// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/prepared_environment.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/scene/environment.h"
#include "zoneplate/shade/environment/equirectangular.h"
#include "zoneplate/shade/environment/light_tree.h"
#include "zoneplate/shade/environment/lookup_lanes.h"
#include "zoneplate/shade/environment/prefilter.h"

namespace zoneplate {
namespace {

/// α at the levels of an environment: α² rises evenly from 0 until α is about a quarter of the width of a texel, from
/// there by equal factors to 1.
class Levels {
 public:
  /// Of an environment with faces of `side` texels, which may have lamps of a texel.
  Levels(int side, bool has_sharp_lights)
      : side_(side),
        narrowest_(std::min(side, 256)),
        largest_(has_sharp_lights ? std::min(narrowest_ * 2, 320) : narrowest_),
        smallest_(has_sharp_lights ? 64 : 48),
        per_alpha_(has_sharp_lights ? 3.3f : 2.86f),
        sharpness_(4.0f * static_cast<float>(narrowest_ * narrowest_)) {
    const float octaves = log2(1 + sharpness_);
    count_ = static_cast<int>(octaves * density) + 2;
    per_octave_ = static_cast<float>(count_ - 1) / octaves;
  }
  int count() const { return count_; }
  float alpha(int level) const {
    return level == count_ - 1 ? 1.0f : std::sqrt((exp2(static_cast<float>(level) / per_octave_) - 1) / sharpness_);
  }
  /// The first level whose lobe, whose full width at half of its maximum is 2.6 α, is as wide as a texel of the image,
  /// so that the moments of the texels' light suffice.
  int first_wide() const {
    int level = 0;
    while (alpha(level) * static_cast<float>(side_) < 0.8f) ++level;
    return level;
  }
  /// Texels somewhat narrower than α, of the width of the lobe, where there are as many. The radiance at roughness 0 is
  /// a sum of the first three levels, which have the texels of the image, such that it is a spline over these.
  int side(int level) const {
    if (level == 0) return side_;
    if (level < 3) return narrowest_;
    return std::min(largest_, std::max(smallest_, static_cast<int>(per_alpha_ / alpha(level)) / 4 * 4 + 4));
  }
  /// Of the levels, and of irradiance after them; returns the number of texels.
  std::size_t lay_out(EnvironmentView& view) const {
    view.levels = count_, view.sharpness = sharpness_, view.levels_per_octave = per_octave_;
    int texels = 0;
    for (int level = 0; level <= count_; ++level) {
      view.side[level] = side(std::min(level, count_ - 1));
      view.offset[level] = texels;
      texels += cube::faces * (view.side[level] + 2) * (view.side[level] + 2);
    }
    for (int level = 1; level < count_ - 1; ++level) {
      const bool is_common = side(level - 1) == side(level) && side(level) == side(level + 1);
      view.common_side[level] = is_common ? side(level) : 0;
    }
    return static_cast<std::size_t>(texels);
  }

 private:
  static constexpr float density = 1.4f;  ///< least number of levels per octave of α²
  int side_, narrowest_;                  ///< of level 0, of the next two
  int largest_, smallest_;                ///< the limits of the others
  float per_alpha_;                       ///< texels of a level times its α, where there are as many
  int count_;
  float sharpness_, per_octave_;
};

/// Of samples, in texels.
constexpr int border = 4;

/// The light of the tree filtered by each lobe, in the directions of the texels of cube maps with the border that
/// fit_spline needs, by blocks of 4 × 4 texels.
std::vector<BorderedCube> filtered(const LightTree& tree, const Lobes& lobes, int side) {
  const PrefilterKernels& kernels = PrefilterKernels::of();
  std::vector<BorderedCube> out(static_cast<std::size_t>(lobes.count), BorderedCube(side, border));
  const int blocks = out[0].pitch() / 4;
  parallel_for(static_cast<std::size_t>(cube::faces * blocks), [&](std::size_t row) {
    const int face = static_cast<int>(row) / blocks, first_y = static_cast<int>(row) % blocks * 4 - border;
    for (int first_x = -border; first_x < side + border; first_x += 4) {
      DirectionBlock directions;
      for (int i = 0; i < DirectionBlock::size; ++i) {
        const float3 d =
            normalize(cube::point(face, cube::centre(first_x + i % 4, side), cube::centre(first_y + i / 4, side)));
        directions.x[i] = d.x, directions.y[i] = d.y, directions.z[i] = d.z;
      }
      RadianceBlock light[Lobes::most];
      kernels.filter(tree, lobes, directions, light);
      for (std::size_t a = 0; a < out.size(); ++a)
        for (int i = 0; i < DirectionBlock::size; ++i)
          out[a].at(face, first_x + i % 4, first_y + i / 4) = {light[a].r[i], light[a].g[i], light[a].b[i]};
    }
  });
  return out;
}

/// True if the radiance of a texel exceeds that of its neighbours by `limit` times the mean radiance. Maps with the
/// image's texels would then have errors of some percent for lobes of about a texel's width (docs/environment.md).
bool has_sharp_lights(const LightTree& tree) {
  constexpr float limit = 64;
  const auto power = [&](int face, int x, int y) {
    const float3 c = tree.texels.at(face, x, y);
    return c.x + c.y + c.z;
  };
  for (int face = 0; face < cube::faces; ++face)
    for (int y = 0; y < tree.side; ++y)
      for (int x = 0; x < tree.side; ++x) {
        const float twice = 2 * power(face, x, y);
        if (std::max(twice - power(face, x - 1, y) - power(face, x + 1, y),
                     twice - power(face, x, y - 1) - power(face, x, y + 1)) > limit * tree.mean_power)
          return true;
      }
  return false;
}

/// The lobes of a level and those after it, before `end`, that share its cube map's size.
Lobes lobes_from(const Levels& levels, int level, int end) {
  // Errors of whole texels vanish in lobes of about their size.
  constexpr float coarse = 0.85f, fine = 0.58f;
  Lobes lobes{{levels.alpha(level)}, 1, levels.alpha(level) * static_cast<float>(levels.side(0)) < 4 ? coarse : fine};
  while (lobes.count < Lobes::most && level + lobes.count < end &&
         levels.side(level + lobes.count) == levels.side(level))
    lobes.alpha[lobes.count] = levels.alpha(level + lobes.count), ++lobes.count;
  return lobes;
}

/// A function of directions at the texels of a cube map.
template <class Function>
BorderedCube sampled(int side, const Function& function) {
  BorderedCube out(side, border);
  parallel_for(static_cast<std::size_t>(cube::faces * out.pitch()), [&](std::size_t row) {
    const int face = static_cast<int>(row) / out.pitch(), y = static_cast<int>(row) % out.pitch() - border;
    for (int x = -border; x < side + border; ++x) {
      const float3 d = cube::point(face, cube::centre(x, side), cube::centre(y, side));
      out.at(face, x, y) = function(face, x, y, cube_place(Vector<scalar::Float>{d.x, d.y, d.z}));
    }
  });
  return out;
}

/// `count` samples, `step` apart, become the control points of the spline that interpolates them, by the inverse of the
/// filter (1, 6, 1) / 8, which is one recursion forwards and one backwards. The samples continue mirrored at both ends,
/// whose influence falls by the factor 0.17 from one sample to the next.
/// Source: Unser, Aldroubi and Eden, B-Spline Signal Processing, IEEE Transactions on Signal Processing 41, 1993.
void invert_filter(float3* samples, int count, std::size_t step) {
  constexpr float pole = -0.171572875f;  // √8 - 3
  const auto at = [&](int i) -> float3& { return samples[static_cast<std::size_t>(i) * step]; };
  constexpr int horizon = 9;
  float3 sum = at(0);
  float power = 1;
  for (int i = 1; i < horizon; ++i) power *= pole, sum = sum + at(i) * power;
  at(0) = sum;
  for (int i = 1; i < count; ++i) at(i) = at(i) + at(i - 1) * pole;
  const int last = count - 1;
  at(last) = (at(last) + at(last - 1) * pole) * (-pole / (1 - pole * pole));
  for (int i = last - 1; i >= 0; --i) at(i) = (at(i + 1) - at(i)) * pole;
  for (int i = 0; i < count; ++i) at(i) = at(i) * 8.0f;
}

/// The control points, with a border of one texel, of the spline that interpolates samples with a border of four.
void fit_spline(const BorderedCube& samples, float* out) {
  const int side = samples.side, pitch = samples.pitch();
  BorderedCube points = samples;
  parallel_for(static_cast<std::size_t>(cube::faces), [&](std::size_t f) {
    const int face = static_cast<int>(f);
    float* to = out + 3 * f * static_cast<std::size_t>((side + 2) * (side + 2));
    for (int k = -border; k < side + border; ++k) invert_filter(&points.at(face, -border, k), pitch, 1);
    for (int k = -border; k < side + border; ++k)
      invert_filter(&points.at(face, k, -border), pitch, static_cast<std::size_t>(pitch));
    for (int y = -1; y <= side; ++y)
      for (int x = -1; x <= side; ++x, to += 3) {
        const float3 point = points.at(face, x, y);
        to[0] = point.x, to[1] = point.y, to[2] = point.z;
      }
  });
}

/// The control point of a level of a spline along the levels that meets the values `at` of them.
template <class At>
float3 control_point(int level, int levels, const At& at) {
  const auto inner = [&](int k) { return at(k) * 1.25f - (at(k - 1) + at(k + 1)) * 0.125f; };
  if (level < levels - 1) return inner(level);
  // Of the last three control points, the outermost has the weight 9/8 at the last level.
  return (at(level) + inner(level - 1) * 0.25f - inner(level - 2) * 0.125f) * (1 / 1.125f);
}

/// A change of the filter changes its version.
constexpr char magic[8] = {'z', 'p', 'e', 'n', 'v', '0', '0', '9'};

}  // namespace

struct PreparedEnvironment::Header {
  char magic[8];
  std::int32_t side, has_sharp_lights;
  float3 mean, greatest;
  std::uint64_t hash;  ///< of the texels
};

PreparedEnvironment::PreparedEnvironment(const CubeImage& cube, const std::function<void(double)>& progress) {
  LightTree tree = make_light_tree(cube);
  mean_ = tree.mean(), has_sharp_lights_ = has_sharp_lights(tree);
  const Levels levels(cube.side, has_sharp_lights_);
  texels_.resize(3 * levels.lay_out(view_) + 1);
  const auto first = [&](int level) { return texels_.data() + 3 * static_cast<std::size_t>(view_.offset[level]); };

  // Every level as a spline of its own.
  const std::vector<float3> points = tree.texels.texels;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float3 texel = points[i];
    first(0)[3 * i] = texel.x, first(0)[3 * i + 1] = texel.y, first(0)[3 * i + 2] = texel.z;
  }
  const int of_source = cube.source.empty() ? levels.count() : levels.first_wide();  // the first of these levels
  std::vector<BorderedCube> samples(1);
  for (int level = 1; level < levels.count(); level = static_cast<int>(samples.size())) {
    if (progress) progress(static_cast<double>(view_.offset[level]) / view_.offset[levels.count()]);
    if (level == of_source) {
      tree = LightTree();
      tree = make_light_tree_of_source(cube);
    }
    const int end = level < of_source ? of_source : levels.count();
    for (BorderedCube& of_level : filtered(tree, lobes_from(levels, level, end), levels.side(level)))
      samples.push_back(std::move(of_level));
  }
  for (int level = 1; level < levels.count(); ++level)
    fit_spline(samples[static_cast<std::size_t>(level)], first(level));
  std::copy(first(levels.count() - 1), first(levels.count()), first(levels.count()));

  // One spline along the levels.
  const std::vector<float> separate = texels_;
  EnvironmentView view = view_;
  view.texels = separate.data();
  const auto light_at = [&](const CubePlace<scalar::Float>& place, int level) {
    const auto light = cube_light(view, place, scalar::Int(level));
    return float3{light.x.v, light.y.v, light.z.v};
  };
  for (int level = 1; level < levels.count(); ++level)
    fit_spline(sampled(view.side[level],
                       [&](int face, int x, int y, const CubePlace<scalar::Float>& place) {
                         return control_point(level, view.levels, [&](int k) {
                           return k == level ? samples[static_cast<std::size_t>(k)].at(face, x, y) : light_at(place, k);
                         });
                       }),
               first(level));
  // At roughness 0 the spline is the radiance itself: its control points there are found from those of levels 1 and 2.
  const std::vector<float> inner = texels_;
  view.texels = inner.data();
  fit_spline(sampled(cube.side,
                     [&](int, int, int, const CubePlace<scalar::Float>& place) {
                       return light_at(place, 1) * 0.25f - light_at(place, 2) * 0.125f;
                     }),
             first(0));
  for (std::size_t i = 0; i < 3 * points.size(); ++i) first(0)[i] = (first(0)[i] + separate[i]) * (1 / 1.125f);

  for (const float3& c : cube.texels) max_ = {std::max(max_.x, c.x), std::max(max_.y, c.y), std::max(max_.z, c.z)};
}

namespace {

bool are_finite(std::span<const float> values) {
  constexpr std::uint32_t exponent = 0x7f800000;
  std::uint32_t others = 0;
  for (const float value : values) others |= (std::bit_cast<std::uint32_t>(value) & exponent) == exponent;
  return others == 0;
}

}  // namespace

std::vector<std::uint8_t> PreparedEnvironment::bytes() const {
  const std::span texels(reinterpret_cast<const std::uint8_t*>(texels_.data()), texels_.size() * sizeof(float));
  Header header{};
  std::copy_n(magic, std::size(magic), header.magic);
  header.side = view_.side[0], header.has_sharp_lights = has_sharp_lights_ ? 1 : 0, header.mean = mean_,
  header.greatest = max_, header.hash = content_hash(texels);
  std::vector<std::uint8_t> out(sizeof header + texels.size());
  std::memcpy(out.data(), &header, sizeof header);
  std::memcpy(out.data() + sizeof header, texels.data(), texels.size());
  return out;
}

std::optional<PreparedEnvironment> PreparedEnvironment::from_bytes(std::span<const std::uint8_t> bytes) {
  Header header;
  if (bytes.size() < sizeof header) return std::nullopt;
  std::memcpy(&header, bytes.data(), sizeof header);
  const std::span texels = bytes.subspan(sizeof header);
  if (!std::equal(std::begin(magic), std::end(magic), header.magic)) return std::nullopt;
  if (header.side < 32 || header.side > largest_side || (header.side & (header.side - 1)) != 0) return std::nullopt;
  PreparedEnvironment out;
  const std::size_t floats = 3 * Levels(header.side, header.has_sharp_lights != 0).lay_out(out.view_) + 1;
  if (texels.size() != floats * sizeof(float) || content_hash(texels) != header.hash) return std::nullopt;
  out.texels_.resize(floats);
  std::memcpy(out.texels_.data(), texels.data(), texels.size());
  out.mean_ = header.mean, out.max_ = header.greatest, out.has_sharp_lights_ = header.has_sharp_lights != 0;
  // The hash is no secret: values that no image gives may have been stored with theirs.
  const float3 a = header.mean, b = header.greatest;
  const float limits[] = {a.x, a.y, a.z, b.x, b.y, b.z};
  if (!are_finite(out.texels_) || !are_finite(limits)) return std::nullopt;
  return out;
}

std::size_t PreparedEnvironment::max_bytes() {
  EnvironmentView view;
  return sizeof(Header) + (3 * Levels(largest_side, true).lay_out(view) + 1) * sizeof(float);
}

std::uint64_t content_hash(std::span<const std::uint8_t> bytes) {
  // Four sums at once, eight bytes each, by the multiplication of FNV-1a; what is left over counts as zeros.
  constexpr std::uint64_t prime = 0x100000001b3, basis = 0xcbf29ce484222325;
  std::uint64_t sums[4] = {basis, basis + 1, basis + 2, basis + 3};
  for (std::size_t at = 0; at < bytes.size(); at += sizeof sums) {
    std::uint64_t words[4] = {};
    std::memcpy(words, bytes.data() + at, std::min(sizeof words, bytes.size() - at));
    for (int k = 0; k < 4; ++k) {
      sums[k] = (sums[k] ^ words[k]) * prime;
      sums[k] ^= sums[k] >> 29;
    }
  }
  std::uint64_t all = bytes.size();
  for (const std::uint64_t sum : sums) all = (all ^ sum) * prime, all ^= all >> 32;
  return all;
}

EnvironmentView PreparedEnvironment::view(const Environment& environment, float3 up,
                                          const float4x4& world_from_camera) const {
  EnvironmentView view = view_;
  view.texels = texels_.data();
  const float3 tint = environment.factor();
  view.tint[0] = tint.x, view.tint[1] = tint.y, view.tint[2] = tint.z;

  // The axes of the image in the world. Its +z is the front, from which the camera looks at a scene by default.
  float3 y = normalize(up, {0, 1, 0}), z = std::abs(y.z) > 0.5f ? float3{0, -1, 0} : float3{0, 0, 1};
  if (environment.is_in_camera_space)
    y = normalize(xyz(world_from_camera.column[1])), z = normalize(xyz(world_from_camera.column[2]));
  const float3 x = normalize(cross(y, z));
  z = cross(x, y);
  const float c = cos(environment.rotation), s = sin(environment.rotation);
  const float3 rows[3] = {x * c - z * s, y, x * s + z * c};
  for (int i = 0; i < 3; ++i) {
    float* const row = view.image_from_world + 3 * i;
    row[0] = rows[i].x, row[1] = rows[i].y, row[2] = rows[i].z;
  }
  return view;
}

PreparedEnvironment prepare_equirectangular(const TexelImage& image) {
  return PreparedEnvironment(cube_of_equirectangular(image, cube_side(image.width())));
}

}  // namespace zoneplate
