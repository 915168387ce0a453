// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/antialias/temporal/options.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {

/// Temporal antialiasing by the parts of its options: the history, and the resolve.
class TemporalAccumulation : public Resolver {
 public:
  explicit TemporalAccumulation(const TemporalOptions& options);

  /// The sample of a frame, and the planes that `resolve` reads.
  Request request(const FrameContext& context) override;
  /// The resolved image of the frame of the last request.
  LinearImage resolve(Frame& frame) override;
  /// The image, in which pixels without history are filtered by SMAA if the options say so.
  DisplayImage post_process(DisplayImage image, const Frame& frame) override;

 private:
  /// A plane that continues beyond the image by TemporalRow::border pixels, with its outermost values.
  using Bordered = Plane<float>;
  /// The planes of this frame; those that no part reads are empty, or of earlier frames.
  struct Current {
    LinearImage color;
    Bordered nearness, motion[2], surface, last_depth, last_nearness, changes;
    Plane<float> restless, relit, wide_relit;
  };
  SamplePosition sample() const;
  bool tests_surfaces() const;
  void take_current(const Frame& frame);
  /// By the object's number plus one; infinite for an object that was visible in the last frame only.
  struct ObjectMotions {
    std::vector<float> x, y;
  };
  ObjectMotions object_motions(const Frame& frame) const;
  void find_restless(const ObjectMotions& objects);
  void find_relit();
  void begin_history(const Frame& frame);
  void keep_surfaces(const Frame& frame);
  LinearImage blended(Frame& frame);
  LinearImage sharpened(LinearImage image) const;

  TemporalOptions options_;
  SamplePattern jitter_;
  FrameContext context_;

  Current current_;
  LinearImage history_, next_history_;  ///< encoded
  Plane<float> frames_, next_frames_, squares_, next_squares_;
  Plane<float> past_surface_, past_depth_, past_nearness_;
};

}  // namespace zoneplate::antialias
