// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/image/color_profile.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// A 3 × 3 matrix that acts on columns, row by row.
using Matrix3 = std::array<double, 9>;
inline constexpr Matrix3 identity3 = {1, 0, 0, 0, 1, 0, 0, 0, 1};

Matrix3 operator*(const Matrix3& a, const Matrix3& b);
/// Nothing for a singular matrix.
std::optional<Matrix3> inverse(const Matrix3& m);

/// The meaning of the values of an image: the light of each value, and the colour of that light.
struct RgbSpace {
  ColorProfile profile;  ///< what states it, for files that are written
  std::string name;      ///< for messages: "gAMA 1", "the ICC profile Display P3"
  /// Light at equal steps of a value from 0 to 1, linear between them: one curve for red, green and blue, or three.
  /// None: the values are light, and have no limits.
  std::vector<std::vector<float>> curves;
  /// Light of these primaries as light of Rec.709 primaries and D65: has an inverse.
  Matrix3 rec709_from_rgb = identity3;
  /// In place of curves and matrix, as many profiles of printers and scanners have it: sRGB values, beyond [0, 1] too,
  /// at grid_side³ nodes, of which those of blue follow one another.
  std::vector<float> grid;
  bool is_standard = false;  ///< sRGB, or Rec.709 light, within ¾ of a code of 8 bits: the values need no conversion

  static constexpr int grid_side = 33;
};
/// Null: sRGB codes, or light of Rec.709 primaries.
using RgbSpacePtr = std::shared_ptr<const RgbSpace>;

/// The number of values of a curve: codes of 8 and of 16 bits are exact.
inline constexpr int curve_size = 65536;

/// A curve by its function, light_of(value) for values from 0 to 1.
template <class LightOf>
std::vector<float> make_curve(const LightOf& light_of) {
  std::vector<float> curve(curve_size);
  for (int i = 0; i < curve_size; ++i)
    curve[static_cast<std::size_t>(i)] = light_of(static_cast<float>(i) / (curve_size - 1));
  return curve;
}

/// The light of Rec.709 primaries of light whose primaries have these chromaticities, x and y of red, green, blue and
/// white. The white of these is that of Rec.709 (D65) after adaptation.
///
/// Source    Bradford's transform, as ICC.1:2022 annex E has it.
/// Errors    ErrorKind::Input if they span no triangle with white inside its plane.
Matrix3 rec709_from(const std::array<double, 8>& chromaticities);
/// The same of the XYZ of red, green and blue relative to D50, the connection space of ICC profiles.
Matrix3 rec709_from_d50(const std::array<double, 9>& xyz_of_rgb);

/// The space that cICP, or gAMA and cHRM, or chromaticities state; null if nothing is stated. ICC profiles are read by
/// read_icc_space (codec/color/icc.h).
///
/// Exact     PQ and HLG have light 1 at the reference white of ITU-R BT.2408, of 203 cd/m² and a code of 75 %; of HLG it
///           is the light of the scene.
/// Errors    ErrorKind::Input, with the cause alone, for values that mean nothing.
/// Source    PNG specification, third edition; ITU-T H.273 (2024); SMPTE ST 2084; ITU-R BT.2100.
RgbSpacePtr make_rgb_space(const ColorProfile& profile);

/// Sets is_standard.
void recognize_standard(RgbSpace& space);

/// True if equal values of both mean the same colours.
bool is_same(const RgbSpacePtr& a, const RgbSpacePtr& b);

/// True if codes of the space can be made of light, by codes_of.
bool can_encode(const RgbSpace& space);

/// Premultiplied light in the space's own primaries, of Rec.709 for a space with a grid; of straight values, codes as
/// well as light.
LinearImage light_of(const DisplayImage& image, const RgbSpace& space);

/// The straight values of light in the space's own primaries, clamped to [0, 1]; those without alpha are 0.
///
/// Requires  can_encode(space).
DisplayImage codes_of(const LinearImage& light, const RgbSpace& space);

/// Converts light from the space's own primaries to those of Rec.709.
void convert_to_rec709(LinearImage& light, const RgbSpace& space);

/// The inverse of convert_to_rec709.
Linear from_rec709(Linear light, const RgbSpace& space);

}  // namespace zoneplate
