#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {

/// The data passes that may be stored beside the colour; what nobody asks for costs nothing.
struct Planes {
  bool depth = false, normal = false, albedo = false, uv = false;
  bool object_id = false, material_id = false, primitive_id = false, coverage = false;
  bool position = false, motion = false, flow = false;
  bool error = false;             ///< of methods that estimate it
  bool samples = false;           ///< colour, depth and triangle id of every sample
  bool sample_triangles = false;  ///< triangle id of every sample alone
  bool sample_colors = false;     ///< colour of every sample alone

  /// What is found from the pixels' primitives.
  bool any_point_plane() const { return position || motion || flow; }
  bool any_pixel_plane() const {
    return depth || normal || albedo || uv || object_id || material_id || primitive_id || coverage ||
           any_point_plane() || sample_triangles;
  }
  bool any() const { return any_pixel_plane() || error || samples || sample_colors; }
  /// The planes of either.
  Planes operator|(const Planes& o) const;
};

/// One rendered picture, before the method's last word and before tone mapping.
///
/// Shape     all planes have the picture's size, or are empty where they were not asked for.
/// Space     colour is linear and premultiplied, without the background.
/// Edges     a pixel's data come from one point of one surface, never from an average of two: of the opaque or masked
///           triangle that owns the pixel's nearest sample, at the pixel's centre if it owns all samples, else at the
///           mean of those it owns, where it is shaded (at the nearest sample, where every sample is shaded by itself).
///           Depth, normal, albedo, uv, position, motion and flow are all of that point. `coverage` is the share of the
///           pixel's samples that any such surface owns. Blended surfaces write colour only.
struct Frame {
  static constexpr std::uint32_t no_id = 0xffffffffu;

  int x = 0, y = 0;             ///< of its first pixel in the whole picture; not 0 where it is cropped
  LinearImage color;            ///< resolved inside the tiles with the method's weights
  Rgba8Image shown;             ///< the same as shown, in place of `color`, where that was asked for
  Plane<SamplePosition> place;  ///< in the pixel, of the point that data are of; where position, motion or flow is
  Plane<float> depth;           ///< distance along the view axis, world units; +infinity where nothing is
  Plane<float> reversed_depth;  ///< as tested: 1 near, 0 far
  Plane<float3> normal;         ///< world space, unit length, towards the viewer
  Plane<float3> albedo;         ///< linear base colour
  Plane<float2> uv;
  Plane<std::uint32_t> object_id, material_id, primitive_id;  ///< no_id where nothing is
  Plane<std::uint32_t> instance;                              ///< index into Scene::instances
  Plane<float3> position;                                     ///< world space
  Plane<float2> motion;  ///< pixels, x right, y down: the surface point now minus at the last moment, no jitter
  Plane<float2> flow;    ///< the same at the next moment minus now
  Plane<float> coverage;
  Plane<float> error;  ///< estimated standard error of the colour, the greatest of its channels

  DisplayOptions display;  ///< how the picture is to be shown; set before `Resolver::resolve`

  std::vector<LinearImage> sample_color;              ///< by sample
  std::vector<Plane<float>> sample_depth;             ///< reversed
  std::vector<Plane<std::uint32_t>> sample_triangle;  ///< triangle id, no_id where nothing is

  /// By sample, of opaque and masked surfaces (Content::Geometry). r, g, b: the interpolated vertex normal, world
  /// space, unit length, on the side that is seen, without normal maps; towards the viewer where a mesh has no normals.
  /// a: the distance along the view axis, world units. All are 0 where nothing is.
  std::vector<LinearImage> sample_geometry;

  /// How far the line through the nearest edge of the visible triangle is from the pixel's centre, along the axis of
  /// the screen that crosses the line more steeply (Content::EdgeDistances). x: along the row, positive to the right;
  /// y: along the column, positive downwards; pixels, rounded to 16-bit floats. The other axis has no_edge, and both
  /// have it where nothing is.
  Plane<float2> edge_distance;
  static constexpr float no_edge = 0.5f;

  /// Calls use(plane) for every plane of data by pixel and every one of triangles by sample, empty or not: all but the
  /// colours and what Content other than Colour makes.
  template <class Use>
  void for_data_planes(Use use) {
    for_data_planes(*this, *this, [&](auto& plane, auto&) { use(plane); });
  }
  /// The same for the planes of two frames, pair by pair. Requires: as many planes of triangles by sample in both.
  template <class Use>
  static void for_data_planes(Frame& a, Frame& b, Use use) {
    use(a.place, b.place), use(a.depth, b.depth), use(a.reversed_depth, b.reversed_depth), use(a.normal, b.normal);
    use(a.albedo, b.albedo), use(a.uv, b.uv), use(a.object_id, b.object_id), use(a.material_id, b.material_id);
    use(a.primitive_id, b.primitive_id), use(a.instance, b.instance), use(a.position, b.position);
    use(a.motion, b.motion), use(a.flow, b.flow), use(a.coverage, b.coverage), use(a.error, b.error);
    for (std::size_t s = 0; s < a.sample_triangle.size(); ++s) use(a.sample_triangle[s], b.sample_triangle[s]);
  }
};

}  // namespace zoneplate
