// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "zoneplate/math/mat.h"
#include "zoneplate/scene/environment.h"
#include "zoneplate/scene/texel_image.h"
#include "zoneplate/shade/environment/cube.h"
#include "zoneplate/shade/environment/environment_view.h"

namespace zoneplate {

/// An environment's radiance, filtered for reflection by surfaces of every roughness.
///
/// Exact     the same bits for any number of threads and any instruction set.
class PreparedEnvironment {
 public:
  static constexpr int largest_side = 512;

  /// `progress` takes the fraction that is complete, in [0, 1].
  ///
  /// Requires  the side is a power of two from 32 to largest_side.
  explicit PreparedEnvironment(const CubeImage& cube, const std::function<void(double)>& progress = {});

  /// The radiance multiplied and turned as `environment` says; its image is this one.
  EnvironmentView view(const Environment& environment, float3 up, const float4x4& world_from_camera = {}) const;

  /// The environment as bytes, for files that this version of the program reads again on this machine.
  std::vector<std::uint8_t> bytes() const;
  /// The environment of such bytes; nothing where they are damaged or of another version.
  static std::optional<PreparedEnvironment> from_bytes(std::span<const std::uint8_t> bytes);
  /// The greatest number of them.
  static std::size_t max_bytes();

  /// The mean radiance over all directions, and the greatest of each channel, both without the factors of a view.
  float3 mean() const { return mean_; }
  float3 greatest() const { return max_; }

 private:
  PreparedEnvironment() = default;
  struct Header;
  EnvironmentView view_;
  std::vector<float> texels_;
  float3 mean_{0, 0, 0}, max_{0, 0, 0};
  bool has_sharp_lights_ = false;  ///< narrow lobes have larger maps
};

/// A number for bytes, by which prepared environments are found again: equal for equal bytes only, but for chance.
std::uint64_t content_hash(std::span<const std::uint8_t> bytes);

/// Requires  the image is not empty.
PreparedEnvironment prepare_equirectangular(const TexelImage& image);

}  // namespace zoneplate
