// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <vector>

#include "zoneplate/antialias/temporal/options.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {

/// Temporal antialiasing by the parts of its options: the history, and the resolve.
class TemporalAccumulation : public Resolver {
 public:
  explicit TemporalAccumulation(const TemporalOptions& options);

  /// The sample of a frame, and the planes that `resolve` reads.
  bool has_history() const override { return true; }
  Request request(const FrameContext& context) override;
  /// The resolved image of the frame of the last request.
  LinearImage resolve(Frame& frame) override;
  /// The image, in which pixels without history are filtered by SMAA if the options say so.
  DisplayImage post_process(DisplayImage image, const Frame& frame) override;

 private:
  /// A plane that continues beyond the image by TemporalRow::border pixels, with its outermost values.
  using Bordered = Plane<float>;
  /// The channels of every row, one after the other: ColorPlanes.
  using ColorRows = Plane<float>;
  /// The planes of this frame; those that no part reads are empty, or of earlier frames.
  struct Current {
    Bordered nearness, motion[2], surface, last_depth, last_nearness, changes, drift, bend;
    Plane<float> restless, lasting, relit, wide_relit;
  };
  /// Buffers that threads use in turns, so that they stay in the caches.
  class Buffers {
   public:
    Plane<float> take();
    void put(Plane<float> buffer);

   private:
    std::mutex mutex_;
    std::vector<Plane<float>> free_;
  };
  SamplePosition sample() const;
  bool tests_surfaces() const;
  void take_surfaces(const Frame& frame);
  /// By the object's number plus one; infinite for an object that was visible in the last frame only.
  struct ObjectMotions {
    std::vector<float> x, y;
  };
  ObjectMotions object_motions(const Frame& frame);
  void detect_restless(const ObjectMotions& objects);
  void detect_changes(const Frame& frame);
  void detect_lasting(const Frame& frame);
  void begin_history(const Frame& frame);
  void begin_luminances();
  void keep_surfaces(const Frame& frame);
  LinearImage blended(Frame& frame);
  LinearImage sharpened(LinearImage image) const;

  TemporalOptions options_;
  SamplePattern jitter_;
  FrameContext context_;

  Current current_;
  ColorRows history_, next_history_;  ///< encoded
  Plane<float> frames_, next_frames_;
  /// Luminance: of the last frame, its difference from the frame before, its mean over few frames, and its variance.
  Bordered last_, fast_, noise_, next_noise_;
  Plane<float> step_;
  Plane<float> past_surface_, past_depth_, past_nearness_;
  Buffers band_buffers_;
  std::size_t past_objects_ = 0;  ///< one more than the greatest number of an object so far, and one for none
};

}  // namespace zoneplate::antialias
