#pragma once

#include <concepts>
#include <cstdint>
#include <utility>

#include "zoneplate/math/vec.h"

namespace zoneplate {

/// The argument of a user shader's vertex stage: the vertex's index in the arrays that the shader itself holds.
struct Vertex {
  std::uint32_t index = 0;
};

/// A user shader: pure functions, compiled into the batched loops that call them.
///
/// `Varyings` is a struct of floats only. `vertex` returns the clip position (reversed depth, see math/transform.h) and
/// the varyings; it may be called more than once for a vertex. The arguments of `fragment` are the perspective-correct
/// varyings, their derivatives per pixel to the right and their derivatives per pixel down; it returns a linear,
/// premultiplied colour.
template <class S>
concept Shader = requires(const S& s, const Vertex& v, const typename S::Varyings& u) {
  { s.vertex(v) } -> std::same_as<std::pair<float4, typename S::Varyings>>;
  { s.fragment(u, u, u) } -> std::same_as<float4>;
};

}  // namespace zoneplate
