// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/frame.h"

#include <iterator>

namespace zoneplate {
namespace {

constexpr bool Planes::*all_planes[] = {
    &Planes::depth,         &Planes::normal,        &Planes::albedo,       &Planes::uv,
    &Planes::object_id,     &Planes::material_id,   &Planes::primitive_id, &Planes::coverage,
    &Planes::position,      &Planes::motion,        &Planes::flow,         &Planes::error,
    &Planes::mip_level,     &Planes::anisotropy,    &Planes::samples,      &Planes::sample_triangles,
    &Planes::sample_colors, &Planes::last_position, &Planes::was_visible,  &Planes::diffuse,
    &Planes::specular,      &Planes::transmission,  &Planes::emission};
static_assert(std::size(all_planes) * sizeof(bool) == sizeof(Planes), "a plane is missing");

}  // namespace

Planes Planes::operator|(const Planes& o) const {
  Planes both = *this;
  for (const auto plane : all_planes) both.*plane = both.*plane || o.*plane;
  return both;
}

}  // namespace zoneplate
