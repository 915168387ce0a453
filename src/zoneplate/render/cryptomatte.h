// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zoneplate/math/vec.h"
#include "zoneplate/render/frame.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The 32-bit MurmurHash3 (x86_32) with seed 0.
///
/// Source    Appleby, smhasher, 2011.
std::uint32_t murmur3(std::string_view text);

/// The id of a name in Cryptomatte: its hash as the bits of a float, with one exponent bit flipped where the float
/// would be 0, denormal, infinite or NaN.
float cryptomatte_id(std::string_view name);

enum class MatteKind { Object, Material };

/// The coverage of each pixel by named objects or materials: pairs of id and coverage, the greatest coverage first.
///
/// Shape     each plane holds two ranks: (id, coverage, id, coverage); six in all. Unused ranks are (0, 0).
/// Exact     coverage is the fraction of the pixel's samples; with equal coverage the lower index comes first. Items of
///           one name are merged; an item without a name is named by its index: "material 3".
/// Source    Friedman and Jones, Cryptomatte Specification 1.2.0, 2018.
struct Cryptomatte {
  static constexpr int levels = 6;
  std::string layer;  ///< "CryptoObject"
  std::vector<Plane<float4>> ranks;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< for the file: hash, conversion, manifest
};

/// Requires  frame.sample_triangle, rendered from this scene.
Cryptomatte make_cryptomatte(const Frame& frame, const Scene& scene, MatteKind kind);

}  // namespace zoneplate
