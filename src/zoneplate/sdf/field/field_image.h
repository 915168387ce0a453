// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/plane.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/sdf/outline.h"

namespace zoneplate::sdf {

/// What the channels of a stored field hold.
enum class FieldKind {
  Single,      ///< the distance in every channel (msdf-atlas-gen: sdf)
  Multi,       ///< red, green, blue: their median is the distance, also next to corners (msdf)
  MultiAlpha,  ///< as Multi, with the distance in alpha (mtsdf)
};

/// Distances at the centres of texels, positive inside, as programs store them in textures.
///
/// Units     texels.
struct FieldImage {
  FieldKind kind = FieldKind::Single;
  Plane<float4> distances;

  /// The distance at a position in texels, whose centres have the fraction ½: the median of the first three channels,
  /// each interpolated bilinearly; clamped to the outermost centres.
  float at(double x, double y) const;
  /// Adds the coverage of each pixel, at most 1 in all; `scale` pixels are one texel, and the field's corner is at
  /// `corner` in pixels. Coverage is that of the half-plane of the distance and its central differences.
  void add_coverage(Plane<float>& image, Point corner, double scale) const;
  /// The same for the texels within `part` only, whose corner is at `corner`; other texels are not read if its sides
  /// are at centres of texels.
  void add_part(Plane<float>& image, Point corner, double scale, const Bounds& part) const;
};

/// The field of an outline in an image of width × height texels; p is at scale · p + move in texels.
///
/// Multi     the distance to each part of the outline, extended beyond its ends along its tangents, is stored in two or
///           three channels, so that the parts at a corner share one channel only. Where the interpolated median would
///           have the wrong sign, the texels get their median in all channels.
/// Requires  contours do not cross.
/// Source    Chlumský, Shape Decomposition for Multi-channel Distance Fields, 2015: simple edge colouring, and pseudo-
///           distances with ties decided by the angle at the end.
FieldImage outline_field(const Outline& outline, FieldKind kind, int width, int height, double scale, Point move);

/// The channels of each segment of a contour, bit 0 for red: neighbours at a corner share exactly one.
///
/// Edges     a contour with one corner is divided into three parts, and short ones by dividing their segments, in place.
std::vector<unsigned> color_edges(Contour& contour);

/// The area of a half-plane in a unit square around a point at distance d from its boundary, positive inside, with its
/// normal along (x, y).
double half_plane_area(double x, double y, double d);

}  // namespace zoneplate::sdf
