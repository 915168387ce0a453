// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/system/encoder_library.h"

#include "zoneplate/os/library.h"

namespace zoneplate {

void open_encoder_library(const std::string& extension, const std::string& output) {
  if (extension == ".avif") static_cast<void>(SharedLibrary(Library::Avif, output));
  if (extension == ".jxl") static_cast<void>(SharedLibrary(Library::Jxl, output));
}

}  // namespace zoneplate
