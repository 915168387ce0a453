// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <variant>

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The type of the texels of a decoded image. Alpha is always straight.
enum class TexelKind : std::uint8_t {
  Codes8,   ///< Rgba8 as stored in the file: linear or sRGB-encoded, depending on the use of the image
  Codes16,  ///< Rgba16, the same in 1/65535
  Light,    ///< float4 (red, green, blue, alpha): linear light, of HDR and EXR files; any floats, NaN included
};

/// A decoded image in the precision of its file.
class TexelImage {
 public:
  /// An image without texels.
  TexelImage() = default;
  ///@{
  /// Takes over a plane of texels, whose type decides the kind.
  TexelImage(Rgba8Image codes) : planes_(std::move(codes)) {}
  TexelImage(Rgba16Image codes) : planes_(std::move(codes)) {}
  TexelImage(Plane<float4> light) : planes_(std::move(light)) {}
  ///@}

  /// Calls `body` with the image as a Plane of its type of texels.
  template <class Body>
  decltype(auto) visit(Body&& body) const {
    return std::visit(std::forward<Body>(body), planes_);
  }

  /// The type of the texels; Codes8 for an empty image.
  TexelKind kind() const { return static_cast<TexelKind>(planes_.index()); }
  /// Texels in a row.
  int width() const {
    return visit([](const auto& plane) { return plane.width(); });
  }
  /// Rows of texels.
  int height() const {
    return visit([](const auto& plane) { return plane.height(); });
  }
  /// True if there are no texels.
  bool empty() const {
    return visit([](const auto& plane) { return plane.empty(); });
  }

  /// The image as a Plane<Texel>.
  /// Requires  `Texel` is the type that `kind` stands for.
  template <class Texel>
  const Plane<Texel>& as() const {
    return std::get<Plane<Texel>>(planes_);
  }
  bool operator==(const TexelImage&) const = default;

 private:
  std::variant<Rgba8Image, Rgba16Image, Plane<float4>> planes_;  ///< in the order of TexelKind
};

}  // namespace zoneplate
#pragma GCC visibility pop
