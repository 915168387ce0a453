// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "zoneplate/image/plane.h"
#include "zoneplate/metrics/picture.h"
#include "zoneplate/scene/texel_image.h"
#include "zoneplate/zoneplate.h"

namespace zoneplate::capi {

/// A row-major array of values whose last dimension is contiguous, without padding. `memory` is not owned.
zoneplate_array array_of(const void* memory, zoneplate_type type, std::initializer_list<std::int64_t> shape);

/// Whether an optional array is given.
inline bool is_given(const zoneplate_array& array) { return array.data != nullptr; }

/// The elements of an array of n × columns, row by row.
///
/// Errors    ErrorKind::Usage naming the array, for other shapes; columns = 0 allows any.
std::vector<float> floats_of(const zoneplate_array& array, const char* name, std::int64_t columns);
std::vector<double> doubles_of(const zoneplate_array& array, const char* name, std::int64_t columns);
/// The elements of an array of any shape, row by row, as indices below `count`.
///
/// Errors    ErrorKind::Usage naming the array, for floating-point elements or an index out of range.
std::vector<std::uint32_t> indices_of(const zoneplate_array& array, const char* name, std::size_t count);

///@{
/// Images of height × width or height × width × channels (1, 3 or 4). Grey is repeated; a missing alpha is 1.
///
/// Errors    ErrorKind::Usage naming the array, for another shape or type.
TexelImage texels_of(const zoneplate_array& array, const char* name);
metrics::Picture picture_of(const zoneplate_array& array, const char* name);
///@}
/// One channel of an image of floats.
///
/// Errors    ErrorKind::Usage naming the array, for integers or another shape.
std::vector<Plane<float>> channels_of(const zoneplate_array& array, const char* name);

}  // namespace zoneplate::capi
