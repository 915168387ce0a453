#pragma once

#include <concepts>
#include <cstdint>
#include <utility>

#include "zoneplate/math/vec.h"

namespace zoneplate {

/// A vertex as a user's shader sees it: its number in the arrays that the shader itself holds.
struct Vertex {
  std::uint32_t index = 0;
};

/// A user's shader: pure functions, compiled into the batched loops that call them.
///
/// `Varyings` is a struct of floats only. `vertex` gives the clip position (reversed depth, see math/transform.h)
/// and the varyings; it may be run more than once for a vertex. `fragment` gets the perspective-correct varyings, their
/// change per pixel to the right and their change per pixel down, and gives a linear, premultiplied colour.
template <class S>
concept Shader = requires(const S& s, const Vertex& v, const typename S::Varyings& u) {
  { s.vertex(v) } -> std::same_as<std::pair<float4, typename S::Varyings>>;
  { s.fragment(u, u, u) } -> std::same_as<float4>;
};

}  // namespace zoneplate
