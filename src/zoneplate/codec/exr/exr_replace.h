// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// The pixels of a window, whose corners are counted from the image's first pixel.
///
/// Requires  the image contains the window.
LinearImage cropped_to(const LinearImage& image, const ExrWindow& window);

/// How an image is stored in place of a layer.
struct ExrStorage {
  std::optional<ExrType> type = std::nullopt;  ///< of all channels; none: as in the layer
  /// The image has been converted to Rec.709 primaries or to codes, so that the file's chromaticities, which also
  /// apply to everything else in it, do not describe it.
  bool is_converted = false;
};

/// An OpenEXR file in which a layer has been replaced.
struct ExrReplacement {
  std::vector<std::uint8_t> bytes;
  std::vector<std::string> left_out;  ///< what the new file lacks of the old one: layers, parts, overscan
};

/// Encodes an image that was made of a layer of an OpenEXR file, with what else that file has.
///
/// All attributes are kept but those of the packing and the preview. If the image has the size of the decoded area, the
/// other channels of the part are kept with all bits, other parts chunk by chunk as they are packed, and the windows;
/// the data window grows where the image is not 0 outside it. In an image of another size there is only the layer, and
/// both windows are the whole image. A converted image has neither chromaticities nor the rest of the file.
/// Luminance and chroma become R, G and B. A part that is not packed by ZIP or ZIPS, or not packed, becomes one that is
/// packed by ZIP.
///
/// Units     as the channels of the layer: halves where they were halves and all values are in the range of these;
///           floats for numbers; of channels that it lacked, as its others. With a type, all are of that type.
/// Errors    those of decode_exr_as_stored; ErrorKind::Input if another part is incomplete.
ExrReplacement replace_exr_layer(std::span<const std::uint8_t> file, const std::string& name, const ExrChoice& choice,
                                 const LinearImage& image, const ExrStorage& storage = {});

}  // namespace zoneplate
