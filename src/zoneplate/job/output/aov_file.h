// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/render/aov.h"

namespace zoneplate {

/// A data pass as a PNG image.
///
/// depth        16-bit grey: 0 is the nearest and 65534 the farthest visible distance, linear between; 65535 is
///              empty. The distances are in the tEXt chunks "near" and "far".
/// normal       8-bit: 0.5 + 0.5 n of the world-space normal; transparent in empty pixels, as all below.
/// albedo       8-bit sRGB base colour.
/// uv           8-bit: red and green are the fractional parts of u and v; 0 for one that is not finite.
/// *-id         a false colour for each id, the same in every image.
/// crypto-*     the colours of the items that cover the pixel, weighted by coverage; alpha is the covered fraction.
/// position     8-bit: from 0 to 1 between the minimum and the maximum of the visible positions, axis by axis; both
///              are in the tEXt chunks "least" and "greatest".
/// motion, flow 8-bit: the hue is the direction (red to the right, green-yellow down), the saturation the length, full
///              at the maximum of the image, which is in the tEXt chunk "greatest", in pixels. Black where it is
///              not finite.
/// mip-level    white where the base colour's texture is magnified, then a hue for each level: red 0, yellow 1⅓, green
/// 2⅔,
///              cyan 4, blue 5⅓, magenta 6⅔; transparent without a texture.
/// anisotropy   from black (1) to pale yellow (16 and above), by the logarithm; transparent without a texture.
/// coverage     16-bit grey: fraction of the pixel's samples that a surface owns.
/// error        16-bit grey: estimated standard error of the colour, white being the maximum of the image; that and
///              the root mean square, in linear light, are in the tEXt chunks "greatest" and "rms".
std::vector<std::uint8_t> encode_data_png(const Aov& aov, const Frame& frame, const Scene& scene);

/// Converts the channels to those of an OpenEXR file.
void add_exr_channels(const DataChannels& data, std::vector<ExrChannel>& out);

/// The values themselves as a portable float map, of passes with at most three channels; nothing for others.
std::optional<std::vector<std::uint8_t>> encode_data_pfm(const Aov& aov, const Frame& frame, const Scene& scene);

}  // namespace zoneplate
