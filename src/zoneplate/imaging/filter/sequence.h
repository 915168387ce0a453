// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zoneplate/imaging/filter/items.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/metrics/file/picture_set.h"
#include "zoneplate/process/delivery.h"

namespace zoneplate {

/// The frames of a sequence of any renderer, and the method with history that makes images of them.
struct SequenceFilter {
  std::string method;  ///< as for upscale::make_method
  std::vector<FilterItem> items;
  /// The frames of the only item, which is an animation; none: each item is a frame.
  std::optional<metrics::PictureSet> animation = {};
  FramePasses passes;         ///< the files with the data of each frame; none: those of the frames
  std::string jitter;         ///< a text file with the sample of each frame; empty: that of the method
  float2 motion_scale{1, 1};  ///< from the unit of the motion files to pixels, x right, y down, now minus last
  float fov = 60;             ///< vertical field of view, degrees
  std::optional<int2> size;   ///< of the images; none: that of the frames times `scale`
  double scale = 1;
  std::string layer = {};  ///< of the frames, if they are EXR images
  int bit_depth = 8;
  std::optional<float4> background;  ///< laid under frames with alpha: an encoded colour with straight alpha
};

/// True if the method keeps history of one-sample frames and reads no planes but those that files contain.
bool filters_sequences(const std::string& method);

/// Filters the frames in order and delivers each image, after it has checked that all files fit together. A pixel that
/// is not finite takes the mean of its neighbours, so that it does not enter the history; a warning counts them.
///
/// Errors    ErrorKind::Input naming the file that is missing, lacks a channel or has another size; ErrorKind::Usage
///           naming a frame that is not opaque, for a method that makes opaque images.
void filter_sequence(const SequenceFilter& filter, Delivery& out);

}  // namespace zoneplate
