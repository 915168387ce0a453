// SPDX-License-Identifier: Apache-2.0
// zoneplate._native: zoneplate.h for Python. The package around it is in python/zoneplate.
#include "arguments.h"
#include "python.h"

namespace zoneplate::python {
namespace {

PyObject* errors[4] = {};  ///< by zoneplate_status - 1

PyObject* measure(PyObject*, PyObject* arguments) {
  PyObject *reference = nullptr, *test = nullptr;
  const char* metric = nullptr;
  InputArray reference_array, test_array;
  double value = 0;
  zoneplate_image *map = nullptr, *figures = nullptr;
  if (PyArg_ParseTuple(arguments, "OOs", &reference, &test, &metric) == 0 ||
      !reference_array.open(reference, "reference") || !test_array.open(test, "test") || !succeeds([&] {
        return zoneplate_measure(&reference_array.array(), &test_array.array(), metric, &value, &map, &figures);
      }))
    return nullptr;
  const Reference map_object(make_image(map)), figures_object(make_image(figures));
  if (!map_object || !figures_object) return nullptr;
  return Py_BuildValue("(dOO)", value, map_object.get(), figures_object.get());
}

/// A function of one array and further arguments, which makes an image.
template <class Call>
PyObject* image_from(PyObject* pixels, const Call& call) {
  InputArray array;
  zoneplate_image* image = nullptr;
  if (!array.open(pixels, "pixels") || !succeeds([&] { return call(&array.array(), &image); })) return nullptr;
  return make_image(image);
}

PyObject* filter(PyObject*, PyObject* arguments) {
  PyObject* pixels = nullptr;
  const char* method = nullptr;
  if (PyArg_ParseTuple(arguments, "Os", &pixels, &method) == 0) return nullptr;
  return image_from(pixels, [&](auto* array, auto** image) { return zoneplate_filter(array, method, image); });
}

PyObject* resample(PyObject*, PyObject* arguments) {
  PyObject* pixels = nullptr;
  int width = 0, height = 0;
  const char* kernel = nullptr;
  if (PyArg_ParseTuple(arguments, "Oiis", &pixels, &width, &height, &kernel) == 0) return nullptr;
  return image_from(pixels,
                    [&](auto* array, auto** image) { return zoneplate_resample(array, width, height, kernel, image); });
}

PyObject* frequency_filter(PyObject*, PyObject* arguments) {
  PyObject* pixels = nullptr;
  const char *pass = nullptr, *shape = nullptr;
  double low = 0, high = 0;
  if (PyArg_ParseTuple(arguments, "Osdds", &pixels, &pass, &low, &high, &shape) == 0) return nullptr;
  return image_from(pixels, [&](auto* array, auto** image) {
    return zoneplate_frequency_filter(array, pass, low, high, shape, image);
  });
}

PyObject* spectrum(PyObject*, PyObject* pixels) { return image_from(pixels, zoneplate_spectrum); }
PyObject* image_new(PyObject*, PyObject* pixels) { return image_from(pixels, zoneplate_image_new); }

PyObject* image_load(PyObject*, PyObject* path) {
  const char* const text = PyUnicode_AsUTF8AndSize(path, nullptr);
  zoneplate_image* image = nullptr;
  if (text == nullptr || !succeeds([&] { return zoneplate_image_load(text, &image); })) return nullptr;
  return make_image(image);
}

PyObject* catalogue(PyObject*, PyObject* number) {
  const auto chosen = static_cast<zoneplate_catalogue>(PyLong_AsLong(number));
  if (PyErr_Occurred() != nullptr) return nullptr;
  Reference entries(PyDict_New());
  const char *name = nullptr, *summary = nullptr;
  for (std::size_t i = 0; entries && zoneplate_list(chosen, i, &name, &summary) == ZONEPLATE_OK; ++i) {
    const Reference text(PyUnicode_FromString(summary));
    if (!text || PyDict_SetItemString(entries.get(), name, text.get()) != 0) return nullptr;
  }
  return entries.release();
}

PyMethodDef functions[] = {
    {"measure", measure, METH_VARARGS,
     "measure(reference, test, metric): (value, Image of the map, Image of figures)."},
    {"filter", filter, METH_VARARGS, "filter(pixels, method): an Image."},
    {"resample", resample, METH_VARARGS, "resample(pixels, width, height, kernel): an Image."},
    {"frequency_filter", frequency_filter, METH_VARARGS, "frequency_filter(pixels, pass, low, high, shape): an Image."},
    {"spectrum", spectrum, METH_O, "spectrum(plane): an Image."},
    {"load_by_job", load_by_job, METH_VARARGS, "load_by_job(path, options): a Scene."},
    {"render_by_job", render_by_job, METH_VARARGS, "render_by_job(scene, camera, form, options): an Image."},
    {"save_by_job", save_by_job, METH_VARARGS, "save_by_job(scene, path, options): writes files."},
    {"frames_by_job", frames_by_job, METH_VARARGS, "frames_by_job(scene, form, options): an iterator of Images."},
    {"options", list_options, METH_NOARGS, "options(): members of zoneplate_option."},
    {"image_new", image_new, METH_O, "image_new(pixels): an Image with a copy of the pixels."},
    {"image_load", image_load, METH_O, "image_load(path): an Image of a file."},
    {"catalogue", catalogue, METH_O, "catalogue(number): the summaries by name (zoneplate_catalogue)."},
    {nullptr, nullptr, 0, nullptr}};

bool add_errors(PyObject* module) {
  constexpr struct {
    const char *name, *doc;
  } types[] = {{"Error", "A failure of rendering, and the base of the other errors."},
               {"UsageError", "A wrong argument, or a wrong combination of arguments."},
               {"InputError", "An input that is missing, corrupt or unsupported."},
               {"OutputError", "An output that cannot be written."}};
  for (int i = 0; i < 4; ++i) {
    const Reference bases(i == 0   ? PyTuple_Pack(1, PyExc_RuntimeError)
                          : i == 3 ? PyTuple_Pack(2, errors[0], PyExc_OSError)
                                   : PyTuple_Pack(2, errors[0], PyExc_ValueError));
    const Reference name(PyUnicode_FromFormat("zoneplate.%s", types[i].name));
    if (!bases || !name) return false;
    errors[i] =
        PyErr_NewExceptionWithDoc(PyUnicode_AsUTF8AndSize(name.get(), nullptr), types[i].doc, bases.get(), nullptr);
    if (errors[i] == nullptr || PyModule_AddObjectRef(module, types[i].name, errors[i]) != 0) return false;
  }
  return true;
}

/// The kinds of parts that the package lists.
bool add_parts(PyObject* module) {
  constexpr struct {
    const char* name;
    zoneplate_part part;
  } parts[] = {{"OBJECTS", ZONEPLATE_OBJECTS},  {"MATERIALS", ZONEPLATE_MATERIALS},   {"MESHES", ZONEPLATE_MESHES},
               {"CAMERAS", ZONEPLATE_CAMERAS},  {"ANIMATIONS", ZONEPLATE_ANIMATIONS}, {"VARIANTS", ZONEPLATE_VARIANTS},
               {"WARNINGS", ZONEPLATE_WARNINGS}};
  for (const auto& [name, part] : parts)
    if (PyModule_AddIntConstant(module, name, part) != 0) return false;
  return true;
}

int execute(PyObject* module) {
  if (zoneplate_abi_version() != ZONEPLATE_ABI_VERSION) {
    PyErr_SetString(PyExc_ImportError, "the library has another binary interface than this module");
    return -1;
  }
  const bool is_complete = add_errors(module) && add_array_type(module) && add_image_type(module) &&
                           add_scene_type(module) && add_frames_type(module) && add_parts(module) &&
                           PyModule_AddStringConstant(module, "__version__", zoneplate_version()) == 0;
  return is_complete ? 0 : -1;
}

PyModuleDef_Slot slots[] = {{Py_mod_exec, reinterpret_cast<void*>(execute)}, {0, nullptr}};
PyModuleDef definition = {
    PyModuleDef_HEAD_INIT, "_native", "The functions of zoneplate.h.", 0, functions, slots, nullptr, nullptr, nullptr};

}  // namespace

void set_error(zoneplate_status status) {
  if (status == ZONEPLATE_OUT_OF_MEMORY)
    PyErr_SetString(PyExc_MemoryError, zoneplate_error_text());
  else
    PyErr_SetString(errors[status - 1], zoneplate_error_text());
}

}  // namespace zoneplate::python

#pragma GCC visibility push(default)
PyMODINIT_FUNC PyInit__native() { return PyModuleDef_Init(&zoneplate::python::definition); }
#pragma GCC visibility pop
