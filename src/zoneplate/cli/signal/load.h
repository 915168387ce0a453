// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/cli/process/confined.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate::cli {

/// Loads the IMAGE operand of a subcommand of `signal`: a PNG (8 or 16 bits), JPEG, WebP, HDR, EXR, PFM, BMP or TGA
/// file, "-" for stdin, or a procedural pattern (signal/pattern/pattern.h). A file that has the name of a pattern must
/// be given with its folder.
///
/// Units     linear light; with `uses_codes`, sRGB codes in [0, 1] instead. Premultiplied in both cases.
/// Errors    ErrorKind::Input naming the file and the cause, also for more than `most_pixels`; ErrorKind::Usage for a
///           pattern's parameters.
LinearImage load_signal(const std::string& operand, bool uses_codes, std::uint64_t most_pixels = LoadLimits().pixels);

/// The same within the limits of a confined process. Of a damaged JPEG what can be decoded is loaded, with a warning,
/// where the function above throws.
LinearImage load_signal(const std::string& operand, bool uses_codes, Delivery& out);

}  // namespace zoneplate::cli
