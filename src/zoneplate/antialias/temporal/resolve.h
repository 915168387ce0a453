// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/antialias/temporal/color_planes.h"
#include "zoneplate/antialias/temporal/parts.h"
#include "zoneplate/base/isa.h"

namespace zoneplate::antialias {

/// One row of a frame with its history, for TemporalKernels::resolve.
///
/// Shape     pointers to pixel 0 of the row. The planes of this frame continue for `border` pixels on all sides;
///           `stride` is the number of floats from one row of theirs to the next, but for colours. The planes of the
///           last frame have `width` × `height` pixels without a border, and begin at pixel (0, 0).
struct TemporalRow {
  static constexpr int border = 2;

  ColorPlanes<const float> color;  ///< by TemporalKernels::encode
  const float* nearness;           ///< reversed depth
  const float* motion[2];          ///< in pixels
  const float* surface;            ///< a number of the object; negative without a surface
  const float* last_depth;         ///< the distance that the surface had from the last camera
  const float* last_nearness;      ///< its reversed depth in the last frame
  const float*
      restless;  ///< 0 where the 3 × 3 surfaces move as one, as those of the last frame did; 2 where one has left
  const float* lasting;  ///< by TemporalKernels::find_drift: infinite where history at rest is trusted
  const float* noise;    ///< the variance of luminance by the jitter
  std::ptrdiff_t stride;
  const float* column;  ///< 0, 1, 2, ...
  int y;

  ColorPlanes<const float> history;
  const float* frames;  ///< the number of frames in each pixel of the history, or its confidence
  const float* past_surface;
  const float* past_depth;
  const float* past_nearness;
  int width, height;

  ColorPlanes<float> resolved;  ///< the history of the next frame
  float* frames_out;
};

/// One row of a frame's surfaces, for TemporalKernels::take_surfaces.
struct SurfaceRow {
  const std::uint32_t* ids;
  const float* motion;         ///< two numbers per pixel; or null
  const float* last_position;  ///< three numbers per pixel: the point in the last frame's world; or null
  float last_eye[3], last_forward[3];
  float *surface, *motion_x, *motion_y, *last_depth;
};

/// One row of a frame with the objects of the last frame, for TemporalKernels::compute_unrest.
struct UnrestRow {
  const float *motion[2], *surface;  ///< as in TemporalRow
  std::ptrdiff_t stride;
  const float* column;  ///< 0, 1, 2, ...
  int y, width, height;
  const float* past_surface;      ///< without a border
  const float* object_motion[2];  ///< means by the object's number plus one; infinite without a pixel in this frame
};

/// One row of a frame with the history of the same pixels, for TemporalKernels::detect_changes.
struct ChangeRow {
  const float* linear;  ///< colours of four floats, as `encode` reads them
  bool is_compressed;
  const float* restless;
  ColorPlanes<const float> history;  ///< of this row
  const float* frames;
  float* last;         ///< luminance of the last frame; becomes that of this one
  float* step;         ///< its difference from the frame before; likewise
  float* fast;         ///< its mean over few frames
  const float* noise;  ///< its variance by the jitter
  float* bend;         ///< the change of `step`
  float* changes;
  float* drift;
};

/// One row of what `detect_changes` has made, for TemporalKernels::find_drift.
struct DriftRow {
  const float *changes, *drift, *last, *fast, *noise, *bend;  ///< with borders of a pixel
  std::ptrdiff_t stride;                                      ///< floats from one row of theirs to the next
  const float* frames;
};

struct TemporalKernels : PerIsa<TemporalKernels> {
  /// Colours, of four floats a pixel, without NaN, negative and unbounded values.
  ///
  /// Edges     values above 65504, the greatest half float, become 65504.
  void (*limit)(const float* linear, float* limited, std::size_t n);
  /// The colours of `limit` by channel; and compressed: the straight colour c becomes c / (1 + max(r, g, b)),
  /// premultiplied again.
  void (*encode)(const float* linear, bool is_compressed, const ColorPlanes<float>& encoded, std::size_t n);
  /// The colours that `encode` compressed. A pixel with resolved = encoded becomes its own `linear`, bit by bit.
  void (*decode)(const ColorPlanes<const float>& resolved, const ColorPlanes<const float>& encoded, const float* linear,
                 bool is_compressed, float* out, std::size_t n);
  /// The numbers of objects, -1 for Frame::no_id; and, where the row has them, motion by coordinate and the distances
  /// that points had along the last camera's axis, which are undefined without a surface.
  void (*take_surfaces)(const SurfaceRow& row, std::size_t n);
  /// 1 where a surface moves, or the 3 × 3 surfaces do not move as one, 2 where a surface of the last frame moves
  /// otherwise, 0 elsewhere. An object of the last frame is taken to have moved by its mean motion.
  void (*compute_unrest)(const UnrestRow& row, float* unrest, std::size_t n);
  /// Brings the luminances of a row up to this frame, and compares them with the history.
  ///
  /// `changes` are 1 where a pixel at rest is brighter than the spread of its history allows, -1 where it is darker,
  /// 0 elsewhere; `drift` is the difference of the mean of few frames from the history's, 0 where surfaces do not rest.
  void (*detect_changes)(const ChangeRow& row, std::size_t n);
  /// The number of frames that history at rest may count as: infinite where it is trusted, otherwise it is rectified
  /// and counts as `unlimited` frames or less.
  ///
  /// It is not trusted where it differs from this frame's sample and from mean ± deviation of 3 × 3 samples by more
  /// than four deviations of the noise. It counts as `relit_frames` where the light drifts: where the mean of few
  /// frames differs from the history's by more than their standard errors, in the sum over 3 × 3 pixels.
  ///
  /// `relit` is 1 where at least seven of 3 × 3 changes are 1, or seven are -1, beyond those of the other sign, and 0
  /// elsewhere: the light has changed at once. The samples of a still scene change along edges and in details of a
  /// pixel's width; an edge at rest crosses three of 3 × 3 pixels, or five if it is diagonal.
  ///
  /// @return   true if any is relit.
  bool (*find_drift)(const DriftRow& row, float* lasting, float* relit, float* next_noise, std::size_t n);
  /// Resolves n pixels of a row: filters the current colours, reprojects, validates and rectifies the history, and
  /// blends both.
  ///
  /// Exact     where all colours and the history are equal, the result is that colour, bit by bit.
  void (*resolve)(const TemporalRow& row, const TemporalParts& parts, std::size_t n);
  /// out = the 4-neighbours' unsharp mask of n pixels, limited to the extremes of the five pixels. `color` continues
  /// for a pixel on all sides.
  void (*sharpen)(const float* color, std::ptrdiff_t stride, float strength, float* out, std::size_t n);
};

}  // namespace zoneplate::antialias
