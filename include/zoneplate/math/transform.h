// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/mat.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// A rotation as a quaternion x i + y j + z k + w, in glTF's order of components.
struct Quaternion {
  float x = 0, y = 0, z = 0, w = 1;  ///< x, y, z: the vector part; w: the scalar part
};

/// Moves points by `t`.
float4x4 translation(float3 t);
/// Multiplies x, y and z by the components of `s`.
float4x4 scaling(float3 s);
/// Rotation by a unit quaternion (it is normalised first; zero gives the identity).
float4x4 rotation(Quaternion q);
/// Rotation by `angle` about `axis`, counter-clockwise when the axis points at the viewer.
float4x4 rotation(float3 axis, float angle);

/// The rigid transform camera_from_world of a camera at `eye` that looks at `target` along -Z with `up` upwards. Its
/// inverse is Camera::world_from_camera.
///
/// If up is parallel to the view direction, another up vector is used (+Z, then +X), so that the transform always
/// exists.
float4x4 look_at(float3 eye, float3 target, float3 up);

/// Perspective projection to clip space with w = distance along the view axis and *reversed* depth:
/// z/w is 1 at `near` and 0 at `far`; x/w and y/w are in [-1, 1] inside the frustum, y upwards.
///
/// Units     `vertical_fov` in radians, in (0, π); aspect = width / height; 0 < near < far, far may be infinite.
/// Source    l, r, b, t from field of view and aspect: t = near tan(fov/2), r = t aspect.
float4x4 perspective(float vertical_fov, float aspect, float near, float far);

/// Orthographic projection, reversed depth: z is 1 at `near` and 0 at `far`. Half extents in world units.
float4x4 orthographic(float half_width, float half_height, float near, float far);

}  // namespace zoneplate
#pragma GCC visibility pop
