// SPDX-License-Identifier: Apache-2.0
// Image: arrays by name.
#include "arguments.h"
#include "python.h"

namespace zoneplate::python {
namespace {

struct ImageObject {
  PyObject_HEAD;
  zoneplate_image* image;
};
PyObject* image_type = nullptr;

void free_image(PyObject* self) {
  PyTypeObject* const type = Py_TYPE(self);
  zoneplate_image_free(image_of(self));
  reinterpret_cast<freefunc>(PyType_GetSlot(type, Py_tp_free))(self);
  Py_DECREF(type);
}

PyObject* get_names(PyObject* self, void*) {
  const zoneplate_image* const image = image_of(self);
  const auto count = static_cast<Py_ssize_t>(zoneplate_image_count(image));
  PyObject* const names = PyTuple_New(count);
  for (Py_ssize_t i = 0; names != nullptr && i < count; ++i)
    PyTuple_SetItem(names, i, PyUnicode_FromString(zoneplate_image_name(image, static_cast<std::size_t>(i))));
  return names;
}

PyObject* get_array(PyObject* self, PyObject* name) {
  const char* const text = PyUnicode_AsUTF8AndSize(name, nullptr);
  zoneplate_array array{};
  if (text == nullptr) return nullptr;
  if (zoneplate_image_array(image_of(self), text, &array) != ZONEPLATE_OK) {
    PyErr_SetString(PyExc_KeyError, zoneplate_error_text());
    return nullptr;
  }
  return make_array(array, self);
}

PyObject* encode(PyObject* self, PyObject* format) {
  const char* const text = PyUnicode_AsUTF8AndSize(format, nullptr);
  zoneplate_image* file = nullptr;
  if (text == nullptr || !succeeds([&] { return zoneplate_image_encode(image_of(self), text, &file); })) return nullptr;
  zoneplate_array bytes{};
  zoneplate_image_array(file, "bytes", &bytes);
  PyObject* const out = PyBytes_FromStringAndSize(static_cast<const char*>(bytes.data), bytes.shape[0]);
  zoneplate_image_free(file);
  return out;
}

PyObject* save(PyObject* self, PyObject* path) {
  const char* const text = PyUnicode_AsUTF8AndSize(path, nullptr);
  if (text == nullptr || !succeeds([&] { return zoneplate_image_save(image_of(self), text); })) return nullptr;
  return Py_NewRef(Py_None);
}

PyMethodDef methods[] = {{"array", get_array, METH_O, "array(name): the Array of that name."},
                         {"encode", encode, METH_O, "encode(format): \"color\" as the bytes of a file."},
                         {"save", save, METH_O, "save(path): writes \"color\" by the path's extension."},
                         {nullptr, nullptr, 0, nullptr}};
PyGetSetDef properties[] = {{"names", get_names, nullptr, "The names of the arrays.", nullptr},
                            {nullptr, nullptr, nullptr, nullptr, nullptr}};
PyType_Slot slots[] = {{Py_tp_dealloc, reinterpret_cast<void*>(free_image)},
                       {Py_tp_methods, methods},
                       {Py_tp_getset, properties},
                       {Py_tp_doc, const_cast<char*>("Arrays by name.")},
                       {0, nullptr}};
PyType_Spec spec = {"zoneplate._native.Image", sizeof(ImageObject), 0,
                    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION, slots};

}  // namespace

zoneplate_image* image_of(PyObject* object) { return reinterpret_cast<ImageObject*>(object)->image; }

PyObject* make_image(zoneplate_image* image) {
  auto* const type = reinterpret_cast<PyTypeObject*>(image_type);
  PyObject* const self = reinterpret_cast<allocfunc>(PyType_GetSlot(type, Py_tp_alloc))(type, 0);
  if (self == nullptr)
    zoneplate_image_free(image);
  else
    reinterpret_cast<ImageObject*>(self)->image = image;
  return self;
}

bool add_image_type(PyObject* module) {
  image_type = PyType_FromSpec(&spec);
  return image_type != nullptr && PyModule_AddObjectRef(module, "Image", image_type) == 0;
}

}  // namespace zoneplate::python
