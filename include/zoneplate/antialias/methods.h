// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/base/api.h"
#include "zoneplate/render/method.h"

namespace zoneplate {
/// Antialiasing methods, by name.
namespace ZONEPLATE_API antialias {

/// The catalogue, in the order of methods.txt.
std::span<const Method> methods();

}  // namespace antialias
}  // namespace zoneplate
