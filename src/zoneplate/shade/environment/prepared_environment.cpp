// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/prepared_environment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/scene/environment.h"
#include "zoneplate/shade/environment/equirectangular.h"
#include "zoneplate/shade/environment/light_tree.h"
#include "zoneplate/shade/environment/prefilter.h"

namespace zoneplate {
namespace {

constexpr int levels = 12;

/// The inverse of EnvironmentView::level.
float roughness_of(int level) {
  return 1.5f - std::sqrt(2.25f - 2 * static_cast<float>(level) / static_cast<float>(levels - 1));
}

/// Texels as wide as two thirds of alpha, which is about half the width of the lobe.
int side_of(float alpha, int greatest) {
  int side = 32;
  while (side < greatest && static_cast<float>(side) * alpha < 1.5f) side *= 2;
  return side;
}

void store(float* texel, float3 light) { texel[0] = light.x, texel[1] = light.y, texel[2] = light.z; }

std::size_t face_texels(int side) { return static_cast<std::size_t>(side + 2) * static_cast<std::size_t>(side + 2); }

/// A level of a prepared environment: faces with a border of one texel, four floats each.
struct Level {
  int side;
  float* first;

  /// Texel (x, y) of a face; from -1 to `side`.
  float* texel(int face, int x, int y) const {
    return first +
           4 * (static_cast<std::size_t>(face) * face_texels(side) +
                static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(side + 2) + static_cast<std::size_t>(x + 1));
  }
  float3 light(int face, int x, int y) const {
    const float* const t = texel(face, x, y);
    return {t[0], t[1], t[2]};
  }
};

/// A texel of the border is the texel of the neighbouring face that touches it; the corners are the means of the three
/// texels about a corner of the cube. So both faces at an edge interpolate the same texels there.
void fill_borders(const Level& level) {
  const int side = level.side;
  const auto outside = [&](int face, int x, int y) {
    const cube::Place p = cube::place(cube::point(face, cube::centre(x, side), cube::centre(y, side)));
    const auto cell = [&](float c) {
      return std::min(static_cast<int>((c + 1) * 0.5f * static_cast<float>(side)), side - 1);
    };
    return level.light(p.face, cell(p.s), cell(p.t));
  };
  for (int face = 0; face < cube::faces; ++face) {
    for (int i = 0; i < side; ++i)
      for (const int edge : {-1, side}) {
        store(level.texel(face, edge, i), outside(face, edge, i));
        store(level.texel(face, i, edge), outside(face, i, edge));
      }
    for (const int x : {-1, side})
      for (const int y : {-1, side}) {
        const int inner_x = x < 0 ? 0 : side - 1, inner_y = y < 0 ? 0 : side - 1;
        store(level.texel(face, x, y),
              (level.light(face, inner_x, inner_y) + level.light(face, x, inner_y) + level.light(face, inner_x, y)) *
                  (1.0f / 3));
      }
  }
}

void copy_level(const CubeImage& cube, const Level& level) {
  parallel_for(static_cast<std::size_t>(cube::faces * cube.side), [&](std::size_t row) {
    const int face = static_cast<int>(row) / cube.side, y = static_cast<int>(row) % cube.side;
    for (int x = 0; x < cube.side; ++x) store(level.texel(face, x, y), cube.texels[cube.index(face, x, y)]);
  });
  fill_borders(level);
}

/// By blocks of 4 × 4 texels.
void filter_level(const LightTree& tree, float alpha, const Level& level) {
  const PrefilterKernels& kernels = PrefilterKernels::of();
  const int side = level.side, blocks = side / 4;
  const Lobe lobe{.alpha = alpha, .detail = alpha < 0.03f ? 0.33f : alpha < 0.2f ? 0.25f : 0.2f};
  parallel_for(static_cast<std::size_t>(cube::faces * blocks), [&](std::size_t row) {
    const int face = static_cast<int>(row) / blocks, first_y = static_cast<int>(row) % blocks * 4;
    for (int first_x = 0; first_x < side; first_x += 4) {
      DirectionBlock directions;
      for (int i = 0; i < DirectionBlock::size; ++i) {
        const float3 d =
            normalize(cube::point(face, cube::centre(first_x + i % 4, side), cube::centre(first_y + i / 4, side)));
        directions.x[i] = d.x, directions.y[i] = d.y, directions.z[i] = d.z;
      }
      RadianceBlock light;
      kernels.filter(tree, lobe, directions, light);
      for (int i = 0; i < DirectionBlock::size; ++i)
        store(level.texel(face, first_x + i % 4, first_y + i / 4), {light.r[i], light.g[i], light.b[i]});
    }
  });
  fill_borders(level);
}

/// A change of the filter changes its version.
constexpr char magic[8] = {'z', 'p', 'e', 'n', 'v', '0', '0', '3'};

/// The levels of an environment whose unfiltered level has this side; returns the number of texels.
std::size_t lay_out(int side, EnvironmentView& view) {
  view.levels = levels;
  std::size_t texels = 0;
  for (int level = 0; level < levels; ++level) {
    const float roughness = roughness_of(level);
    view.side[level] = level == 0 ? side : side_of(roughness * roughness, std::max(32, side / 2));
    view.offset[level] = static_cast<std::int32_t>(texels);
    texels += cube::faces * face_texels(view.side[level]);
  }
  return texels;
}

}  // namespace

struct PreparedEnvironment::Header {
  char magic[8];
  std::int32_t side, unused;
  float3 mean, greatest;
  std::uint64_t hash;  ///< of the texels
};

PreparedEnvironment::PreparedEnvironment(const CubeImage& cube) {
  texels_.resize(4 * lay_out(cube.side, view_));
  const auto level_of = [&](int i) {
    return Level{view_.side[i], texels_.data() + 4 * static_cast<std::size_t>(view_.offset[i])};
  };
  copy_level(cube, level_of(0));
  const LightTree tree = make_light_tree(cube);
  for (int level = 1; level < levels; ++level) {
    const float roughness = level == levels - 1 ? 1 : roughness_of(level);
    filter_level(tree, roughness * roughness, level_of(level));
  }
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
  const std::size_t floats = 4 * lay_out(header.side, out.view_);
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
