// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include "zoneplate/render/method.h"

namespace zoneplate::antialias {

/// A method with two passes: the first renders colours at one sample per pixel, the second renders other data of the
/// same view without shading (Content); the image is computed from both. A pixel depends on its eight neighbours.
class ColorThenData : public Resolver {
 public:
  Request request(const FrameContext&) final {
    color_ = {};
    return with_halo({});
  }
  std::optional<Request> refine(Frame& frame) final {
    if (!color_.empty()) return std::nullopt;
    color_ = std::move(frame.color);
    return with_halo(data_request());
  }
  LinearImage resolve(Frame& frame) final { return color_.empty() ? std::move(frame.color) : combined(color_, frame); }

 private:
  static Request with_halo(Request request) {
    request.halo = 1;
    request.ends_in_light = true;
    return request;
  }

  virtual Request data_request() const = 0;
  /// `data` is the frame that was rendered for data_request().
  virtual LinearImage combined(const LinearImage& color, const Frame& data) const = 0;

  LinearImage color_;
};

}  // namespace zoneplate::antialias
