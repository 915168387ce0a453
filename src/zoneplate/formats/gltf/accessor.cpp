// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

#include "zoneplate/base/large_array.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

/// glTF's constants for component types.
enum ComponentType { Int8 = 5120, Uint8 = 5121, Int16 = 5122, Uint16 = 5123, Uint32 = 5125, Float = 5126 };

int read_component_type(const JsonView& json) {
  const auto type = static_cast<int>(json.whole("componentType", std::nullopt, 1 << 20));
  if (type < Int8 || type > Float || type == 5124)
    json.fail("componentType is " + std::to_string(type) + ", expected 5120 to 5123, 5125 or 5126");
  return type;
}

std::uint64_t read_components(const JsonView& json) {
  static constexpr struct {
    const char* name;
    std::uint64_t components;
  } types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  const std::string type = json.text("type");
  for (const auto& t : types)
    if (type == t.name) return t.components;
  json.fail("type is " + quoted(type) + ", expected SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
}

/// Locates the elements in the buffer view that `json` names, and checks that they fit.
void place_in_view(GltfFile& file, const JsonView& json, const std::string& what, ElementLayout& layout) {
  const std::size_t view = json.index("bufferView", file.count("bufferViews"));
  const std::uint64_t offset = json.whole("byteOffset", 0), size = layout.element_size();
  const std::uint64_t stated = file.view_stride(view);
  layout.stride = stated != 0 ? stated : size;
  if (layout.stride < size)
    json.fail(what + ": byteStride is " + std::to_string(stated) + ", less than an element's " + std::to_string(size));
  const std::span<const std::uint8_t> all = file.view(view);
  const std::uint64_t held = offset < all.size() ? all.size() - offset : 0;
  // count is below 2^53 and the stride below 2^9, so that the product stays within 64 bits.
  const std::uint64_t expected = layout.count == 0 ? 0 : (layout.count - 1) * layout.stride + size;
  if (expected > held)
    json.fail(what + " holds " + std::to_string(held) + " bytes, expected " + std::to_string(expected) + " (" +
              std::to_string(layout.count) + " elements)");
  layout.bytes = all.subspan(static_cast<std::size_t>(std::min<std::uint64_t>(offset, all.size())),
                             static_cast<std::size_t>(expected));
}

/// The maximum number of elements of an accessor without a buffer view, so that a small file cannot exhaust memory.
constexpr std::uint64_t max_zeros = std::uint64_t{1} << 22;

/// An accessor, whose name in messages is of the form "mesh 3 primitive 0 POSITION".
struct Accessor {
  JsonView json;
  ElementLayout layout;
};

Accessor find_accessor(GltfFile& file, const JsonView& owner, const char* key) {
  file.budget().check_time();
  const std::size_t number = owner.index(key, file.count("accessors"));
  const JsonView named = file.root().element("accessors", number, "accessor");
  Accessor a{named.renamed(owner.place() + ": " + key + " (accessor " + std::to_string(number) + ")"), {}};
  a.layout.count = a.json.whole("count");
  a.layout.components = read_components(a.json);
  a.layout.type = read_component_type(a.json);
  a.layout.is_normalized = a.json.flag("normalized", false);
  if (file.has_decoded(number)) {
    a.layout.bytes = file.decoded(number);
    a.layout.stride = a.layout.element_size();
    if (a.layout.bytes.size() < a.layout.count * a.layout.stride) a.json.fail("differs in shape from the decoded data");
  } else if (a.json.has("bufferView")) {
    place_in_view(file, a.json, "it", a.layout);
  } else if (a.layout.count > max_zeros) {
    a.json.fail("has no bufferView for " + std::to_string(a.layout.count) + " elements, at most " +
                std::to_string(max_zeros) + " may be zero");
  }
  return a;
}

/// The elements as an array of T if their memory has this layout; else null.
template <class T>
const T* list_of(const ElementLayout& from) {
  const bool is_list = !from.bytes.empty() && from.stride == sizeof(T) && from.element_size() == sizeof(T) &&
                       reinterpret_cast<std::uintptr_t>(from.bytes.data()) % alignof(T) == 0;
  return is_list ? reinterpret_cast<const T*>(from.bytes.data()) : nullptr;
}

/// One component as a float: its value, or normalized according to KHR_mesh_quantization and the core specification.
template <class T>
float to_float(T value, bool is_normalized) {
  if constexpr (std::is_floating_point_v<T>) return value;
  const float f = static_cast<float>(value);
  if (!is_normalized) return f;
  const float n = f / static_cast<float>(std::numeric_limits<T>::max());
  return n > -1 ? n : -1;
}

template <class T>
void convert_as(const ElementLayout& from, std::uint64_t first, std::size_t count, float* to, std::size_t to_stride) {
  const std::size_t components = std::min<std::size_t>(static_cast<std::size_t>(from.components), to_stride);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* element = from.bytes.data() + (first + i) * from.stride;
    for (std::size_t c = 0; c < components; ++c) {
      T value;
      std::memcpy(&value, element + c * sizeof(T), sizeof(T));
      to[i * to_stride + c] = to_float(value, from.is_normalized);
    }
  }
}

/// Converts elements [first, first + count) to floats; consecutive elements are `to_stride` floats apart.
void convert(const ElementLayout& from, std::uint64_t first, std::size_t count, float* to, std::size_t to_stride) {
  if (from.type == Int8) convert_as<std::int8_t>(from, first, count, to, to_stride);
  if (from.type == Uint8) convert_as<std::uint8_t>(from, first, count, to, to_stride);
  if (from.type == Int16) convert_as<std::int16_t>(from, first, count, to, to_stride);
  if (from.type == Uint16) convert_as<std::uint16_t>(from, first, count, to, to_stride);
  if (from.type == Uint32) convert_as<std::uint32_t>(from, first, count, to, to_stride);
  if (from.type == Float) convert_as<float>(from, first, count, to, to_stride);
}

template <class T>
void widen_as(const ElementLayout& from, std::vector<std::uint32_t>& to) {
  if (const T* const list = list_of<T>(from)) {
    to.assign(list, list + from.count);
    return;
  }
  to.resize(static_cast<std::size_t>(from.count));
  for (std::size_t i = 0; i < from.count; ++i) {
    T value;
    std::memcpy(&value, from.bytes.data() + i * from.stride, sizeof(T));
    to[i] = value;
  }
}

void check_unsigned(const JsonView& json, const ElementLayout& layout) {
  if (layout.type != Uint8 && layout.type != Uint16 && layout.type != Uint32)
    json.fail("componentType is " + std::to_string(layout.type) + ", expected 5121, 5123 or 5125");
}

/// Reads unsigned integers, widened to 32 bits.
std::vector<std::uint32_t> read_unsigned(GltfFile& file, const JsonView& json, const ElementLayout& from) {
  check_unsigned(json, from);
  if (from.bytes.empty()) file.take_zeros(json, from.count);
  file.budget().take(from.count * sizeof(std::uint32_t));
  std::vector<std::uint32_t> out;
  reserve_large(out, static_cast<std::size_t>(from.count));
  if (from.bytes.empty()) {
    out.resize(static_cast<std::size_t>(from.count));
    return out;
  }
  if (from.type == Uint8) widen_as<std::uint8_t>(from, out);
  if (from.type == Uint16) widen_as<std::uint16_t>(from, out);
  if (from.type == Uint32) widen_as<std::uint32_t>(from, out);
  return out;
}

/// The indices and values of an accessor's sparse elements.
struct Sparse {
  std::vector<std::uint32_t> index;
  ElementLayout values;
};

Sparse read_sparse(GltfFile& file, const Accessor& a) {
  const JsonView sparse = a.json.object("sparse");
  const JsonView index_json = sparse.object("indices"), value_json = sparse.object("values");
  const std::uint64_t count = sparse.whole("count");
  if (count > a.layout.count)
    sparse.fail("count is " + std::to_string(count) + " of " + std::to_string(a.layout.count) + " elements");

  ElementLayout places{.count = count, .components = 1, .type = read_component_type(index_json)};
  place_in_view(file, index_json, "the list", places);
  Sparse out{read_unsigned(file, index_json, places), a.layout};
  out.values.count = count;
  place_in_view(file, value_json, "the list", out.values);

  for (std::size_t i = 0; i < out.index.size(); ++i)
    if (out.index[i] >= a.layout.count || (i > 0 && out.index[i] <= out.index[i - 1]))
      index_json.fail("entry " + std::to_string(i) + " is " + std::to_string(out.index[i]) +
                      ", expected growing numbers below " + std::to_string(a.layout.count));
  return out;
}

void refuse_sparse(const Accessor& a) {
  if (a.json.has("sparse")) a.json.fail("has sparse elements, which are not read one by one");
}

/// Calls body(i) for every i below `count`, in ascending steps after which the system may reclaim the file's memory.
template <class Body>
void in_steps(const GltfFile& file, std::size_t count, const Body& body) {
  constexpr std::size_t step = 1 << 16, grain = 1 << 12;
  for (std::size_t first = 0; first < count; first += step) {
    parallel_ranges(std::min(step, count - first), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i) body(i);
    });
    file.forget();
  }
}

/// The elements of these numbers.
template <class V>
std::vector<V> gather_vectors(GltfFile& file, const Accessor& a, std::span<const std::uint32_t> numbers, V filler) {
  constexpr std::size_t floats = sizeof(V) / sizeof(float);
  refuse_sparse(a);
  if (a.layout.bytes.empty()) file.take_zeros(a.json, numbers.size());
  file.budget().take(numbers.size() * sizeof(V));
  std::vector<V> out(numbers.size(), a.layout.components < floats ? filler : V{});
  if (a.layout.bytes.empty()) return out;
  in_steps(file, out.size(),
           [&](std::size_t i) { convert(a.layout, numbers[i], 1, reinterpret_cast<float*>(&out[i]), floats); });
  return out;
}

template <class V>
std::vector<V> read_vectors(GltfFile& file, const Accessor& a, ElementRange range, V filler) {
  if (!range.numbers.empty()) return gather_vectors(file, a, range.numbers, filler);
  constexpr std::size_t floats = sizeof(V) / sizeof(float);
  const std::uint64_t first = std::min(range.first, a.layout.count);
  const std::uint64_t count = std::min(range.count, a.layout.count - first);
  if (a.layout.bytes.empty()) file.take_zeros(a.json, count);
  file.budget().take(count * sizeof(V));
  std::vector<V> out;
  reserve_large(out, static_cast<std::size_t>(count));
  const V* const list = a.layout.type == Float ? list_of<V>(a.layout) : nullptr;
  if (list)
    out.assign(list + first, list + first + count);
  else
    out.resize(static_cast<std::size_t>(count), a.layout.components < floats ? filler : V{});
  float* data = reinterpret_cast<float*>(out.data());
  if (!list && !a.layout.bytes.empty()) convert(a.layout, first, out.size(), data, floats);

  if (a.json.has("sparse")) {
    const Sparse sparse = read_sparse(file, a);
    for (std::size_t i = 0; i < sparse.index.size(); ++i)
      if (sparse.index[i] >= first && sparse.index[i] - first < count)
        convert(sparse.values, i, 1, data + (sparse.index[i] - first) * floats, floats);
    file.budget().give_back(sparse.index.size() * sizeof(std::uint32_t));
  }
  return out;
}

/// An accessor of one of two types whose components are floats or permitted integers.
Accessor find_vectors(GltfFile& file, const JsonView& owner, const char* key, const char* type, const char* or_type) {
  Accessor a = find_accessor(file, owner, key);
  const std::string found = a.json.text("type");
  if (found != type && found != or_type) a.json.fail("type is " + found + ", expected " + type);
  if (a.layout.type == Uint32) a.json.fail("componentType is 5125, expected floats or integers of 8 or 16 bits");
  return a;
}

}  // namespace

std::uint64_t ElementLayout::element_size() const {
  return components * (type == Int8 || type == Uint8 ? 1u : type == Int16 || type == Uint16 ? 2u : 4u);
}

ElementLayout find_float3(GltfFile& file, const JsonView& owner, const char* key) {
  const Accessor a = find_vectors(file, owner, key, "VEC3", "VEC3");
  refuse_sparse(a);
  return a.layout;
}

ElementLayout find_indices(GltfFile& file, const JsonView& owner, const char* key) {
  const Accessor a = find_accessor(file, owner, key);
  check_unsigned(a.json, a.layout);
  refuse_sparse(a);
  return a.layout;
}

float3 float3_at(const ElementLayout& layout, std::uint64_t number) {
  float3 out;
  if (layout.bytes.empty()) return out;
  if (layout.type == Float)
    std::memcpy(&out, layout.bytes.data() + number * layout.stride, sizeof out);
  else
    convert(layout, number, 1, &out.x, 3);
  return out;
}

std::uint32_t index_at(const ElementLayout& layout, std::uint64_t number) {
  if (layout.bytes.empty()) return 0;
  const std::uint8_t* const at = layout.bytes.data() + number * layout.stride;
  std::uint32_t out = 0;  // little-endian: a shorter integer is its first bytes
  std::memcpy(&out, at, static_cast<std::size_t>(layout.element_size()));
  return out;
}

std::uint64_t count_elements(GltfFile& file, const JsonView& owner, const char* key) {
  return find_accessor(file, owner, key).layout.count;
}

ElementShape read_shape(const GltfFile& file, const JsonView& owner, const char* key) {
  const JsonView json = file.root().element("accessors", owner.index(key, file.count("accessors")), "accessor");
  return {json.whole("count"), read_components(json), read_component_type(json)};
}

std::vector<float> read_float(GltfFile& file, const JsonView& owner, const char* key, ElementRange range) {
  return read_vectors<float>(file, find_vectors(file, owner, key, "SCALAR", "SCALAR"), range, {});
}

std::vector<float2> read_float2(GltfFile& file, const JsonView& owner, const char* key, ElementRange range) {
  return read_vectors<float2>(file, find_vectors(file, owner, key, "VEC2", "VEC2"), range, {});
}

std::vector<float3> read_float3(GltfFile& file, const JsonView& owner, const char* key, ElementRange range) {
  return read_vectors<float3>(file, find_vectors(file, owner, key, "VEC3", "VEC3"), range, {});
}

std::vector<float4> read_float4(GltfFile& file, const JsonView& owner, const char* key, ElementRange range) {
  return read_vectors<float4>(file, find_vectors(file, owner, key, "VEC4", "VEC4"), range, {});
}

std::vector<float4> read_color(GltfFile& file, const JsonView& owner, const char* key, ElementRange range) {
  return read_vectors<float4>(file, find_vectors(file, owner, key, "VEC4", "VEC3"), range, {0, 0, 0, 1});
}

std::vector<float4> read_color_change(GltfFile& file, const JsonView& owner, const char* key, ElementRange range) {
  return read_vectors<float4>(file, find_vectors(file, owner, key, "VEC4", "VEC3"), range, {});
}

std::vector<float4> read_joints(GltfFile& file, const JsonView& owner, const char* key, ElementRange range) {
  const Accessor a = find_vectors(file, owner, key, "VEC4", "VEC4");
  if (a.layout.type != Uint8 && a.layout.type != Uint16)
    a.json.fail("componentType is " + std::to_string(a.layout.type) + ", expected 5121 or 5123");
  if (a.layout.is_normalized) a.json.fail("is normalized, expected numbers of joints");
  return read_vectors<float4>(file, a, range, {});
}

std::vector<float4x4> read_float4x4(GltfFile& file, const JsonView& owner, const char* key) {
  const Accessor a = find_vectors(file, owner, key, "MAT4", "MAT4");
  if (a.layout.type != Float) a.json.fail("componentType is not 5126 (float)");
  return read_vectors<float4x4>(file, a, {}, {});
}

std::vector<std::uint32_t> read_indices(GltfFile& file, const JsonView& owner, const char* key, ElementRange range) {
  const Accessor a = find_accessor(file, owner, key);
  if (a.layout.components != 1) a.json.fail("type is " + a.json.text("type") + ", expected SCALAR");
  if (!range.numbers.empty()) {
    check_unsigned(a.json, a.layout);
    refuse_sparse(a);
    file.budget().take(range.numbers.size() * sizeof(std::uint32_t));
    std::vector<std::uint32_t> some(range.numbers.size());
    in_steps(file, some.size(), [&](std::size_t i) { some[i] = index_at(a.layout, range.numbers[i]); });
    return some;
  }
  std::vector<std::uint32_t> out = read_unsigned(file, a.json, a.layout);
  if (a.json.has("sparse")) {
    const Sparse sparse = read_sparse(file, a);
    const std::vector<std::uint32_t> values = read_unsigned(file, a.json, sparse.values);
    for (std::size_t i = 0; i < values.size(); ++i) out[sparse.index[i]] = values[i];
    file.budget().give_back((sparse.index.size() + values.size()) * sizeof(std::uint32_t));
  }
  return out;
}

}  // namespace zoneplate
