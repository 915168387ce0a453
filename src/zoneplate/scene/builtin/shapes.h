// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/builtin/make.h"

namespace zoneplate {

/// Parts of the scenes that show artifacts.

/// An unlit double-sided surface of this colour.
Material unlit(const char* name, float3 light);

/// A flat quad of counter-clockwise corners: lower left, lower right, upper right, upper left; uv from (0, 1) to (1,
/// 0).
void add_quad(Mesh& mesh, const float3 (&corner)[4]);

/// The same with one colour, or one below and another above, at its corners. A mesh has colours at all of its vertices
/// or at none.
void add_quad(Mesh& mesh, const float3 (&corner)[4], float3 below, float3 above);

/// A box along the axes.
void add_box(Mesh& mesh, float3 low, float3 high);

/// A round bar with `sides` flat sides, open at its ends.
void add_bar(Mesh& mesh, float3 from, float3 to, float radius, int sides = 6);

/// A bar that hangs between two points as a parabola, `sag` below them in its middle, in `pieces` straight pieces.
void add_wire(Mesh& mesh, float3 from, float3 to, float sag, float radius, int pieces = 24);

/// A disc that faces +Z.
void add_disc(Mesh& mesh, float3 centre, float radius, int corners = 96);

/// Adds a material with its mesh as an object.
void add_part(Scene& scene, Material material, Mesh mesh);

/// An orthographic camera that looks along -Z; the image is `2 half_height` high.
Camera flat_camera(float half_height);

}  // namespace zoneplate
