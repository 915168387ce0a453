// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/image/rgb_space.h"
#include "zoneplate/metrics/file/stored.h"
#include "zoneplate/process/delivery.h"

namespace zoneplate {

/// What the values of a signal mean.
struct SignalMeaning {
  bool are_codes = false;       ///< display codes, not light
  RgbSpacePtr space = nullptr;  ///< of which they are codes, or whose primaries the light has; null: sRGB
};

/// The file that a signal was decoded from; none of a pattern.
struct SignalOrigin {
  metrics::ImageFile file = {};
  RgbSpacePtr space = nullptr;  ///< what it states, also where the signal has been converted
};

/// An image of numbers with its meaning.
struct Signal {
  LinearImage image;  ///< premultiplied
  SignalMeaning meaning = {};
  SignalOrigin origin = {};
};

/// Loads the IMAGE operand of a subcommand of `signal`: a PNG (8 or 16 bits), JPEG, WebP, GIF, TIFF, AVIF, JPEG XL,
/// HDR, EXR, PFM, BMP or TGA file, "-" for stdin, or a procedural pattern (signal/pattern/pattern.h). A file that has
/// the name of a pattern must be given with its folder. Of an animation the first frame is loaded. Pixels that are not
/// finite are filled (filter/still.h).
///
/// Shape     turned as its orientation says.
/// Units     linear light of Rec.709 primaries; with `uses_codes`, the codes in [0, 1] as they are. Premultiplied.
/// Errors    ErrorKind::Input naming the file and the cause, also for more than `max_pixels`; ErrorKind::Usage for a
///           pattern's parameters.
LinearImage load_signal(const std::string& operand, bool uses_codes, std::uint64_t max_pixels = LoadLimits().pixels);

/// Warns that the first of several images is taken, which several_images (codec/inspect) names.
void warn_of_others(const std::string& operand, const std::string& several, Delivery& out);

/// How an image is loaded.
struct SignalChoice {
  bool uses_codes = false;
  ExrChoice exr = {};
};

/// The same within the limits of a confined process. Of a damaged JPEG what can be decoded is loaded, with a warning,
/// where the function above throws; a profile that means nothing and an animation are warnings, too, and so are filled
/// pixels and those of tell_layer (process/exr_layer.h).
LinearImage load_signal(const std::string& operand, const SignalChoice& choice, Delivery& out);

/// The same with the primaries of the file, for results that are written with its profile (save_signal, args.h). Light
/// of which no codes of the file's space can be made in a PNG is in Rec.709.
Signal load_as_stored(const std::string& operand, const SignalChoice& choice, Delivery& out);

/// The same signal as light of Rec.709 primaries; codes stay as they are.
Signal in_rec709(Signal signal);

/// True if the values do not mean what the file of the signal states: light of other primaries, or codes of its light.
bool is_converted(const Signal& signal);

/// The size of the display window, without overscan.
int2 displayed_size(const Signal& signal);

/// Removes overscan.
void crop_to_display(Signal& signal);

/// An image of data, such as heights, in a layer of an EXR or any other image: its codes as they are stored, not
/// turned.
LinearImage load_texture(const std::string& operand, const std::string& layer, Delivery& out);

}  // namespace zoneplate
