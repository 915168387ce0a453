// SPDX-License-Identifier: Apache-2.0
#pragma once

// CPython's limited API: one module for version 3.11 and all later ones.
#define PY_SSIZE_T_CLEAN
#define Py_LIMITED_API 0x030B0000
#include <Python.h>

#include <utility>

#include "zoneplate/zoneplate.h"

namespace zoneplate::python {

/// A reference to a Python object, or null.
class Reference {
 public:
  Reference() = default;
  /// Takes over a reference of the caller.
  explicit Reference(PyObject* object) : object_(object) {}
  Reference(Reference&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Reference& operator=(Reference&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~Reference() { Py_XDECREF(object_); }
  /// A further reference to an object.
  static Reference to(PyObject* object) {
    Py_XINCREF(object);
    return Reference(object);
  }

  PyObject* get() const { return object_; }
  explicit operator bool() const { return object_ != nullptr; }
  /// Gives the reference to the caller.
  PyObject* release() { return std::exchange(object_, nullptr); }

 private:
  PyObject* object_ = nullptr;
};

/// Runs a function of zoneplate.h while other Python threads run. On failure, a Python exception is set.
template <class Call>
bool succeeds(const Call& call);

/// Sets the Python exception of a status, with the text of the calling thread.
void set_error(zoneplate_status status);

template <class Call>
bool succeeds(const Call& call) {
  zoneplate_status status;
  Py_BEGIN_ALLOW_THREADS;
  status = call();
  Py_END_ALLOW_THREADS;
  if (status == ZONEPLATE_OK) return true;
  set_error(status);
  return false;
}

/// Makes the Python object of an image, which it takes over; null with an exception set.
PyObject* make_image(zoneplate_image* image);
/// Makes the Python object of an array, a view of memory that `owner` keeps.
PyObject* make_array(const zoneplate_array& array, PyObject* owner);

/// Makes the Python object of a scene, which it takes over; null with an exception set.
PyObject* make_scene(zoneplate_scene* scene);
/// The scene of a Scene object.
zoneplate_scene* scene_of(PyObject* object);

///@{
/// Functions of the module about jobs.
PyObject* load_by_job(PyObject* module, PyObject* arguments);
PyObject* render_by_job(PyObject* module, PyObject* arguments);
PyObject* save_by_job(PyObject* module, PyObject* arguments);
PyObject* frames_by_job(PyObject* module, PyObject* arguments);
PyObject* list_options(PyObject* module, PyObject* arguments);
///@}

///@{
/// Adds the types of a source to the module. False with an exception set.
bool add_array_type(PyObject* module);
bool add_image_type(PyObject* module);
bool add_scene_type(PyObject* module);
bool add_frames_type(PyObject* module);
///@}

/// The image of an Image object.
zoneplate_image* image_of(PyObject* object);

}  // namespace zoneplate::python
