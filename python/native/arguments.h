// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>

#include "python.h"

namespace zoneplate::python {

/// A buffer of another Python object as an array, until this object is destroyed.
class InputArray {
 public:
  InputArray() = default;
  InputArray(const InputArray&) = delete;
  InputArray& operator=(const InputArray&) = delete;
  ~InputArray() {
    if (view_.obj != nullptr) PyBuffer_Release(&view_);
  }

  /// Opens the buffer of an object. False with a TypeError or ValueError set if it has none that can be read.
  bool open(PyObject* object, const char* name);
  const zoneplate_array& array() const { return array_; }

 private:
  Py_buffer view_{};
  zoneplate_array array_{};
};

/// The type of a member of an options struct.
enum class Kind {
  Text,           ///< const char*
  Int,            ///< int32_t, also of enumerations
  Long,           ///< uint64_t
  Flag,           ///< int32_t, from a truth value
  Float,          ///< float
  Double,         ///< double
  OptionalInt,    ///< const int32_t*
  OptionalFloat,  ///< const float*
  Floats,         ///< const float*, to `count` numbers
  Place,          ///< const double*, to three numbers
  Doubles,        ///< double[count]
  Array,          ///< zoneplate_array
};

/// A member of an options struct, which a keyword argument sets.
struct Field {
  const char* name;
  Kind kind;
  std::size_t offset;
  int count = 1;
};

/// The members of options that are pointers.
class Storage {
 public:
  /// Sets the members of `options` from keyword arguments; None leaves a member as it is. False with an exception set:
  /// TypeError for an unknown name or a wrong type.
  bool fill(PyObject* keywords, std::span<const Field> fields, void* options);

 private:
  bool set(const Field& field, PyObject* value, void* member);

  std::deque<std::array<float, 16>> floats_;
  std::deque<std::array<double, 3>> places_;
  std::deque<std::int32_t> ints_;
  std::deque<InputArray> arrays_;
};

/// Sets a camera by a dictionary of the members of zoneplate_camera. False with an exception set.
bool read_camera(PyObject* members, Storage& storage, zoneplate_camera& camera);

/// Reads `count` numbers of a sequence. False with an exception set.
bool read_numbers(PyObject* sequence, const char* name, int count, double* out);

}  // namespace zoneplate::python
