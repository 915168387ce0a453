// SPDX-License-Identifier: Apache-2.0
// Stands in for the child process of shared libraries in fuzz targets, so that what they return is seen by the
// sanitizers.
#include "zoneplate/codec/system/in_child.h"

namespace zoneplate {

StoredImage decode_in_child(const std::string&, Library, std::uint64_t, std::uint64_t,
                            const std::function<StoredImage()>& decode) {
  return decode();
}

}  // namespace zoneplate
