// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/builtin/make.h"

namespace zoneplate {

/// Parts of the scenes with artifacts.

/// An unlit double-sided surface of this colour.
Material unlit(const char* name, float3 light);

/// The same surface, matt and lit.
Material lit(const char* name, float3 color);

/// Adds a flat quad of counter-clockwise corners: lower left, lower right, upper right, upper left; uv from (0, 1) to
/// (1, 0).
void add_quad(Mesh& mesh, const float3 (&corner)[4]);

/// Adds a quad with one colour at the lower and another at the upper corners. A mesh has colours at all of its vertices
/// or at none.
void add_quad(Mesh& mesh, const float3 (&corner)[4], float3 below, float3 above);

/// Adds an axis-aligned box.
void add_box(Mesh& mesh, float3 low, float3 high);

/// Adds a cylindrical bar with `sides` flat sides, open at its ends.
void add_bar(Mesh& mesh, float3 from, float3 to, float radius, int sides = 6);

/// Adds a bar of `pieces` straight pieces that hangs between two points as a parabola, `sag` below them in the middle.
void add_wire(Mesh& mesh, float3 from, float3 to, float sag, float radius, int pieces = 24);

/// Adds a disc that faces +Z.
void add_disc(Mesh& mesh, float3 centre, float radius, int corners = 96);

/// Adds a material with its mesh as an object.
void add_part(Scene& scene, Material material, Mesh mesh);

/// An orthographic camera that looks along -Z; the image is `2 half_height` high.
Camera flat_camera(float half_height);

}  // namespace zoneplate
