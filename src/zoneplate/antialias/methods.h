#pragma once

#include <span>

#include "zoneplate/render/method.h"

namespace zoneplate::antialias {

/// The catalogue, in the order of methods.txt.
std::span<const Method> methods();

}  // namespace zoneplate::antialias
