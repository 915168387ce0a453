// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Loads a 3MF package: the objects that its build places, with components of any depth, in all model parts (production
/// extension), with base materials, colours, textures, composite materials and multiproperties.
///
/// Each placed mesh is an object of the scene. Materials and textures are described in docs/formats.md; normals are
/// computed, smooth across edges that bend by less than 50°. All surfaces are double-sided.
///
/// Space     Scene::up is +Z.
/// Units     millimetres, whatever the unit of the model.
/// Edges     triangles, properties, textures, components and items that are invalid are left out, with a warning of
///           the first of each kind, as is an object that contains itself.
/// Exact     the same scene, to the bit, for any number of threads.
/// Errors    ErrorKind::Input naming file, part and cause: no package, no model, XML that is not well-formed, nothing
///           to draw, components deeper than LoadLimits::node_depth.
/// Source    3MF Core Specification 1.3, Materials and Properties Extension 1.2, Production Extension 1.1.
Scene load_3mf(const std::string& path, const LoadLimits& limits = {});

}  // namespace zoneplate
