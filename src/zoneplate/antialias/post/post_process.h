// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {

/// The request of a method that filters the display-referred image.
///
/// Units     `radius` is the filter's radius in pixels.
Request display_referred_request(int radius);

/// A method that only filters the display-referred image in 8 bits (filter_encoded).
std::unique_ptr<Resolver> make_post_process(int radius, Mixing mixing, EncodedFilter filter);

}  // namespace zoneplate::antialias
