// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/option/section_args.h"

#include <fmt/format.h>

#include "zoneplate/base/error.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate {

std::string SectionArgs::text() const {
  std::string out;
  for (const SectionPlane& p : planes)
    out += fmt::format("{:a},{:a},{:a},{:a};", p.normal.x, p.normal.y, p.normal.z, p.offset);
  if (color) out += fmt::format("{:a},{:a},{:a},{:a}", color->x, color->y, color->z, color->w);
  return out;
}

SectionPlane parse_section(const std::string& text) {
  const std::size_t last = text.rfind(',');
  try {
    if (last != std::string::npos) {
      const SectionPlane plane{parse_triple(text.substr(0, last)), parse_number(text.substr(last + 1), -1e30, 1e30)};
      if (plane.normal != double3{}) return plane;
    }
  } catch (const Error&) {  // the message about one number would not name the form of all
  }
  throw Error(ErrorKind::Usage,
              fmt::format("'{}' is not a plane x,y,z,offset with a normal x,y,z that is not 0", text));
}

}  // namespace zoneplate
