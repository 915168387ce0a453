#pragma once

#include <memory>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {

/// What every method that filters the display-referred picture requests of a frame.
///
/// Units     `reach`: pixels that the filter looks at beyond each pixel.
Request display_referred_request(int reach);

/// A method that does nothing but filter the display-referred picture in 8 bits (filter_encoded).
std::unique_ptr<Resolver> make_post_process(int reach, Mixing mixing, EncodedFilter filter);

}  // namespace zoneplate::antialias
