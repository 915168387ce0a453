// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "zoneplate/codec/animation.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/scene/texel_image.h"

namespace zoneplate {

/// What an animated image states besides its pixels.
struct AnimationInfo {
  int2 size;               ///< of the composed frames
  std::size_t frames = 0;  ///< at least one
  int loops = 0;           ///< number of repetitions, at most 65535; 0: endless
  bool has_alpha = true;   ///< false: all pixels of all frames are opaque
};

/// A frame of an animated image as a player shows it.
struct AnimationFrame {
  TexelImage image;  ///< straight codes of 8 bits, or of 16 of an APNG of 16 bits
  FrameTime time;    ///< how long it is shown
};

/// Reads the frames of an animated image in order. Each is composed with those before it: `dispose` and `blend` of
/// APNG, disposal methods of GIF, disposal and blending of WebP.
class AnimationReader {
 public:
  virtual ~AnimationReader() = default;
  virtual const AnimationInfo& info() const = 0;
  /// The next frame.
  ///
  /// Requires  fewer than info().frames calls before.
  /// Errors    ErrorKind::Input with the name of the file in front: corrupt, truncated.
  virtual AnimationFrame next() = 0;
};

/// Opens an animated PNG, GIF or WebP of more than one frame; null for other bytes. The bytes outlive the reader;
/// `name` is the prefix of error messages.
///
/// Errors    ErrorKind::Input with `name` in front: corrupt, truncated, frames of more than `max_pixels` pixels.
std::unique_ptr<AnimationReader> open_animation(std::span<const std::uint8_t> bytes, const std::string& name,
                                                std::uint64_t max_pixels);

/// The number of frames that an animated PNG, GIF or WebP states or contains; 1 for other bytes.
std::size_t count_frames(std::span<const std::uint8_t> bytes);

}  // namespace zoneplate
