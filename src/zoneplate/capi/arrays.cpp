// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/capi/arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>

#include "zoneplate/base/error.h"

namespace zoneplate::capi {
namespace {

[[noreturn]] void refuse(const char* name, const std::string& cause) {
  throw Error(ErrorKind::Usage, fmt::format("{}: {}", name, cause));
}

std::string shape_text(const zoneplate_array& array) {
  std::string text;
  for (int d = 0; d < array.dimensions; ++d)
    text += fmt::format("{}{}", d == 0 ? "" : " x ", array.shape[static_cast<std::size_t>(d)]);
  return text;
}

/// The array with three dimensions: the missing ones have one element.
///
/// Errors    ErrorKind::Usage for an array that has no elements or cannot be addressed.
zoneplate_array spread(zoneplate_array array, const char* name) {
  if (array.data == nullptr) refuse(name, "is missing");
  if (array.dimensions < 1 || array.dimensions > 3) refuse(name, fmt::format("has {} dimensions", array.dimensions));
  for (std::size_t d = static_cast<std::size_t>(array.dimensions); d < 3; ++d) array.shape[d] = 1, array.strides[d] = 0;
  for (const std::int64_t length : array.shape)
    if (length < 0 || length > std::numeric_limits<std::int32_t>::max())
      refuse(name, "has the shape " + shape_text(array));
  return array;
}

/// Calls body(T) with a value of the elements' type.
template <class Body>
decltype(auto) visit_type(const zoneplate_array& array, const char* name, const Body& body) {
  switch (array.type) {
    case ZONEPLATE_UINT8:
      return body(std::uint8_t{});
    case ZONEPLATE_UINT16:
      return body(std::uint16_t{});
    case ZONEPLATE_UINT32:
      return body(std::uint32_t{});
    case ZONEPLATE_INT32:
      return body(std::int32_t{});
    case ZONEPLATE_INT64:
      return body(std::int64_t{});
    case ZONEPLATE_FLOAT32:
      return body(float{});
    case ZONEPLATE_FLOAT64:
      return body(double{});
  }
  refuse(name, fmt::format("has elements of an unknown type {}", static_cast<int>(array.type)));
}

/// The element at an index; `T` is its type. Elements may lie at any address.
template <class T>
T element(const zoneplate_array& a, std::int64_t i, std::int64_t j, std::int64_t k) {
  T value;
  std::memcpy(&value, static_cast<const std::byte*>(a.data) + i * a.strides[0] + j * a.strides[1] + k * a.strides[2],
              sizeof value);
  return value;
}

/// Calls use(element) for all elements, row by row.
template <class T, class Use>
void for_elements(const zoneplate_array& a, const Use& use) {
  for (std::int64_t i = 0; i < a.shape[0]; ++i)
    for (std::int64_t j = 0; j < a.shape[1]; ++j)
      for (std::int64_t k = 0; k < a.shape[2]; ++k) use(element<T>(a, i, j, k));
}

/// An image's size and channels; the strides are by row, column and channel.
zoneplate_array image_of(const zoneplate_array& array, const char* name) {
  const zoneplate_array a = spread(array, name);
  if (array.dimensions < 2 || a.shape[0] < 1 || a.shape[1] < 1)
    refuse(name, fmt::format("has the shape {}, expected height x width x channels", shape_text(array)));
  return a;
}

/// The image with 1, 3 or 4 channels in elements of T, as pixels {r, g, b, a} of `Pixel`.
template <class T, class Pixel>
Plane<Pixel> pixels_of(const zoneplate_array& a, const char* name, T opaque) {
  const std::int64_t channels = a.shape[2];
  if (channels != 1 && channels != 3 && channels != 4)
    refuse(name, fmt::format("has {} channels, expected 1, 3 or 4", channels));
  Plane<Pixel> out(static_cast<int>(a.shape[1]), static_cast<int>(a.shape[0]));
  const std::int64_t green = channels > 1 ? 1 : 0, blue = channels > 1 ? 2 : 0;
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      out(x, y) = {element<T>(a, y, x, 0), element<T>(a, y, x, green), element<T>(a, y, x, blue),
                   channels == 4 ? element<T>(a, y, x, 3) : opaque};
  return out;
}

/// Codes divided by their maximum.
template <class Pixel>
DisplayImage display_of(const Plane<Pixel>& codes, float greatest) {
  DisplayImage image(codes.width(), codes.height());
  std::ranges::transform(codes.values(), image.values().begin(), [&](Pixel c) {
    const auto unit = [&](auto code) { return static_cast<float>(code) / greatest; };
    return Display{unit(c.r), unit(c.g), unit(c.b), unit(c.a)};
  });
  return image;
}

[[noreturn]] void refuse_type(const char* name) {
  refuse(name, "has elements of another type than uint8, uint16 or float32");
}

/// The elements of an array of n × columns, row by row.
template <class T>
std::vector<T> numbers_of(const zoneplate_array& array, const char* name, std::int64_t columns) {
  const zoneplate_array a = spread(array, name);
  if (array.dimensions != 2 || (columns > 0 && a.shape[1] != columns))
    refuse(name, fmt::format("has the shape {}, expected n x {}", shape_text(array), columns));
  std::vector<T> out;
  out.reserve(static_cast<std::size_t>(a.shape[0] * a.shape[1]));
  visit_type(a, name, [&](auto zero) {
    for_elements<decltype(zero)>(a, [&](auto value) { out.push_back(static_cast<T>(value)); });
  });
  return out;
}

}  // namespace

zoneplate_array array_of(const void* memory, zoneplate_type type, std::initializer_list<std::int64_t> shape) {
  constexpr std::int64_t sizes[] = {1, 2, 4, 4, 8, 4, 8};  // by zoneplate_type
  zoneplate_array out{};
  out.data = const_cast<void*>(memory);
  out.type = type;
  out.dimensions = static_cast<std::int32_t>(shape.size());
  std::copy(shape.begin(), shape.end(), out.shape);
  std::int64_t stride = sizes[type];
  for (std::size_t d = shape.size(); d-- > 0;) out.strides[d] = stride, stride *= out.shape[d];
  return out;
}

std::vector<float> floats_of(const zoneplate_array& array, const char* name, std::int64_t columns) {
  return numbers_of<float>(array, name, columns);
}
std::vector<double> doubles_of(const zoneplate_array& array, const char* name, std::int64_t columns) {
  return numbers_of<double>(array, name, columns);
}

std::vector<std::uint32_t> indices_of(const zoneplate_array& array, const char* name, std::size_t count) {
  const zoneplate_array a = spread(array, name);
  std::vector<std::uint32_t> out;
  out.reserve(static_cast<std::size_t>(a.shape[0]) * static_cast<std::size_t>(a.shape[1]) *
              static_cast<std::size_t>(a.shape[2]));
  visit_type(a, name, [&](auto zero) {
    using T = decltype(zero);
    if constexpr (std::is_floating_point_v<T>) {
      refuse(name, "has elements of a floating-point type, expected integers");
    } else {
      for_elements<T>(a, [&](T value) {
        if (static_cast<std::int64_t>(value) < 0 || static_cast<std::uint64_t>(value) >= count)
          refuse(name, fmt::format("has the index {}, expected 0 to {}", value, static_cast<std::int64_t>(count) - 1));
        out.push_back(static_cast<std::uint32_t>(value));
      });
    }
  });
  return out;
}

TexelImage texels_of(const zoneplate_array& array, const char* name) {
  const zoneplate_array a = image_of(array, name);
  if (a.type == ZONEPLATE_UINT8) return pixels_of<std::uint8_t, Rgba8>(a, name, 255);
  if (a.type == ZONEPLATE_UINT16) return pixels_of<std::uint16_t, Rgba16>(a, name, 65535);
  if (a.type == ZONEPLATE_FLOAT32) return pixels_of<float, float4>(a, name, 1);
  refuse_type(name);
}

metrics::Picture picture_of(const zoneplate_array& array, const char* name) {
  const zoneplate_array a = image_of(array, name);
  if (a.type == ZONEPLATE_UINT8)
    return metrics::make_picture(display_of(pixels_of<std::uint8_t, Rgba8>(a, name, 255), 255));
  if (a.type == ZONEPLATE_UINT16)
    return metrics::make_picture(display_of(pixels_of<std::uint16_t, Rgba16>(a, name, 65535), 65535));
  if (a.type == ZONEPLATE_FLOAT32) return metrics::make_picture(pixels_of<float, Linear>(a, name, 1));
  refuse_type(name);
}

std::vector<Plane<float>> channels_of(const zoneplate_array& array, const char* name) {
  const zoneplate_array a = image_of(array, name);
  if (a.type != ZONEPLATE_FLOAT32) refuse(name, "has elements of another type than float32");
  std::vector<Plane<float>> out;
  for (std::int64_t k = 0; k < a.shape[2]; ++k) {
    Plane<float>& plane = out.emplace_back(static_cast<int>(a.shape[1]), static_cast<int>(a.shape[0]));
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x) plane(x, y) = element<float>(a, y, x, k);
  }
  return out;
}

}  // namespace zoneplate::capi
