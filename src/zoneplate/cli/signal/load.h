// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/image/rgb.h"

namespace zoneplate::cli {

/// The numbers that a subcommand of `signal` works on, of its IMAGE operand: a PNG (8 or 16 bits), JPEG, WebP,
/// HDR, EXR or PFM file, "-" for stdin, or a pattern made in code (signal/pattern/pattern.h). A file whose name is a
/// pattern's is given with its folder.
///
/// Units     linear light; with `uses_codes` the sRGB codes in [0, 1] in its place. Premultiplied either way.
/// Errors    ErrorKind::Input naming the file and what is wrong with it; ErrorKind::Usage for a pattern's parameters.
LinearImage load_signal(const std::string& operand, bool uses_codes);

}  // namespace zoneplate::cli
