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

/// A name as Cryptomatte stores it: its hash as the bits of a float, with one exponent bit turned where the float would
/// be 0, denormal, infinite or not a number.
float cryptomatte_id(std::string_view name);

enum class MatteKind { Object, Material };

/// Which named things own how much of each pixel: pairs of id and coverage, the greatest coverage first.
///
/// Shape     each plane holds two ranks: (id, coverage, id, coverage); six in all. (0, 0) where there are no more.
/// Exact     coverage is the share of the pixel's samples; of equal ones the earlier thing comes first. Things of one
///           name are one; one without a name is called after its number: "material 3".
/// Source    Friedman and Jones, Cryptomatte Specification 1.2.0, 2018.
struct Cryptomatte {
  static constexpr int levels = 6;
  std::string layer;  ///< "CryptoObject"
  std::vector<Plane<float4>> ranks;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< of the file: hash, conversion, manifest
};

/// Requires  frame.sample_triangle, drawn from this scene.
Cryptomatte make_cryptomatte(const Frame& frame, const Scene& scene, MatteKind kind);

}  // namespace zoneplate
