// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "zoneplate/image/rgb.h"
#include "zoneplate/upscale/taau/sample_mean_rows.h"
#include "zoneplate/upscale/taau/taau_core.h"

namespace zoneplate::upscale {

/// Temporal antialiasing that upsamples: every output pixel is the mean of all samples that it has had, each with a
/// Gaussian weight by its distance, and knows the sum of these weights.
///
/// History is clamped to the extremes of the 3 × 3 samples of this frame and, where surfaces move as one, of the frames
/// before, whose extremes fade. Where the light changes, at once or slowly, it counts less or not at all; and where a
/// nearer surface has left, none does.
///
/// Exact     the same bits for any number of threads and any instruction set; one colour stays that colour.
class SampleMean {
 public:
  /// The frames after which a still image has settled, in periods of the jitter.
  static constexpr int settling_periods = 1;
  static constexpr int grain = 1;

  SampleMean(int width, int height);
  virtual ~SampleMean();

  /// The output after one more frame, until the next one: scene-linear, of the size given to the constructor.
  ///
  /// Requires  frames of one size, at most the output's, until the next one that is first.
  const LinearImage& accumulate(const TaauInput& frame);

  /// The number of samples that each pixel of the last output rests on: the sum of their weights.
  const Plane<float>& counts() const { return past_.count; }

 protected:
  /// What is known of each pixel of a frame.
  struct Boxes {
    LinearImage low, high;  ///< the extremes that history is clamped to
    Plane<float> alike;     ///< 1 where the surfaces around move as one
    Plane<float> trend;     ///< the mean over few frames of the sign of sample minus history
  };
  /// The surfaces whose motion history follows, and how much of it counts.
  struct Followed {
    Plane<float> nearest;  ///< reversed depth
    Plane<float> x, y, kept;
    Plane<float> borrowed;                   ///< 1 where they are not the pixels' own
    Plane<float> uncovered, steady, change;  ///< as CompareRow has them
  };
  /// A frame with what is known of it.
  struct Known {
    const TaauInput& input;
    const LinearImage& color;  ///< in the range that is accumulated
    const Boxes& boxes;
    const Followed& followed;
  };

  /// An image, and the sum of the weights of each pixel's samples.
  struct Output {
    LinearImage image;
    Plane<float> count;
  };

  /// Makes the image of a frame, and its counts: all of their pixels.
  virtual void resolve(const Known& known, Output& out);
  /// Calls body(frame, row) for each output row, which has its input but no output.
  void for_output_rows(const Known& known,
                       const std::function<void(const SampleMeanFrame& frame, SampleMeanRow& row)>& body) const;

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  struct Motions;
  struct Work;

  void compute_kept(const TaauInput& frame, Work& work) const;

  int width_, height_;
  bool has_history_ = false;
  Output past_, next_;  ///< the last output, and memory for the next one
  std::unique_ptr<Work> work_;
};

}  // namespace zoneplate::upscale
