// SPDX-License-Identifier: Apache-2.0
// Stands in for the child processes of readers and shared libraries in fuzz targets: what they do and return is done in
// the target itself, where the sanitizers see it.
#include <cstdlib>

#include "zoneplate/os/library.h"
#include "zoneplate/os/limited_child.h"

namespace zoneplate {

bool is_limited_child() { return true; }

void ChildAnswer::write(const void*, std::size_t) { std::abort(); }

LimitedChild::LimitedChild(std::string, Limits, const std::function<void(ChildAnswer&)>&,
                           const std::function<void()>&) {
  std::abort();
}
LimitedChild::~LimitedChild() = default;
void LimitedChild::read(void*, std::size_t) { std::abort(); }

}  // namespace zoneplate

/// Opens the libraries, as the parent of a child does.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  using enum zoneplate::Library;
  for (const zoneplate::Library library : {Avif, Jxl, Lcms, Meshoptimizer, OpenExr, Tiff, Zstd})
    if (!zoneplate::open_library(library)) std::abort();
  return 0;
}
