// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Loads an AMF file, plain or as the only file of a ZIP archive: objects with volumes, constellations of any depth,
/// colours of materials, objects, volumes, vertices and triangles, of which each counts before those before it.
///
/// Colours are sRGB-encoded; those of vertices are interpolated. Textures, formulas and curved edges are not read.
/// Normals are computed, smooth across edges that bend by less than 50°. All surfaces are double-sided.
///
/// Space     Scene::up is +Z.
/// Units     millimetres, whatever the unit of the file.
/// Edges     as load_3mf.
/// Exact     the same scene, to the bit, for any number of threads.
/// Errors    ErrorKind::Input naming file and cause: XML that is not well-formed, nothing to draw, constellations
///           deeper than LoadLimits::node_depth.
/// Source    ISO/ASTM 52915, Specification for additive manufacturing file format.
Scene load_amf(const std::string& path, const LoadLimits& limits = {});

}  // namespace zoneplate
