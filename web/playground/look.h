// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "zoneplate/base/spec.h"
#include "zoneplate/render/render.h"

namespace zoneplate {

/// The options of rendering besides the method, with the names and values of the command's options.
std::span<const Param> look_params();

/// Sets the options by a text such as `look:visibility=painter,shadows=hard`.
///
/// Errors    ErrorKind::Usage naming an unknown option or value.
void set_look(std::string_view text, RenderOptions& options);

}  // namespace zoneplate
