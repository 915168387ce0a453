// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

// Conversion of the text of an option to a value. Every error is ErrorKind::Usage and states the found text and the
// expected values; text after the value, infinities and NaN are errors.

double parse_number(const std::string& text, double low, double high);
int parse_whole(const std::string& text, int low, int high);

float radians_of(double degrees);

/// "x,y,z": three numbers that are finite as floats.
double3 parse_triple(const std::string& text);

/// An image's size, "800,600" or "800x600", or "512" for a square, each side in [1, max_side].
int2 parse_size(const std::string& text, int max_side);

/// An sRGB-encoded colour with straight alpha: "#rgb", "#rgba", "#rrggbb", "#rrggbbaa", a basic name of CSS, or "r,g,b"
/// or "r,g,b,a" in [0, 1].
float4 parse_color(const std::string& text);

/// A number of bytes with an optional K, M or G (powers of 1024), at least 1.
std::uint64_t parse_bytes(const std::string& text);

/// Splits "a,b" at commas; of an empty text, one empty item.
std::vector<std::string> split_list(const std::string& text);

/// Splits "psnr,flip:ppd=30,x=1" at commas; a `name=value` without a colon belongs to the previous item.
std::vector<std::string> split_specs(const std::string& text);

/// The index of `text` in `names`.
std::size_t parse_choice(const std::string& text, std::span<const std::string_view> names);
inline std::size_t parse_choice(const std::string& text, std::initializer_list<std::string_view> names) {
  return parse_choice(text, std::span(names.begin(), names.size()));
}

/// Parses the name of an instruction set, which this machine must support.
Isa parse_isa(const std::string& text);

}  // namespace zoneplate
