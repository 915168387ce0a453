// SPDX-License-Identifier: Apache-2.0
// Array: a view of an image's memory by the buffer protocol and by DLPack.
#include <cstdint>

#include "python.h"

namespace zoneplate::python {
namespace {

// The binary interface of DLPack 0.x, from its specification.
struct DlTensor {
  void* data;
  struct {
    std::int32_t type, id;
  } device;
  std::int32_t ndim;
  struct {
    std::uint8_t code, bits;
    std::uint16_t lanes;
  } dtype;
  std::int64_t *shape, *strides;  ///< in elements
  std::uint64_t byte_offset;
};
struct DlManagedTensor {
  DlTensor tensor;
  void* context;
  void (*deleter)(DlManagedTensor*);
};
constexpr std::int32_t dl_cpu = 1;
constexpr std::uint8_t dl_uint = 1, dl_float = 2;

struct ElementType {
  const char* format;  ///< of the buffer protocol
  Py_ssize_t size;
  std::uint8_t dl_code;
};
constexpr ElementType element_types[] = {{"B", 1, dl_uint}, {"H", 2, dl_uint},  {"I", 4, dl_uint}, {"i", 4, 0},
                                         {"q", 8, 0},       {"f", 4, dl_float}, {"d", 8, dl_float}};

struct ArrayObject {
  PyObject_HEAD;
  PyObject* owner;
  void* data;
  const ElementType* type;
  int ndim;
  Py_ssize_t shape[3], strides[3];
};
PyObject* array_type = nullptr;

ArrayObject& array_of(PyObject* self) { return *reinterpret_cast<ArrayObject*>(self); }

void free_array(PyObject* self) {
  PyTypeObject* const type = Py_TYPE(self);
  Py_XDECREF(array_of(self).owner);
  reinterpret_cast<freefunc>(PyType_GetSlot(type, Py_tp_free))(self);
  Py_DECREF(type);
}

Py_ssize_t count_of(const ArrayObject& array) {
  Py_ssize_t count = 1;
  for (int d = 0; d < array.ndim; ++d) count *= array.shape[d];
  return count;
}

int get_buffer(PyObject* self, Py_buffer* view, int) {
  ArrayObject& array = array_of(self);
  *view = {};
  view->buf = array.data;
  view->obj = Py_NewRef(self);
  view->len = count_of(array) * array.type->size;
  view->itemsize = array.type->size;
  view->ndim = array.ndim;
  view->format = const_cast<char*>(array.type->format);
  view->shape = array.shape;
  view->strides = array.strides;
  return 0;
}

void free_tensor(DlManagedTensor* tensor) {
  const PyGILState_STATE state = PyGILState_Ensure();
  Py_DECREF(static_cast<PyObject*>(tensor->context));
  PyGILState_Release(state);
  delete[] tensor->tensor.shape;
  delete tensor;
}

/// Of a capsule that no consumer has renamed.
void free_capsule(PyObject* capsule) {
  if (PyCapsule_IsValid(capsule, "dltensor") == 0) return;
  auto* const tensor = static_cast<DlManagedTensor*>(PyCapsule_GetPointer(capsule, "dltensor"));
  tensor->deleter(tensor);
}

PyObject* to_dlpack(PyObject* self, PyObject*, PyObject* keywords) {
  if (keywords != nullptr) {  // those of later versions of the protocol, whose consumers accept this one too
    PyObject* const copy = PyDict_GetItemString(keywords, "copy");
    if (copy != nullptr && copy == Py_True) {
      PyErr_SetString(PyExc_BufferError, "__dlpack__ makes no copy");
      return nullptr;
    }
  }
  const ArrayObject& array = array_of(self);
  auto* const sizes = new std::int64_t[6];
  for (int d = 0; d < array.ndim; ++d) {
    sizes[d] = array.shape[d];
    sizes[3 + d] = array.strides[d] / array.type->size;
  }
  auto* const tensor = new DlManagedTensor{{array.data,
                                            {dl_cpu, 0},
                                            array.ndim,
                                            {array.type->dl_code, static_cast<std::uint8_t>(8 * array.type->size), 1},
                                            sizes,
                                            sizes + 3,
                                            0},
                                           Py_NewRef(self),
                                           free_tensor};
  PyObject* const capsule = PyCapsule_New(tensor, "dltensor", free_capsule);
  if (capsule == nullptr) free_tensor(tensor);
  return capsule;
}

PyObject* dlpack_device(PyObject*, PyObject*) { return Py_BuildValue("(ii)", dl_cpu, 0); }

PyObject* get_shape(PyObject* self, void*) {
  const ArrayObject& array = array_of(self);
  PyObject* const shape = PyTuple_New(array.ndim);
  for (int d = 0; shape != nullptr && d < array.ndim; ++d)
    PyTuple_SetItem(shape, d, PyLong_FromSsize_t(array.shape[d]));
  return shape;
}

PyObject* get_format(PyObject* self, void*) { return PyUnicode_FromString(array_of(self).type->format); }
PyObject* get_address(PyObject* self, void*) { return PyLong_FromVoidPtr(array_of(self).data); }

PyMethodDef methods[] = {{"__dlpack__", reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(to_dlpack)),
                          METH_VARARGS | METH_KEYWORDS, "A DLPack capsule that shares the memory."},
                         {"__dlpack_device__", dlpack_device, METH_NOARGS, "(1, 0): the memory of the CPU."},
                         {nullptr, nullptr, 0, nullptr}};
PyGetSetDef properties[] = {{"shape", get_shape, nullptr, "The length of each dimension.", nullptr},
                            {"format", get_format, nullptr, "The elements' format, as in the module struct.", nullptr},
                            {"address", get_address, nullptr, "The address of the first element.", nullptr},
                            {nullptr, nullptr, nullptr, nullptr, nullptr}};
PyType_Slot slots[] = {{Py_tp_dealloc, reinterpret_cast<void*>(free_array)},
                       {Py_tp_methods, methods},
                       {Py_tp_getset, properties},
                       {Py_bf_getbuffer, reinterpret_cast<void*>(get_buffer)},
                       {Py_tp_doc, const_cast<char*>("A view of an image's memory: a buffer, and a DLPack tensor.")},
                       {0, nullptr}};
PyType_Spec spec = {"zoneplate._native.Array", sizeof(ArrayObject), 0,
                    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION, slots};

}  // namespace

PyObject* make_array(const zoneplate_array& from, PyObject* owner) {
  auto* const allocate =
      reinterpret_cast<allocfunc>(PyType_GetSlot(reinterpret_cast<PyTypeObject*>(array_type), Py_tp_alloc));
  PyObject* const self = allocate(reinterpret_cast<PyTypeObject*>(array_type), 0);
  if (self == nullptr) return nullptr;
  ArrayObject& array = array_of(self);
  array.owner = Py_NewRef(owner);
  array.data = from.data;
  array.type = &element_types[from.type];
  array.ndim = from.dimensions;
  for (int d = 0; d < array.ndim; ++d) array.shape[d] = from.shape[d], array.strides[d] = from.strides[d];
  return self;
}

bool add_array_type(PyObject* module) {
  array_type = PyType_FromSpec(&spec);
  return array_type != nullptr && PyModule_AddObjectRef(module, "Array", array_type) == 0;
}

}  // namespace zoneplate::python
