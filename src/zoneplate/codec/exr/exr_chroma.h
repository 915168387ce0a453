// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// The parts of white's luminance that red, green and blue have; nothing where the primaries span no colours.
std::optional<float3> luminance_weights(const ExrChromaticities& chromaticities);

/// A chroma channel at the image's size. Only columns that are multiples of `sampling.x`, and such rows, are given.
struct ChromaPlane {
  float* values = nullptr;
  int2 sampling{1, 1};
};

/// An image of luminance and chroma: Y, RY = (R - Y) / Y and BY = (B - Y) / Y.
struct LuminanceChroma {
  int width = 0, height = 0;
  float* luminance = nullptr;
  ChromaPlane red, blue;
};

/// Replaces RY by red, Y by green and BY by blue.
///
/// Missing chroma is reconstructed along rows, then along columns, with a filter of 14 taps; what is reconstructed with
/// more saturation than the neighbourhood has is desaturated at the same luminance.
/// Requires  samplings of 1 or 2; where 2, an even width or height.
/// Exact     to the halves that OpenEXR rounds its results to.
/// Source    OpenEXR's RgbaInputFile: ImfRgbaYca.cpp, reconstructChromaHoriz, reconstructChromaVert, YCAtoRGBA and
///           fixSaturation; Kainz, Bogart and Hess, The OpenEXR Image File Format, GPU Gems, 2004.
void make_colors(const LuminanceChroma& image, float3 weights);

}  // namespace zoneplate
