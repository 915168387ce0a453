// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/post_process.h"

#include <utility>

namespace zoneplate::antialias {
namespace {

class PostProcess : public Resolver {
 public:
  PostProcess(int radius, Mixing mixing, EncodedFilter filter)
      : radius_(radius), mixing_(mixing), filter_(std::move(filter)) {}
  Request request(const FrameContext&) override { return display_referred_request(radius_); }
  DisplayImage post_process(DisplayImage image, const Frame&) override {
    return filter_encoded(std::move(image), mixing_, filter_);
  }

 private:
  int radius_;
  Mixing mixing_;
  EncodedFilter filter_;
};

}  // namespace

Request display_referred_request(int radius) {
  Request request;
  request.halo = radius;
  request.is_display_referred = true;
  return request;
}

std::unique_ptr<Resolver> make_post_process(int radius, Mixing mixing, EncodedFilter filter) {
  return std::make_unique<PostProcess>(radius, mixing, std::move(filter));
}

}  // namespace zoneplate::antialias
