// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace zoneplate {

/// The place of the frame number in a name, and the minimum number of its digits.
struct FramePlace {
  std::size_t begin = 0, size = 0;
  int digits = 1;
};

/// Finds the placeholder of the frame number: "####" or "@@@@", "%04d", "$F" or "$F4", "{frame}" or "{frame:04}".
///
/// "#", "@", "%d" and "$F", which give no width, are placeholders only if neither a letter nor a digit follows:
/// "chair@2x.png" and "100%done.png" have none. No placeholder is followed by a digit.
std::optional<FramePlace> find_frame_place(const std::string& name);

/// Writes the frame number at its place, padded with zeros as it specifies.
///
/// "a.####.png" and 7 give "a.0007.png". Numbers longer than the placeholder are written in full.
std::string frame_name(const std::string& name, const FramePlace& place, int frame);

/// The frame number that is written as `text` with that minimum of digits; nothing if there is none.
std::optional<std::int64_t> frame_of(std::string_view text, int digits);

}  // namespace zoneplate
