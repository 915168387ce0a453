// SPDX-License-Identifier: Apache-2.0
// No antialiasing: one sample at the pixel's centre, the baseline of the other methods.
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

class None : public Resolver {
 public:
  Request request(const FrameContext&) override { return {.resolves_per_pixel = true}; }
};

}  // namespace

Method none() {
  return {.name = "none",
          .summary = "one sample at the pixel's centre",
          .source = "point sampling",
          .make = [](const Settings&) -> std::unique_ptr<Resolver> { return std::make_unique<None>(); }};
}

}  // namespace zoneplate::antialias
