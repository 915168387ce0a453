// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "zoneplate/render/method.h"

namespace zoneplate::antialias {

/// Temporal antialiasing with exact visibility, and with a colour of its own for every object in a pixel.
///
/// Each frame shades one jittered sample per pixel. Further samples, without shading, find which objects a pixel has,
/// what fraction of it they cover, how they move, and whether the last frame's camera saw them there. The colour of an
/// object in a pixel is the mean of its shaded samples in earlier frames, which is moved along with the object; the
/// pixel is the mean of these colours by coverage. So no colour of one object enters another.
///
/// With a scale above 1 the frames have fewer pixels than the image: a pixel of the image has a shaded sample in some
/// frames only, and its objects are found by more passes of fewer samples.
class SurfaceHistory : public Resolver {
 public:
  struct Options {
    int most = 64;      ///< frames of which a colour is a mean, at most
    int length = 16;    ///< of the jitter's period
    int coverage = 16;  ///< samples of a pixel for visibility
    double scale = 1;   ///< pixels of the image per pixel of a frame, per axis
  };
  explicit SurfaceHistory(const Options& options);

  bool has_history() const override { return true; }
  Request request(const FrameContext& context) override;
  /// The passes for visibility, one sample each.
  std::optional<Request> refine(Frame& frame) override;
  /// The whole image, also if a crop is requested.
  LinearImage resolve(Frame& frame) override;

 private:
  /// Objects of a pixel that are kept; those with the fewest samples are rarely beyond.
  static constexpr std::size_t capacity = 4;

  /// The colour of an object in a pixel.
  struct Layer {
    Linear color{0, 0, 0, 0};
    float luma = 0, square = 0;  ///< means over the samples
    float frames = 0;            ///< of which the colour is a mean; 0: there is none; below 1: of other pixels' samples
    std::uint32_t object = 0;
  };
  /// An object in a pixel of this frame.
  struct Presence {
    std::uint32_t object = 0;
    int samples = 0;      ///< that it owns
    int seen = 0;         ///< samples that the last camera saw
    float2 motion{0, 0};  ///< sum over those
  };
  struct Presences {
    std::array<Presence, capacity> entry;
    std::size_t count = 0;
    Presence* find(std::uint32_t object);
  };
  using Layers = std::array<Layer, capacity>;
  /// The history of a shaded sample's object, and the sample's luma minus that of the history; 0 without history.
  struct Change {
    Layer past;
    float luma = 0;
    float variance = 0;   ///< of the luma of such samples under the same light
    float tolerance = 0;  ///< below this, changes of light do not matter
  };

  struct Cell {
    int x, y;
  };
  void filter_textures_for_samples(Request& request) const;
  Cell cell_of(int x, int y, SamplePosition position) const;
  bool has_sample(std::uint32_t object, int x, int y) const;
  template <class Use>
  void for_samples_around(std::uint32_t object, int x, int y, int radius, const Use& use) const;
  Linear color_around(int x, int y) const;
  void take_shaded(Frame& frame, SamplePosition position);
  void add(const Frame& frame, SamplePosition position, int weight);
  Layer moved(std::uint32_t object, float x, float y) const;
  Layer past_of(const Presence& presence, int x, int y) const;
  float range_around(int x, int y) const;
  void detect_changes();
  bool has_changed(std::uint32_t object, int x, int y) const;
  Layer borrowed(std::uint32_t object, int x, int y) const;
  Layer guessed(const Layer& past, std::uint32_t object, int x, int y) const;
  Layer updated(const Presence& presence, int x, int y) const;

  Options options_;
  SamplePattern jitter_, coverage_;
  FrameContext context_;
  std::size_t pass_ = 0;

  int width_ = 0, height_ = 0;              ///< of the image
  int frame_width_ = 0, frame_height_ = 0;  ///< of the frames
  int radius_ = 1;                          ///< pixels around one that contain its neighbours' samples

  LinearImage color_;  ///< of this frame's shaded samples
  Plane<std::uint32_t> object_;
  Plane<std::uint8_t> is_shaded_;
  Plane<Presences> presences_;
  Plane<Change> changes_;
  Plane<Layers> history_;
};

}  // namespace zoneplate::antialias
