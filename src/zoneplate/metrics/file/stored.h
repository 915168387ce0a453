// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/inspect/color_space.h"
#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// The bytes of an image file, or a frame of an animated one, and its name for messages.
struct ImageFile {
  std::string name;
  std::span<const std::uint8_t> bytes;
  std::shared_ptr<const void> owner = nullptr;  ///< of the bytes
  ExrChoice exr = {};                           ///< the image that is meant, if it is an EXR
  /// The frame of the animation in the bytes; null: the bytes are one image.
  std::function<Picture()> decode_frame = {};
  std::function<const ImageColor&()> frame_color = {};  ///< of the frames of `decode_frame`
};

/// A number of pixels of one channel: "R" of the measured layer, "depth.Z" of another, "left.R" of the part `left`.
struct ChannelCount {
  std::string channel;
  std::size_t pixels = 0;
};

/// The values of an image that are not finite, by channel.
struct NotFinite {
  std::vector<ChannelCount> channels;
  bool is_wrong = false;  ///< NaN in any channel, or an infinity in a colour: of data, such as depth, it may be a value
};

/// How the stored values of two files differ.
struct StoredDifference {
  bool is_identical = true;
  std::vector<ChannelCount> differing;
  std::vector<std::string> equal_layers;  ///< channels without a metric that are equal
  NotFinite reference, test;
  /// What else differs or is not compared, a line each: layers of one file alone, meanings of colours, animations.
  std::vector<std::string> notes;

  /// True if there is more to say than that the values are equal and in order.
  bool has_news() const { return !differing.empty() || !notes.empty() || reference.is_wrong || test.is_wrong; }
};

/// Compares what two image files store: every channel of every part before any conversion, the meaning of the values
/// (color_space_of), and the number of frames. `reference` and `test` are the decoded files; pixels that the reference
/// ignores are left out.
///
/// Exact     equal values are equal bits: NaN equals only the same NaN. Codes of 8 and of 16 bits are equal if they are
///           the same share of the range.
/// The notes say which meaning the values have, if it is another than sRGB, and whether metrics have to convert them
/// (share_space).
StoredDifference compare_stored(const ImageFile& reference_file, const Picture& reference, const ImageFile& test_file,
                                const Picture& test);

/// True if the values of both mean the same colours; else in_srgb (metrics/file/picture_file.h) makes them comparable.
bool share_space(const Picture& reference, const Picture& test);

}  // namespace zoneplate::metrics
