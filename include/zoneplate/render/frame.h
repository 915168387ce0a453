// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/signal/samples.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The data passes that may be stored in addition to the colour; a pass that is not requested costs nothing.
struct Planes {
  bool depth = false;                               ///< Frame::depth and Frame::reversed_depth
  bool normal = false, albedo = false, uv = false;  ///< as in Frame
  bool object_id = false, material_id = false, primitive_id = false, coverage = false;  ///< as in Frame
  bool position = false, motion = false, flow = false;                                  ///< as in Frame
  bool last_position = false, was_visible = false;                                      ///< as in Frame
  bool mip_level = false, anisotropy = false;                                           ///< as in Frame
  bool error = false;                                                              ///< only of methods that estimate it
  bool diffuse = false, specular = false, transmission = false, emission = false;  ///< Frame::light; of Renderer only
  bool samples = false;           ///< colour, depth and triangle id of every sample
  bool sample_triangles = false;  ///< triangle id of every sample alone
  bool sample_colors = false;     ///< colour of every sample alone

  /// The planes that are computed from the pixels' primitive ids.
  bool any_point_plane() const { return position || motion || flow || last_position || was_visible; }
  /// True if a plane by pixel is requested that visibility decides: all but `error`, `samples` and `sample_colors`.
  bool any_pixel_plane() const {
    return depth || normal || albedo || uv || mip_level || anisotropy || object_id || material_id || primitive_id ||
           coverage || any_point_plane() || sample_triangles;
  }
  /// True if anything is requested.
  bool any() const { return any_pixel_plane() || any_light() || error || samples || sample_colors; }
  /// True if a component of the light is requested.
  bool any_light() const { return diffuse || specular || transmission || emission; }
  /// The union of both.
  Planes operator|(const Planes& o) const;
};

/// One rendered frame, before the method's Resolver::resolve and before tone mapping.
///
/// Shape     all planes have the frame's size; planes that were not requested are empty.
/// Space     colour is linear and premultiplied, without the background.
/// Edges     a pixel's data come from one point of one surface and are never averaged: the opaque or alpha-tested
///           triangle that owns the pixel's nearest sample, at the pixel's centre if it owns all samples, otherwise at
///           the mean of the samples that it owns, where it is shaded (at rate *sample*, at the nearest sample). Depth,
///           normal, albedo, uv, position, motion and flow all belong to that point. `coverage` is the fraction of the
///           pixel's samples that any such surface owns. Blended surfaces write colour only.
struct Frame {
  static constexpr std::uint32_t no_id = 0xffffffffu;  ///< no surface at a pixel or sample

  int x = 0, y = 0;       ///< position of its first pixel in the whole image; not 0 for a crop
  LinearImage color{};    ///< resolved inside the tiles with the method's weights
  Rgba8Image display8{};  ///< display-referred, in place of `color`, if Request::writes_display8
  LinearImage memory{};   ///< an image that the method resolved before, or none: `resolve` may reuse its memory
  Plane<SamplePosition>
      data_position;     ///< in the pixel: where the data are evaluated; made for position, motion and the like
  Plane<float> depth{};  ///< distance along the view axis, world units; +infinity in empty pixels
  Plane<float> reversed_depth{};  ///< as in the depth test: 1 near, 0 far
  Plane<float3> normal{};         ///< world space, unit length, towards the viewer
  Plane<float3> albedo{};         ///< linear base colour
  Plane<float2> uv{};             ///< texture coordinates of the base colour
  Plane<float>
      mip_level{};  ///< level of detail in the base colour's texture; FragmentOutputs::no_mip_level without one
  Plane<float> anisotropy{};  ///< longer over shorter axis of the footprint in that texture; 0 without one
  Plane<std::uint32_t> object_id{}, material_id{}, primitive_id{};  ///< no_id in empty pixels
  Plane<std::uint32_t> instance{};                                  ///< index into Scene::instances
  Plane<float3> position{};                                         ///< world space
  Plane<float2> motion{};  ///< pixels, x right, y down: the surface point's position now minus its last one, no jitter
  Plane<float2> flow{};    ///< the surface point's next position minus its position now, as `motion`
  Plane<float3>
      last_position;  ///< of the surface point in the last frame, as `position`; where it had none, `position`
  /// 1 where the last frame's camera saw the surface point: within the image, and no surface with an opacity above one
  /// half lay before it. By rays to the triangles of the last frame. If it is requested, all data are those at the
  /// nearest sample: another surface may hide the pixel's centre.
  Plane<std::uint8_t> was_visible{};
  Plane<float> coverage{};  ///< in [0, 1]
  /// The components of the colour, premultiplied by its alpha: diffuse, specular, transmission, emission, as in
  /// LightComponent. Where the method's mean is linear, as that of ssaa and msaa, they add up to the colour.
  std::array<Plane<float3>, 4> light{};
  Plane<float> error{};  ///< estimated standard error of the colour, the maximum of its channels

  DisplayOptions display{};  ///< the display transform of the image; set before `Resolver::resolve`

  std::vector<LinearImage> sample_color{};              ///< by sample
  std::vector<Plane<float>> sample_depth{};             ///< reversed
  std::vector<Plane<std::uint32_t>> sample_triangle{};  ///< triangle id; no_id in empty samples

  /// By sample, of opaque and alpha-tested surfaces (Content::Geometry). r, g, b: the interpolated vertex normal in
  /// world space, unit length, on the visible side, without normal maps; towards the viewer if the mesh has no normals.
  /// a: the distance along the view axis, world units. Empty samples are 0.
  std::vector<LinearImage> sample_geometry{};

  /// The distance from the pixel's centre to the line through the nearest edge of the visible triangle, along the axis
  /// of the screen that crosses the line more steeply (Content::EdgeDistances). x: along the row, positive to the
  /// right; y: along the column, positive downwards; pixels, rounded to 16-bit floats. The other axis has the value
  /// no_edge, and in empty pixels both have.
  Plane<float2> edge_distance{};
  static constexpr float no_edge = 0.5f;  ///< of an axis along which there is no edge in the pixel

  /// Calls use(plane) for every data plane by pixel and every triangle plane by sample, empty or not: for all planes
  /// but the colours and the results of Content other than Colour.
  template <class Use>
  void for_data_planes(Use use) {
    for_data_planes(*this, *this, [&](auto& plane, auto&) { use(plane); });
  }
  /// Calls use(plane of a, plane of b) for the same planes of two frames.
  ///
  /// Requires  both have the same number of triangle planes by sample.
  template <class Use>
  static void for_data_planes(Frame& a, Frame& b, Use use) {
    for_surface_planes(a, b, use);
    use(a.coverage, b.coverage), use(a.error, b.error);
    for (std::size_t k = 0; k < a.light.size(); ++k) use(a.light[k], b.light[k]);
    for (std::size_t s = 0; s < a.sample_triangle.size(); ++s) use(a.sample_triangle[s], b.sample_triangle[s]);
  }
  /// The same for those planes whose values are of the nearest surface of a pixel.
  template <class Use>
  static void for_surface_planes(Frame& a, Frame& b, Use use) {
    use(a.data_position, b.data_position), use(a.depth, b.depth), use(a.reversed_depth, b.reversed_depth);
    use(a.normal, b.normal), use(a.albedo, b.albedo), use(a.uv, b.uv);
    use(a.mip_level, b.mip_level), use(a.anisotropy, b.anisotropy), use(a.object_id, b.object_id);
    use(a.material_id, b.material_id), use(a.primitive_id, b.primitive_id), use(a.instance, b.instance);
    use(a.position, b.position), use(a.motion, b.motion), use(a.flow, b.flow);
    use(a.last_position, b.last_position), use(a.was_visible, b.was_visible);
  }
};

}  // namespace zoneplate
#pragma GCC visibility pop
