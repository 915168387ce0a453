#pragma once

#include <string_view>

namespace zoneplate {

/// A file format, by its extension.
struct SceneFormat {
  std::string_view extension;  ///< lower case, with its dot
  std::string_view summary;
};

}  // namespace zoneplate
