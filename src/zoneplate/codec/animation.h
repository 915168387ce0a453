// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// How long a frame is shown.
struct FrameTime {
  int seconds = 0, per = 1;  ///< seconds / per; both at most 65535, `per` at least 1
  bool operator==(const FrameTime&) const = default;

  /// The nearest fraction with numbers of that size, in lowest terms; 0 for negative times.
  static FrameTime of_microseconds(std::int64_t microseconds);
  static FrameTime of_milliseconds(std::int64_t milliseconds) { return of_microseconds(1000 * milliseconds); }
};

/// How the frames of an animation are played and stored.
struct AnimationFormat {
  int seconds = 1, per = 10;  ///< each frame without a time of its own lasts seconds / per; both in [1, 65535]
  int loops = 0;              ///< number of repetitions, at most 65535; 0: endless
  bool has_alpha = false;     ///< false: alpha is not written
};

/// The frames of an animation.
///
/// Shape     all frames have the size of the first; there is at least one.
struct Animation {
  AnimationFormat format;
  std::vector<Rgba8Image> frames;
};

/// Encodes an animation in memory while its frames are made.
class AnimationEncoder {
 public:
  virtual ~AnimationEncoder() = default;
  /// Appends a frame, shown for `time` or else for that of the format, and returns the work that encodes it. The caller
  /// runs that work once; works of different frames may run at the same time and in any order.
  ///
  /// Requires  all frames have the same size. `add` is called by one thread at a time.
  /// Errors    those of the format, thrown by the work.
  virtual std::function<void()> add(std::shared_ptr<const Rgba8Image> frame,
                                    std::optional<FrameTime> time = std::nullopt) = 0;
  /// The file. Called once, when the work of all frames is complete.
  ///
  /// Requires  at least one frame.
  virtual std::vector<std::uint8_t> finish() = 0;
};

/// The file of an animation whose frames are all in memory.
///
/// Errors    those of the encoder.
std::vector<std::uint8_t> encode_animation(AnimationEncoder& encoder, const Animation& animation);

}  // namespace zoneplate
