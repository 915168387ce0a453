// SPDX-License-Identifier: Apache-2.0
#include "arguments.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

namespace zoneplate::python {
namespace {

/// The type of the elements of a buffer by its format, such as "<f"; -1 for one that is not supported.
int type_of(const Py_buffer& view) {
  const char* format = view.format == nullptr ? "B" : view.format;
  if (*format == '@' || *format == '=' || *format == '<') ++format;
  if (*format == '\0' || format[1] != '\0') return -1;
  switch (*format) {
    case 'B':
      return ZONEPLATE_UINT8;
    case 'H':
      return ZONEPLATE_UINT16;
    case 'f':
      return ZONEPLATE_FLOAT32;
    case 'd':
      return ZONEPLATE_FLOAT64;
    case 'I':
    case 'L':  // 4 or 8 bytes
      return view.itemsize == 4 ? ZONEPLATE_UINT32 : ZONEPLATE_INT64;
    case 'Q':
      return ZONEPLATE_INT64;  // indices beyond its range are refused as negative ones
    case 'i':
    case 'l':
    case 'q':
      return view.itemsize == 4 ? ZONEPLATE_INT32 : ZONEPLATE_INT64;
    default:
      return -1;
  }
}

bool is_in_range(double value, double least, double greatest, const char* name) {
  if (value >= least && value <= greatest) return true;
  PyErr_Format(PyExc_ValueError, "%s: is out of range", name);
  return false;
}

bool read_int(PyObject* value, const char* name, std::int32_t& out) {
  const long found = PyLong_AsLong(value);
  if (found == -1 && PyErr_Occurred() != nullptr) return false;
  if (!is_in_range(static_cast<double>(found), std::numeric_limits<std::int32_t>::min(),
                   std::numeric_limits<std::int32_t>::max(), name))
    return false;
  out = static_cast<std::int32_t>(found);
  return true;
}

bool read_double(PyObject* value, double& out) {
  out = PyFloat_AsDouble(value);
  return out != -1 || PyErr_Occurred() == nullptr;
}

template <class T>
void store(void* member, const T& value) {
  std::memcpy(member, &value, sizeof value);
}

}  // namespace

bool InputArray::open(PyObject* object, const char* name) {
  if (PyObject_GetBuffer(object, &view_, PyBUF_RECORDS_RO) != 0) return false;
  const int type = type_of(view_);
  if (type < 0) {
    PyErr_Format(PyExc_TypeError, "%s: elements of the format '%s' are not supported", name, view_.format);
    return false;
  }
  if (view_.ndim < 1 || view_.ndim > 3) {
    PyErr_Format(PyExc_ValueError, "%s: has %d dimensions, expected 1 to 3", name, view_.ndim);
    return false;
  }
  array_.data = view_.buf;
  array_.type = static_cast<zoneplate_type>(type);
  array_.dimensions = view_.ndim;
  std::copy_n(view_.shape, view_.ndim, array_.shape);
  std::copy_n(view_.strides, view_.ndim, array_.strides);
  static std::byte nothing;  // the address of an array without elements
  if (array_.data == nullptr) array_.data = &nothing;
  return true;
}

bool read_numbers(PyObject* sequence, const char* name, int count, double* out) {
  const Py_ssize_t length = PySequence_Size(sequence);
  if (length < 0) return false;
  if (length != count) {
    PyErr_Format(PyExc_ValueError, "%s: has %zd numbers, expected %d", name, length, count);
    return false;
  }
  for (int i = 0; i < count; ++i) {
    const Reference item(PySequence_GetItem(sequence, i));
    if (!item || !read_double(item.get(), out[i])) return false;
  }
  return true;
}

bool Storage::fill(PyObject* keywords, std::span<const Field> fields, void* options) {
  if (keywords == nullptr) return true;
  PyObject *key = nullptr, *value = nullptr;
  Py_ssize_t at = 0;
  while (PyDict_Next(keywords, &at, &key, &value)) {
    const char* const name = PyUnicode_AsUTF8AndSize(key, nullptr);
    if (name == nullptr) return false;
    const auto field =
        std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return std::strcmp(f.name, name) == 0; });
    if (field == fields.end()) {
      PyErr_Format(PyExc_TypeError, "'%s' is an unknown option", name);
      return false;
    }
    if (value != Py_None && !set(*field, value, static_cast<std::byte*>(options) + field->offset)) return false;
  }
  return true;
}

bool Storage::set(const Field& field, PyObject* value, void* member) {
  double numbers[16] = {};
  switch (field.kind) {
    case Kind::Text: {
      const char* const text = PyUnicode_AsUTF8AndSize(value, nullptr);  // the string keeps it
      store(member, text);
      return text != nullptr;
    }
    case Kind::Int: {
      std::int32_t number = 0;
      if (!read_int(value, field.name, number)) return false;
      store(member, number);
      return true;
    }
    case Kind::Long: {
      const unsigned long long number = PyLong_AsUnsignedLongLong(value);
      if (number == ~0ull && PyErr_Occurred() != nullptr) return false;
      store(member, static_cast<std::uint64_t>(number));
      return true;
    }
    case Kind::Flag: {
      const int is_true = PyObject_IsTrue(value);
      store(member, static_cast<std::int32_t>(is_true));
      return is_true >= 0;
    }
    case Kind::Float:
    case Kind::Double: {
      double number = 0;
      if (!read_double(value, number)) return false;
      if (field.kind == Kind::Float)
        store(member, static_cast<float>(number));
      else
        store(member, number);
      return true;
    }
    case Kind::OptionalInt: {
      std::int32_t& number = ints_.emplace_back();
      store(member, &number);
      return read_int(value, field.name, number);
    }
    case Kind::OptionalFloat: {
      float* const kept = floats_.emplace_back().data();
      if (!read_double(value, numbers[0])) return false;
      kept[0] = static_cast<float>(numbers[0]);
      store(member, kept);
      return true;
    }
    case Kind::Floats: {
      if (!read_numbers(value, field.name, field.count, numbers)) return false;
      float* const kept = floats_.emplace_back().data();
      std::transform(numbers, numbers + field.count, kept, [](double x) { return static_cast<float>(x); });
      store(member, kept);
      return true;
    }
    case Kind::Place: {
      double* const kept = places_.emplace_back().data();
      store(member, kept);
      return read_numbers(value, field.name, 3, kept);
    }
    case Kind::Doubles:
      return read_numbers(value, field.name, field.count, static_cast<double*>(member));
    case Kind::Array: {
      InputArray& array = arrays_.emplace_back();
      if (!array.open(value, field.name)) return false;
      store(member, array.array());
      return true;
    }
  }
  return false;
}

}  // namespace zoneplate::python
