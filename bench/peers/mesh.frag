// SPDX-License-Identifier: Apache-2.0
// The fragment shader of the benchmark scenes in Vulkan. look: ambient, specular, exponent.
#version 450
layout(push_constant) uniform Uniforms { mat4 clip_from_world; vec4 base, eye, light, look; };
#ifdef LIT
layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
#endif
#ifdef TEXTURED
layout(location = 2) in vec2 texture_uv;
layout(set = 0, binding = 0) uniform sampler2D image;
#endif
layout(location = 0) out vec4 color;
void main() {
  vec4 surface = base;
#ifdef TEXTURED
  surface = texture(image, texture_uv);
#endif
#ifdef LIT
  vec3 n = normalize(world_normal), v = normalize(eye.xyz - world_position), h = normalize(light.xyz + v);
  float diffuse = max(dot(n, light.xyz), 0.0), gloss = pow(max(dot(n, h), 0.0), look.z);
  color = vec4(surface.rgb * (look.x + diffuse) + vec3(look.y * gloss), 1.0);
#else
  color = surface;
#endif
}
