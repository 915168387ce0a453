#pragma once

#include <string_view>

namespace zoneplate {

/// A kind of file that holds a scene.
struct SceneFormat {
  std::string_view extension;  ///< lower case, with its dot
  std::string_view summary;
};

}  // namespace zoneplate
