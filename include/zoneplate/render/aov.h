// SPDX-License-Identifier: Apache-2.0
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

#pragma GCC visibility push(default)
namespace zoneplate {

/// The least precision with which a channel is stored.
enum class ChannelPrecision {
  Half,    ///< a 16-bit float
  Float,   ///< a 32-bit float
  Number,  ///< an unsigned 32-bit integer
};

/// One channel of a data pass: a view of a frame's values, one per pixel, rows without padding.
struct DataChannel {
  std::string name{};  ///< with its layer, as in "N.X", by the conventions of OpenEXR files
  ChannelPrecision precision = ChannelPrecision::Float;  ///< the least that a file should use
  const float* value = nullptr;                          ///< the first pixel's value, unless `precision` is Number
  const std::uint32_t* number = nullptr;                 ///< the first pixel's value if `precision` is Number
  std::size_t step = 1;                                  ///< distance between the values of neighbouring pixels
};

/// Data passes as channels: views of a frame's planes and of planes derived from them (`made`).
struct DataChannels {
  std::vector<DataChannel> list{};                                ///< in the order in which the passes were added
  std::vector<std::pair<std::string, std::string>> attributes{};  ///< metadata for readers of the channels
  std::deque<Plane<float4>> made{};    ///< the values of channels that no plane of the frame holds (Cryptomatte)
  std::deque<Plane<float3>> places{};  ///< positions in the coordinates of a file whose scene has an origin
};

/// A data pass (arbitrary output variable).
struct Aov {
  std::string_view name{};     ///< the value of `--aov`: "depth"
  std::string_view meaning{};  ///< one line for listings
  bool Planes::*plane;         ///< the plane of the frame from which the pass is made
  /// Adds the channels of the pass. The frame must outlive them.
  void (*add_channels)(const Frame&, const Scene&, DataChannels&);
};

/// All data passes.
std::span<const Aov> aovs();

}  // namespace zoneplate
#pragma GCC visibility pop
