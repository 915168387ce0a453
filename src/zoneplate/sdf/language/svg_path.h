// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "zoneplate/sdf/outline.h"

namespace zoneplate::sdf {

/// The outline of an SVG path's data: commands M, L, H, V, C, S, Q, T, A and Z, absolute or relative. Subpaths are
/// closed, as for filling.
///
/// Exact     lines and Bézier curves; an arc becomes cubics within 1e-7 of its radius.
/// Errors    ErrorKind::Input with the character: "character 7: expected a number, found 'x'"; in error, nothing is
///           drawn, unlike in browsers, which draw the part before the error.
/// Source    W3C, Scalable Vector Graphics (SVG) 2, 9.3 and B.2.
Outline parse_svg_path(std::string_view data);

}  // namespace zoneplate::sdf
