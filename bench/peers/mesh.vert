// SPDX-License-Identifier: Apache-2.0
// The vertex shader of the benchmark scenes in Vulkan.
#version 450
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(push_constant) uniform Uniforms { mat4 clip_from_world; vec4 base, eye, light, look; };
#ifdef LIT
layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
#endif
#ifdef TEXTURED
layout(location = 2) out vec2 texture_uv;
#endif
void main() {
#ifdef LIT
  world_position = position;
  world_normal = normal;
#endif
#ifdef TEXTURED
  texture_uv = uv;
#endif
  gl_Position = clip_from_world * vec4(position, 1.0);
}
