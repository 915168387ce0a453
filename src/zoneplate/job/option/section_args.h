// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zoneplate/scene/geometry/section.h"

namespace zoneplate {

/// The planes of --section, in their order, and the colour of the caps.
struct SectionArgs {
  std::vector<SectionPlane> planes;
  std::optional<float4> color;  ///< linear; none: that of the surfaces that are cut

  /// All of it as one text, for keys.
  std::string text() const;
};

/// The value of --section, "x,y,z,offset".
/// Errors    ErrorKind::Usage for another text and a normal of length zero.
SectionPlane parse_section(const std::string& text);

}  // namespace zoneplate
