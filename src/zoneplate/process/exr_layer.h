// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/codec/exr/exr_replace.h"
#include "zoneplate/metrics/file/stored.h"
#include "zoneplate/process/delivery.h"

namespace zoneplate {

/// The pixels of an EXR of which an image is made: those with overscan if it has their size and is an EXR, which can
/// keep it.
ExrArea area_for(const std::string& output, bool keeps_size);

/// Warns, after an image has been decoded, if it is none of the colours that every viewer shows of an EXR, and no layer
/// was chosen. (Work begins anew where the decoder's library has to be opened.)
///
/// Errors    ErrorKind::Usage if a layer is chosen that the file does not have, or of a file that is no EXR.
void tell_layer(const metrics::ImageFile& file, Delivery& out);

/// Saves an image that was made of a file to .exr or .pfm: to .exr with what else that file has, if it is an EXR
/// (codec/exr/exr_replace.h). Other files become floats.
///
/// Returns   what is left out.
/// Errors    that of check_alpha (codec/save.h).
std::vector<std::string> save_light(const std::string& path, const LinearImage& image,
                                    const metrics::ImageFile& original, const ExrStorage& storage, Delivery& out);

/// Warns of what an image lacks of its original, if anything.
void warn_of_left_out(const std::string& path, const std::string& original, const std::vector<std::string>& left_out,
                      Delivery& out);

}  // namespace zoneplate
