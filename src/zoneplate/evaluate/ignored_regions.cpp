// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/ignored_regions.h"

#include "zoneplate/metrics/file/picture_file.h"

namespace zoneplate {
metrics::IgnoredRegions read_ignored(const IgnoredInputs& args, Delivery& out) {
  metrics::IgnoredRegions regions{.rectangles = args.rectangles};
  for (const std::string& path : args.masks)
    out.read(path, [&] { regions.masks.emplace_back(path, metrics::load_picture(path, out.limits().pixels)); });
  return regions;
}

}  // namespace zoneplate
