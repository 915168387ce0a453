// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/vec.h"
#include "zoneplate/scene/material.h"
#include "zoneplate/scene/texture_filter.h"
#include "zoneplate/shade/texture/texture.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// Looks up a texture at `uv`, for user shaders (render/user_shader.h): red, green, blue and straight alpha; colours
/// are linear.
///
/// `dx` and `dy` are the derivatives of `uv` per pixel to the right and downwards. They choose the mip levels, and with
/// Sampler::anisotropy the probes. Filtering is that of FilteringKernels, bit for bit as in materials.
float4 sample(const Texture& texture, const Sampler& sampler, float2 uv, float2 dx, float2 dy);

/// The same by another filter, with the wrap modes of the sampler. `random`: three numbers in [0, 1), for
/// TextureFilter::Kind::Stochastic alone.
float4 sample(const Texture& texture, const Sampler& sampler, const TextureFilter& filter, float2 uv, float2 dx,
              float2 dy, float3 random = {});

}  // namespace zoneplate
#pragma GCC visibility pop
