// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/formats/gltf/file.h"
#include "zoneplate/math/mat.h"

namespace zoneplate {

/// A range of an accessor's elements, or some of them in any order.
struct ElementRange {
  std::uint64_t first = 0;
  std::uint64_t count = ~std::uint64_t{0};      ///< default: all following elements
  std::span<const std::uint32_t> numbers = {};  ///< not empty: these instead, all of which exist
};

/// Where the elements of an accessor lie, all of which are within `bytes`.
struct ElementLayout {
  std::uint64_t count = 0;
  std::uint64_t components = 1;  ///< components per element
  int type = 5126;               ///< of a component, 5120 to 5126
  bool is_normalized = false;
  std::span<const std::uint8_t> bytes{};  ///< empty: all elements are zero
  std::uint64_t stride = 0;

  std::uint64_t element_size() const;
};
/// The layouts of what read_float3 and read_indices read, whose elements several threads may read by `float3_at` and
/// `index_at`.
///
/// Errors    those of read_float3 and read_indices; ErrorKind::Input for sparse elements.
ElementLayout find_float3(GltfFile& file, const JsonView& owner, const char* key);
ElementLayout find_indices(GltfFile& file, const JsonView& owner, const char* key);
float3 float3_at(const ElementLayout& layout, std::uint64_t number);
std::uint32_t index_at(const ElementLayout& layout, std::uint64_t number);

/// The number of elements of the accessor whose index is the value of `key` in `owner`; its buffer view contains them.
std::uint64_t count_elements(GltfFile& file, const JsonView& owner, const char* key);

/// The shape of an accessor: the number of elements, of components per element, and their type (5120 to 5126).
struct ElementShape {
  std::uint64_t count = 0, components = 1;
  int type = 5126;
};
ElementShape read_shape(const GltfFile& file, const JsonView& owner, const char* key);

/// Reads the elements of the accessor whose index is the value of `key` in `owner`; `read_float` reads scalars.
///
/// Normalized integers become [0, 1] or [-1, 1]; other integers keep their value. Sparse elements replace those of the
/// buffer view.
/// Errors    ErrorKind::Input naming owner and key: no such accessor, an unexpected type, an element outside its buffer
///           view, sparse indices that are out of range or not increasing, sparse elements if some are read by their
///           numbers, more memory than the budget.
std::vector<float> read_float(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
std::vector<float2> read_float2(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
std::vector<float3> read_float3(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
std::vector<float4> read_float4(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
/// RGB or RGBA; a missing alpha is 1.
std::vector<float4> read_color(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
/// The difference of two colours; a missing alpha is 0.
std::vector<float4> read_color_change(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
/// Indices of joints: unsigned integers of 1 or 2 bytes.
std::vector<float4> read_joints(GltfFile& file, const JsonView& owner, const char* key, ElementRange range = {});
std::vector<float4x4> read_float4x4(GltfFile& file, const JsonView& owner, const char* key);
/// Vertex indices: unsigned integers of 1, 2 or 4 bytes.
std::vector<std::uint32_t> read_indices(GltfFile& file, const JsonView& owner, const char* key,
                                        ElementRange range = {});

}  // namespace zoneplate
