#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zoneplate/math/vec.h"
#include "zoneplate/render/frame.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The least precision with which a channel is stored. Number: an unsigned integer of 32 bits.
enum class ChannelPrecision { Half, Float, Number };

/// One channel of a data pass: a view of a frame's values, one per pixel, rows without padding.
struct DataChannel {
  std::string name;  ///< with its layer, as in "N.X", by the conventions of OpenEXR files
  ChannelPrecision precision = ChannelPrecision::Float;
  const float* value = nullptr;           ///< the first pixel's value, unless `precision` is Number
  const std::uint32_t* number = nullptr;  ///< the first pixel's value if `precision` is Number
  std::size_t step = 1;                   ///< distance between the values of neighbouring pixels
};

/// Data passes as channels: views of a frame's planes and of planes derived from them (`made`).
struct DataChannels {
  std::vector<DataChannel> list;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< metadata for readers of the channels
  std::deque<Plane<float4>> made;
};

/// A data pass (arbitrary output variable).
struct Aov {
  std::string_view name, meaning;
  bool Planes::*plane;  ///< the plane of the frame from which the pass is made
  /// Adds the channels of the pass. The frame must outlive them.
  void (*add_channels)(const Frame&, const Scene&, DataChannels&);
};

/// All data passes.
std::span<const Aov> aovs();

}  // namespace zoneplate
