// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/codec/animation.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/imaging/filter/items.h"
#include "zoneplate/metrics/file/picture_set.h"
#include "zoneplate/process/delivery.h"

namespace zoneplate {

/// The name of frame `i` of an animation whose frames are written as images of their own: `output` with the number in
/// its place; in a folder (outputs_folder), the name of the input with a number.
std::string frame_output(const FilterItem& item, std::size_t i);

/// The filtered frames of an animation on their way to one film, or to an image for each, in the confined process.
class FrameSink {
 public:
  /// Errors    ErrorKind::Usage if the output is a file of one image.
  FrameSink(const FilterItem& item, const metrics::PictureSet& frames, int bit_depth, Delivery& out);

  /// Errors    ErrorKind::Usage for a transparent pixel if the film has no alpha.
  void add(const DisplayImage& image, FrameTime time);
  /// Called once, last.
  void finish();

 private:
  void add_to_film(Rgba8Image image, FrameTime time);

  const FilterItem& item_;
  const int bit_depth_;
  Delivery& out_;
  std::unique_ptr<AnimationEncoder> film_;  ///< null: images
  std::size_t done_ = 0;
  double begin_ = 0;            ///< of the next frame, in seconds
  std::int64_t gif_begin_ = 0;  ///< of the next frame of a GIF, in hundredths of a second
};

/// Takes the files of a FrameSink that are not the output itself, out of the confined process: the images, whose names
/// must follow each other, or a film that ffmpeg has yet to encode.
class FrameReceiver {
 public:
  /// `kept` are the files that are not replaced.
  FrameReceiver(const FilterItem& item, std::span<const std::string> kept, const ProgramLimits& encoder)
      : item_(item), kept_(kept.begin(), kept.end()), encoder_(encoder) {}

  /// Errors    ErrorKind::Failed for a file that is not expected; those of ffmpeg and of saving.
  void take(const std::string& name, std::span<const std::uint8_t> bytes);

 private:
  const FilterItem item_;
  const std::vector<std::string> kept_;
  const ProgramLimits encoder_;
  std::size_t done_ = 0;
};

}  // namespace zoneplate
