// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/formats/gltf/file.h"
#include "zoneplate/math/mat.h"

namespace zoneplate {

/// Consecutive elements of an accessor.
struct ElementRange {
  std::uint64_t first = 0;
  std::uint64_t count = ~std::uint64_t{0};  ///< as many as there are
};

/// The number of elements of the accessor whose index stands under `key` of `owner`; its buffer view holds them.
std::uint64_t count_elements(GltfFile& file, const JsonView& owner, const char* key);

/// The shape of an accessor: the number of elements, of components per element, and their type (5120 to 5126).
struct ElementShape {
  std::uint64_t count = 0, components = 1;
  int type = 5126;
};
ElementShape read_shape(const GltfFile& file, const JsonView& owner, const char* key);

/// The elements of the accessor whose index stands under `key` of `owner`.
///
/// Normalised integers become [0, 1] or [-1, 1]; other integers keep their value. Sparse elements are in their place.
/// Errors    ErrorKind::Input naming owner and key: no such accessor, another type than expected, an element outside
///           its buffer view, sparse indices that are out of range or do not grow, more memory than the budget.
/// Single numbers.
std::vector<float> read_float(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
std::vector<float2> read_float2(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
std::vector<float3> read_float3(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
std::vector<float4> read_float4(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
/// RGB or RGBA; alpha is 1 where it is missing.
std::vector<float4> read_color(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
/// The difference of two colours: alpha is 0 where it is missing.
std::vector<float4> read_color_change(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
/// Numbers of joints: unsigned integers of 1 or 2 bytes.
std::vector<float4> read_joints(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
std::vector<float4x4> read_float4x4(GltfFile& file, const JsonView& owner, const char* key);
/// Vertex indices: unsigned integers of 1, 2 or 4 bytes.
std::vector<std::uint32_t> read_indices(GltfFile& file, const JsonView& owner, const char* key);

}  // namespace zoneplate
