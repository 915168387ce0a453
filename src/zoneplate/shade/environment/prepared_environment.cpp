// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/prepared_environment.h"

#include <algorithm>
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
  /// Of an environment with faces of `side` texels.
  explicit Levels(int side)
      : side_(side), finest_(std::min(side, 256)), sharpness_(4.0f * static_cast<float>(finest_ * finest_)) {
    const float octaves = log2(1 + sharpness_);
    count_ = static_cast<int>(octaves * density) + 2;
    per_octave_ = static_cast<float>(count_ - 1) / octaves;
  }
  int count() const { return count_; }
  float alpha(int level) const {
    return level == count_ - 1 ? 1.0f : std::sqrt((exp2(static_cast<float>(level) / per_octave_) - 1) / sharpness_);
  }
  /// Texels somewhat narrower than α, of the width of the lobe.
  int side(int level) const {
    if (level == 0) return side_;
    constexpr int least = 48;
    return std::min(finest_, std::max(least, static_cast<int>(2.86f / alpha(level)) / 4 * 4 + 4));
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
  static constexpr float density = 1.22f;  ///< least number of levels per octave of α²
  int side_, finest_;                      ///< of level 0, and the greatest of the others
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

/// The lobes of a level and those after it that share its cube map's size.
Lobes lobes_from(const Levels& levels, int level) {
  // Errors of whole texels vanish in lobes of about their size.
  constexpr float coarse = 0.4f, fine = 0.28f;
  Lobes lobes{{levels.alpha(level)}, 1, levels.alpha(level) * static_cast<float>(levels.side(0)) < 4 ? coarse : fine};
  while (lobes.count < Lobes::most && level + lobes.count < levels.count() &&
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

/// The control points, with a border of one texel, of the spline that interpolates samples with a border of four. The
/// inverse of the filter (1, 6, 1) / 8 falls by the factor √8 - 3 from one sample to the next, and ends after three.
/// Source: Unser, Aldroubi and Eden, B-Spline Signal Processing, IEEE Transactions on Signal Processing 41, 1993.
void fit_spline(const BorderedCube& samples, float* out) {
  constexpr float inverse[4] = {1 + 2 * (0.242641f - 0.041631f + 0.007143f), -0.242641f, 0.041631f, -0.007143f};
  const int side = samples.side;
  const auto filter = [&](const auto& at) {
    float3 sum = at(0) * inverse[0];
    for (int k = 1; k < 4; ++k) sum = sum + (at(-k) + at(k)) * inverse[k];
    return sum;
  };
  BorderedCube in_rows = samples;
  parallel_for(static_cast<std::size_t>(cube::faces), [&](std::size_t f) {
    const int face = static_cast<int>(f);
    float* to = out + 3 * f * static_cast<std::size_t>((side + 2) * (side + 2));
    for (int y = -border; y < side + border; ++y)
      for (int x = -1; x <= side; ++x)
        in_rows.at(face, x, y) = filter([&](int k) { return samples.at(face, x + k, y); });
    for (int y = -1; y <= side; ++y)
      for (int x = -1; x <= side; ++x, to += 3) {
        const float3 point = filter([&](int k) { return in_rows.at(face, x, y + k); });
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
constexpr char magic[8] = {'z', 'p', 'e', 'n', 'v', '0', '0', '6'};

}  // namespace

struct PreparedEnvironment::Header {
  char magic[8];
  std::int32_t side, unused;
  float3 mean, greatest;
  std::uint64_t hash;  ///< of the texels
};

PreparedEnvironment::PreparedEnvironment(const CubeImage& cube, const std::function<void(double)>& progress) {
  const Levels levels(cube.side);
  texels_.resize(3 * levels.lay_out(view_) + 1);
  const auto first = [&](int level) { return texels_.data() + 3 * static_cast<std::size_t>(view_.offset[level]); };

  // Every level as a spline of its own.
  const LightTree tree = make_light_tree(cube);
  for (std::size_t i = 0; i < tree.texels.texels.size(); ++i) {
    const float3 texel = tree.texels.texels[i];
    first(0)[3 * i] = texel.x, first(0)[3 * i + 1] = texel.y, first(0)[3 * i + 2] = texel.z;
  }
  std::vector<BorderedCube> samples(1);
  for (int level = 1; level < levels.count(); level = static_cast<int>(samples.size())) {
    if (progress) progress(static_cast<double>(view_.offset[level]) / view_.offset[levels.count()]);
    for (BorderedCube& of_level : filtered(tree, lobes_from(levels, level), levels.side(level)))
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
  for (std::size_t i = 0; i < 3 * tree.texels.texels.size(); ++i)
    first(0)[i] = (first(0)[i] + separate[i]) * (1 / 1.125f);

  mean_ = tree.mean();
  for (const float3& c : cube.texels)
    greatest_ = {std::max(greatest_.x, c.x), std::max(greatest_.y, c.y), std::max(greatest_.z, c.z)};
}

std::vector<std::uint8_t> PreparedEnvironment::bytes() const {
  const std::span texels(reinterpret_cast<const std::uint8_t*>(texels_.data()), texels_.size() * sizeof(float));
  Header header{};
  std::copy_n(magic, std::size(magic), header.magic);
  header.side = view_.side[0], header.mean = mean_, header.greatest = greatest_, header.hash = content_hash(texels);
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
  if (header.side < 32 || header.side > 512 || (header.side & (header.side - 1)) != 0) return std::nullopt;
  PreparedEnvironment out;
  const std::size_t floats = 3 * Levels(header.side).lay_out(out.view_) + 1;
  if (texels.size() != floats * sizeof(float) || content_hash(texels) != header.hash) return std::nullopt;
  out.texels_.resize(floats);
  std::memcpy(out.texels_.data(), texels.data(), texels.size());
  out.mean_ = header.mean, out.greatest_ = header.greatest;
  return out;
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
