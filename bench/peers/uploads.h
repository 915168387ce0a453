// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "peer.h"

namespace zoneplate::peers {

/// One record of eight numbers per vertex: position, normal, texture coordinates.
std::vector<float> interleaved_vertices(const Mesh& mesh);

/// The mip levels of an image, largest first: rounded means of two by two texels. (Mesa's own are not rounded to the
/// nearest.)
std::vector<Rgba8Image> mip_levels(const Rgba8Image& image);

/// The uniforms of the shaders, in the layout of a block of std430.
struct Uniforms {
  float4x4 clip_from_world;       ///< depth 0 at the near plane, 1 at the far plane, as in Vulkan
  float4 base, eye, light, look;  ///< look: ambient, specular, exponent
};
Uniforms uniforms_of(const Scene& scene, const Work& work);

bool is_lit(const Scene& scene);
bool is_textured(const Scene& scene);

}  // namespace zoneplate::peers
