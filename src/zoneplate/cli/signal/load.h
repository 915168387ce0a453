// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/cli/process/confined.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/image/rgb_space.h"

namespace zoneplate::cli {

/// What the values of a signal mean.
struct SignalMeaning {
  bool are_codes = false;       ///< display codes, not light
  RgbSpacePtr space = nullptr;  ///< of which they are codes, or whose primaries the light has; null: sRGB
};

/// An image of numbers with its meaning.
struct Signal {
  LinearImage image;  ///< premultiplied
  SignalMeaning meaning = {};
};

/// Loads the IMAGE operand of a subcommand of `signal`: a PNG (8 or 16 bits), JPEG, WebP, HDR, EXR, PFM, BMP or TGA
/// file, "-" for stdin, or a procedural pattern (signal/pattern/pattern.h). A file that has the name of a pattern must
/// be given with its folder.
///
/// Shape     turned as its Exif orientation says.
/// Units     linear light of Rec.709 primaries; with `uses_codes`, the codes in [0, 1] as they are. Premultiplied.
/// Errors    ErrorKind::Input naming the file and the cause, also for more than `most_pixels`; ErrorKind::Usage for a
///           pattern's parameters.
LinearImage load_signal(const std::string& operand, bool uses_codes, std::uint64_t most_pixels = LoadLimits().pixels);

/// The same within the limits of a confined process. Of a damaged JPEG what can be decoded is loaded, with a warning,
/// where the function above throws; a profile that means nothing is a warning, too.
LinearImage load_signal(const std::string& operand, bool uses_codes, Delivery& out);

/// The same with the primaries of the file, for results that are written with its profile. Light of which no codes of
/// the file's space can be made in a PNG is in Rec.709.
Signal load_as_stored(const std::string& operand, bool uses_codes, Delivery& out);

/// The same signal as light of Rec.709 primaries; codes stay as they are.
Signal in_rec709(Signal signal);

/// An image of data, such as heights: its codes as they are stored, not turned.
LinearImage load_texture(const std::string& operand, Delivery& out);

}  // namespace zoneplate::cli
