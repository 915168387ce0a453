// SPDX-License-Identifier: Apache-2.0
// Scene: loading, building and rendering.
#include <string>

#include "arguments.h"
#include "python.h"

namespace zoneplate::python {
namespace {

struct SceneObject {
  PyObject_HEAD;
  zoneplate_scene* scene;
};

PyObject* scene_type = nullptr;

#define FIELD(type, member, kind, ...) \
  { #member, Kind::kind, offsetof(type, member) __VA_OPT__(, ) __VA_ARGS__ }

constexpr Field load_fields[] = {
    FIELD(zoneplate_load_options, format, Text),        FIELD(zoneplate_load_options, variant, Text),
    FIELD(zoneplate_load_options, scene, OptionalInt),  FIELD(zoneplate_load_options, animation, OptionalInt),
    FIELD(zoneplate_load_options, time, Double),        FIELD(zoneplate_load_options, is_sandboxed, Flag),
    FIELD(zoneplate_load_options, max_memory, Long),    FIELD(zoneplate_load_options, max_seconds, Double),
    FIELD(zoneplate_load_options, animation_name, Text)};
constexpr Field material_fields[] = {FIELD(zoneplate_material, name, Text),
                                     FIELD(zoneplate_material, model, Int),
                                     FIELD(zoneplate_material, alpha_mode, Int),
                                     FIELD(zoneplate_material, alpha_cutoff, OptionalFloat),
                                     FIELD(zoneplate_material, is_double_sided, Flag),
                                     FIELD(zoneplate_material, base_color, Floats, 4),
                                     FIELD(zoneplate_material, emissive, Floats, 3),
                                     FIELD(zoneplate_material, metallic, OptionalFloat),
                                     FIELD(zoneplate_material, roughness, OptionalFloat),
                                     FIELD(zoneplate_material, specular, Floats, 3),
                                     FIELD(zoneplate_material, exponent, OptionalFloat),
                                     FIELD(zoneplate_material, base_color_texture, OptionalInt),
                                     FIELD(zoneplate_material, metallic_roughness_texture, OptionalInt),
                                     FIELD(zoneplate_material, normal_texture, OptionalInt),
                                     FIELD(zoneplate_material, occlusion_texture, OptionalInt),
                                     FIELD(zoneplate_material, emissive_texture, OptionalInt)};
constexpr Field mesh_fields[] = {FIELD(zoneplate_mesh, name, Text),
                                 FIELD(zoneplate_mesh, topology, Int),
                                 FIELD(zoneplate_mesh, positions, Array),
                                 FIELD(zoneplate_mesh, normals, Array),
                                 FIELD(zoneplate_mesh, uvs, Array),
                                 FIELD(zoneplate_mesh, colors, Array),
                                 FIELD(zoneplate_mesh, indices, Array),
                                 FIELD(zoneplate_mesh, material, Int),
                                 FIELD(zoneplate_mesh, has_flat_normals, Flag)};
constexpr Field light_fields[] = {FIELD(zoneplate_light, kind, Int),
                                  FIELD(zoneplate_light, color, Floats, 3),
                                  FIELD(zoneplate_light, intensity, OptionalFloat),
                                  FIELD(zoneplate_light, position, Place),
                                  FIELD(zoneplate_light, direction, Floats, 3),
                                  FIELD(zoneplate_light, range, OptionalFloat),
                                  FIELD(zoneplate_light, inner_cone, Float),
                                  FIELD(zoneplate_light, outer_cone, OptionalFloat),
                                  FIELD(zoneplate_light, radius, Float),
                                  FIELD(zoneplate_light, is_in_camera_space, Flag)};
constexpr Field camera_fields[] = {FIELD(zoneplate_camera, world_from_camera, Doubles, 16),
                                   FIELD(zoneplate_camera, is_orthographic, Flag),
                                   FIELD(zoneplate_camera, vertical_fov, Double),
                                   FIELD(zoneplate_camera, half_height, Double),
                                   FIELD(zoneplate_camera, near, Double),
                                   FIELD(zoneplate_camera, far, Double),
                                   FIELD(zoneplate_camera, intrinsics, Doubles, 4),
                                   FIELD(zoneplate_camera, distortion, Doubles, 8)};
constexpr Field view_fields[] = {
    FIELD(zoneplate_view, index, OptionalInt),          FIELD(zoneplate_view, position, Place),
    FIELD(zoneplate_view, focal_point, Place),          FIELD(zoneplate_view, view_up, Floats, 3),
    FIELD(zoneplate_view, vertical_fov, OptionalFloat), FIELD(zoneplate_view, azimuth, OptionalFloat),
    FIELD(zoneplate_view, elevation, OptionalFloat),    FIELD(zoneplate_view, is_orthographic, Flag)};
#undef FIELD

PyObject* scene_object(PyTypeObject* type, zoneplate_scene* scene) {
  PyObject* const self = reinterpret_cast<allocfunc>(PyType_GetSlot(type, Py_tp_alloc))(type, 0);
  if (self == nullptr)
    zoneplate_scene_free(scene);
  else
    reinterpret_cast<SceneObject*>(self)->scene = scene;
  return self;
}

/// Scene() is empty; Scene(path, **options) loads a file or makes a built-in scene.
PyObject* new_scene(PyTypeObject* type, PyObject* arguments, PyObject* keywords) {
  const char* path = nullptr;
  zoneplate_load_options options{};
  options.size = sizeof options;
  Storage storage;
  if (PyArg_ParseTuple(arguments, "|z", &path) == 0 || !storage.fill(keywords, load_fields, &options)) return nullptr;
  zoneplate_scene* scene = nullptr;
  if (!succeeds(
          [&] { return path == nullptr ? zoneplate_scene_new(&scene) : zoneplate_scene_load(path, &options, &scene); }))
    return nullptr;
  return scene_object(type, scene);
}

void free_scene(PyObject* self) {
  PyTypeObject* const type = Py_TYPE(self);
  zoneplate_scene_free(scene_of(self));
  reinterpret_cast<freefunc>(PyType_GetSlot(type, Py_tp_free))(self);
  Py_DECREF(type);
}

PyObject* add_image(PyObject* self, PyObject* pixels) {
  InputArray array;
  std::int32_t index = 0;
  if (!array.open(pixels, "pixels") ||
      !succeeds([&] { return zoneplate_scene_add_image(scene_of(self), &array.array(), &index); }))
    return nullptr;
  return PyLong_FromLong(index);
}

/// Adds a part that is described by keyword arguments; returns its index.
template <class Options, auto add, const auto& fields>
PyObject* add_part(PyObject* self, PyObject*, PyObject* keywords) {
  Options options{};
  options.size = sizeof options;
  Storage storage;
  std::int32_t index = 0;
  if (!storage.fill(keywords, fields, &options) || !succeeds([&] { return add(scene_of(self), &options, &index); }))
    return nullptr;
  return PyLong_FromLong(index);
}

zoneplate_status add_light(zoneplate_scene* scene, const zoneplate_light* light, std::int32_t*) {
  return zoneplate_scene_add_light(scene, light);
}

PyObject* add_instance(PyObject* self, PyObject* arguments) {
  int mesh = 0;
  PyObject* matrix = nullptr;
  const char* name = nullptr;
  double numbers[16];
  std::int32_t index = 0;
  if (PyArg_ParseTuple(arguments, "iOz", &mesh, &matrix, &name) == 0) return nullptr;
  if (matrix != Py_None && !read_numbers(matrix, "transform", 16, numbers)) return nullptr;
  if (!succeeds([&] {
        return zoneplate_scene_add_instance(scene_of(self), mesh, matrix == Py_None ? nullptr : numbers, name, &index);
      }))
    return nullptr;
  return PyLong_FromLong(index);
}

PyObject* set_environment(PyObject* self, PyObject* arguments) {
  float color[3], rotation = 0;
  int image = -1;
  if (PyArg_ParseTuple(arguments, "(fff)if", &color[0], &color[1], &color[2], &image, &rotation) == 0 ||
      !succeeds([&] { return zoneplate_scene_set_environment(scene_of(self), color, image, rotation); }))
    return nullptr;
  return Py_NewRef(Py_None);
}

PyObject* set_up(PyObject* self, PyObject* arguments) {
  float up[3];
  if (PyArg_ParseTuple(arguments, "fff", &up[0], &up[1], &up[2]) == 0 ||
      !succeeds([&] { return zoneplate_scene_set_up(scene_of(self), up); }))
    return nullptr;
  return Py_NewRef(Py_None);
}

PyObject* get_names(PyObject* self, PyObject* part) {
  const auto chosen = static_cast<zoneplate_part>(PyLong_AsLong(part));
  std::int64_t count = 0;
  if (PyErr_Occurred() != nullptr || !succeeds([&] { return zoneplate_scene_count(scene_of(self), chosen, &count); }))
    return nullptr;
  Reference names(PyList_New(0));
  for (std::int64_t i = 0; names && i < count; ++i) {
    const char* name = nullptr;
    if (!succeeds([&] { return zoneplate_scene_name(scene_of(self), chosen, i, &name); })) return nullptr;
    const Reference text(
        PyUnicode_DecodeUTF8(name, static_cast<Py_ssize_t>(std::char_traits<char>::length(name)), "replace"));
    if (!text || PyList_Append(names.get(), text.get()) != 0) return nullptr;
  }
  return names.release();
}

PyObject* get_bounds(PyObject* self, PyObject*) {
  double low[3], high[3];
  if (!succeeds([&] { return zoneplate_scene_bounds(scene_of(self), low, high); })) return nullptr;
  return Py_BuildValue("((ddd)(ddd))", low[0], low[1], low[2], high[0], high[1], high[2]);
}

PyObject* find_camera(PyObject* self, PyObject* arguments, PyObject* keywords) {
  double aspect = 0;
  zoneplate_view view{};
  view.size = sizeof view;
  Storage storage;
  zoneplate_camera camera{};
  if (PyArg_ParseTuple(arguments, "d", &aspect) == 0 || !storage.fill(keywords, view_fields, &view) ||
      !succeeds([&] { return zoneplate_scene_camera(scene_of(self), &view, aspect, &camera); }))
    return nullptr;
  const Reference matrix(PyTuple_New(16));
  if (!matrix) return nullptr;
  for (Py_ssize_t i = 0; i < 16; ++i) PyTuple_SetItem(matrix.get(), i, PyFloat_FromDouble(camera.world_from_camera[i]));
  return Py_BuildValue("{s:O,s:O,s:d,s:d,s:d,s:d}", "world_from_camera", matrix.get(), "is_orthographic",
                       camera.is_orthographic != 0 ? Py_True : Py_False, "vertical_fov", camera.vertical_fov,
                       "half_height", camera.half_height, "near", camera.near, "far", camera.far);
}

PyCFunction with_keywords(PyObject* (*function)(PyObject*, PyObject*, PyObject*)) {
  return reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(function));
}

PyMethodDef methods[] = {
    {"add_image", add_image, METH_O, "add_image(pixels): adds an image for textures; its index."},
    {"add_material", with_keywords(add_part<zoneplate_material, zoneplate_scene_add_material, material_fields>),
     METH_VARARGS | METH_KEYWORDS, "add_material(**members of zoneplate_material): its index."},
    {"add_mesh", with_keywords(add_part<zoneplate_mesh, zoneplate_scene_add_mesh, mesh_fields>),
     METH_VARARGS | METH_KEYWORDS, "add_mesh(**members of zoneplate_mesh): its index."},
    {"add_light", with_keywords(add_part<zoneplate_light, add_light, light_fields>), METH_VARARGS | METH_KEYWORDS,
     "add_light(**members of zoneplate_light)."},
    {"add_instance", add_instance, METH_VARARGS, "add_instance(mesh, 16 numbers or None, name): its object's index."},
    {"set_environment", set_environment, METH_VARARGS, "set_environment((r, g, b), image, rotation)."},
    {"set_up", set_up, METH_VARARGS, "set_up(x, y, z)."},
    {"names", get_names, METH_O, "names(part): the names of the parts of a kind (zoneplate_part)."},
    {"bounds", get_bounds, METH_NOARGS, "bounds(): (minimum, maximum)."},
    {"camera", with_keywords(find_camera), METH_VARARGS | METH_KEYWORDS,
     "camera(aspect, **members of zoneplate_view): the members of zoneplate_camera."},
    {nullptr, nullptr, 0, nullptr}};
PyType_Slot slots[] = {{Py_tp_new, reinterpret_cast<void*>(new_scene)},
                       {Py_tp_dealloc, reinterpret_cast<void*>(free_scene)},
                       {Py_tp_methods, methods},
                       {Py_tp_doc, const_cast<char*>("A scene: Scene() or Scene(path, **options).")},
                       {0, nullptr}};
PyType_Spec spec = {"zoneplate._native.Scene", sizeof(SceneObject), 0, Py_TPFLAGS_DEFAULT, slots};

}  // namespace

zoneplate_scene* scene_of(PyObject* object) { return reinterpret_cast<SceneObject*>(object)->scene; }

PyObject* make_scene(zoneplate_scene* scene) {
  return scene_object(reinterpret_cast<PyTypeObject*>(scene_type), scene);
}

bool read_camera(PyObject* members, Storage& storage, zoneplate_camera& camera) {
  return storage.fill(members, camera_fields, &camera);
}

bool add_scene_type(PyObject* module) {
  scene_type = PyType_FromSpec(&spec);
  return scene_type != nullptr && PyModule_AddObjectRef(module, "Scene", scene_type) == 0;
}

}  // namespace zoneplate::python
