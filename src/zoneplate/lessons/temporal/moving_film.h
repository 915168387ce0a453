// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/render/method.h"

namespace zoneplate::lessons {

/// The first frames of a built-in scene that moves, by one method, in linear light; 24 frames per second.
std::vector<LinearImage> film_of_scene(const std::string& scene, const std::string& method, int frames, int width,
                                       int height);
/// The same by a resolver.
std::vector<LinearImage> film_of_scene(const std::string& scene, std::unique_ptr<Resolver> method, int frames,
                                       int width, int height);

}  // namespace zoneplate::lessons
