// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zoneplate::antialias {

/// The parts of temporal antialiasing: what the resolve does with the current frame and the history.
struct TemporalParts {
  /// Of which pixel the motion is taken: its own, or the nearest surface among its 3 × 3 neighbours, or among itself
  /// and four pixels at two pixels' distance along the diagonals.
  enum class Dilation { None, Square, Cross };
  /// How history is sampled between pixels. Catmull-Rom without its corners has 12 of 16 texels, which a GPU fetches by
  /// 5 bilinear lookups instead of 9.
  enum class Filter { Bilinear, CatmullRom5, CatmullRom9 };
  /// How history outside the colours of the neighbourhood changes: each channel is clamped to the box, or the colour
  /// moves towards its centre until it is inside.
  enum class Rectification { None, Clamp, Clip };
  /// The box of the 3 × 3 colours: their extremes, the mean of the extremes of 3 × 3 and of the plus-shaped 5, their
  /// mean ± gamma standard deviations, or that and, of what it allows, what the extremes of R, G and B allow.
  enum class Box { Extremes, Rounded, Variance, Both };
  /// When history is dropped: never; where all of the 3 × 3 surfaces around the reprojected position were nearer than
  /// the surface was then (Depth), or of other objects (Id); where all were of other objects or depths and none was
  /// farther away (Both), so that details thinner than a pixel keep their history; or as three.js, where a nearer
  /// surface was there, but not at edges of depth.
  enum class Rejection { None, Depth, Id, Both, Edge };
  /// The weight of the current frame: fixed; 1 / n of n frames; or that of INSIDE, three.js, Bevy, Unreal Engine 4.
  enum class Blend { Fixed, Count, Contrast, Velocity, Confidence, Motion };
  /// The factor of each colour's weight: 1, or 1 / (1 + luminance) of the colour (Luma) or of the compressed colour.
  enum class Weighting { None, Luma, Compressed };

  Dilation dilation = Dilation::Square;
  Filter filter = Filter::CatmullRom9;
  bool is_normalized = true;  ///< the weights of CatmullRom5 are divided by their sum, which is at least 0.984
  Rectification rectification = Rectification::Clip;
  Box box = Box::Variance;
  bool is_ycocg = true;    ///< the box is in Y, Co, Cg, otherwise in R, G, B
  float gamma = 1;         ///< of Variance and Both, for surfaces at rest
  float moving_gamma = 1;  ///< the same at `fast` pixels per frame
  Rejection rejection = Rejection::Both;
  /// Where all surfaces around rest, history is neither tested nor rectified, unless the light changes, at once or
  /// slowly: TemporalKernels::find_drift.
  bool trusts_rest = false;
  float tolerance = 0.01f;  ///< of depths, relative
  Blend blend = Blend::Count;
  float min_weight = 0.05f;  ///< of the current frame
  Weighting weighting = Weighting::None;
  bool is_compressed = false;        ///< c / (1 + max c) is averaged instead of the straight colour c
  bool keeps_current_alpha = false;  ///< alpha is that of the current frame
  bool has_kernel = false;           ///< the current colour is the mean of 3 × 3 colours with the weights `kernel`
  float kernel[9] = {};              ///< by row; their sum is 1
  /// The number of frames that the history counts as where a surface has left, or the light has changed by more than
  /// `max_change`: what remains fades soon.
  static constexpr float left_frames = 2;
  static constexpr float relit_frames = 5;   ///< where the light has changed by less, which the history follows
  static constexpr float max_change = 2;     ///< of the light, by which the history is scaled
  static constexpr float unlimited = 65536;  ///< more frames do not count
  static constexpr float known_frames = 3;   ///< in a history whose spread is that of its samples
  static constexpr float fast = 128;         ///< pixels per frame
};

}  // namespace zoneplate::antialias
