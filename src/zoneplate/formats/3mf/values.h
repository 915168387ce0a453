// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "zoneplate/formats/xml/xml.h"
#include "zoneplate/math/affine.h"

namespace zoneplate {

/// Millimetres of a unit of 3MF and AMF; nothing for another word.
std::optional<double> find_unit(std::string_view name);

/// A number; NaN if the text is none.
float number_of(std::string_view text);
double double_of(std::string_view text);

/// A whole number below 2^32 - 1; 2^32 - 1 if the text is none.
std::uint32_t index_of(std::string_view text);
/// The value of an attribute; 2^32 - 1 if the element does not have it.
std::uint32_t index_of(const XmlElement& element, std::string_view attribute);

/// The words of a list, which are separated by white space.
std::vector<std::string_view> words_of(std::string_view list);

/// The linear colour of #RRGGBB or #RRGGBBAA, which is sRGB; nothing for another text.
std::optional<float4> find_hex_color(std::string_view text);

/// The matrix of twelve numbers, which multiply row vectors, row by row; nothing for another text, or if one of them is
/// not a finite float. `unit` scales the translation.
std::optional<Affine> find_matrix(std::string_view text, double unit);

}  // namespace zoneplate
