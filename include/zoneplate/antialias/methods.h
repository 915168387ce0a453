// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/render/method.h"

#pragma GCC visibility push(default)
namespace zoneplate {
/// Antialiasing methods, by name.
namespace antialias {

/// The catalogue, in the order of methods.txt.
std::span<const Method> methods();

}  // namespace antialias
}  // namespace zoneplate
#pragma GCC visibility pop
