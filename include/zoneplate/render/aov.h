#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zoneplate/base/api.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/render/frame.h"
#include "zoneplate/scene/scene.h"

namespace ZONEPLATE_API zoneplate {

/// How exactly a channel is stored at least. A number is an unsigned word of 32 bits.
enum class ChannelPrecision {
  Half,    ///< a 16-bit float
  Float,   ///< a 32-bit float
  Number,  ///< an unsigned 32-bit integer
};

/// One channel of a data pass: a view of values that a frame holds, one per pixel, rows without padding.
struct DataChannel {
  std::string name;  ///< with its layer, as in "N.X", by the usual names of OpenEXR files
  ChannelPrecision precision = ChannelPrecision::Float;  ///< the least that a file should use
  const float* value = nullptr;                          ///< the first pixel's, unless `precision` is Number
  const std::uint32_t* number = nullptr;                 ///< the same where it is
  std::size_t step = 1;                                  ///< from a pixel's value to the next one's
};

/// Data passes as channels: views of a frame, and of what was made from it.
struct DataChannels {
  std::vector<DataChannel> list;                                ///< in the order in which the passes were added
  std::vector<std::pair<std::string, std::string>> attributes;  ///< what a reader of the channels has to know
  std::deque<Plane<float4>> made;  ///< owns the values of channels that no plane of the frame holds (Cryptomatte)
};

/// A data pass (arbitrary output variable).
struct Aov {
  std::string_view name;     ///< as `--aov` takes it: "depth"
  std::string_view meaning;  ///< one line for listings
  bool Planes::*plane;       ///< the plane of the frame that it is made from
  /// Adds the channels of the pass. The frame outlives them.
  void (*add_channels)(const Frame&, const Scene&, DataChannels&);
};

/// All data passes.
std::span<const Aov> aovs();

}  // namespace zoneplate
