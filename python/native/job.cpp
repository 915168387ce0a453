// SPDX-License-Identifier: Apache-2.0
// Jobs: the options of the command as pairs of names and texts, and the frames of a sequence.
#include <memory>

#include "arguments.h"

namespace zoneplate::python {
namespace {

struct FreeJob {
  void operator()(zoneplate_job* job) const { zoneplate_job_free(job); }
};
using Job = std::unique_ptr<zoneplate_job, FreeJob>;

/// A job with options of a sequence of pairs (name, text or None); null with an exception set.
Job job_of(PyObject* pairs) {
  zoneplate_job* made = nullptr;
  if (!succeeds([&] { return zoneplate_job_new(&made); })) return nullptr;
  Job job(made);
  const Py_ssize_t count = PySequence_Size(pairs);
  if (count < 0) return nullptr;
  for (Py_ssize_t i = 0; i < count; ++i) {
    const Reference pair(PySequence_GetItem(pairs, i));
    const char *name = nullptr, *value = nullptr;
    if (!pair || PyArg_ParseTuple(pair.get(), "sz", &name, &value) == 0 ||
        !succeeds([&] { return zoneplate_job_set(made, name, value); }))
      return nullptr;
  }
  return job;
}

struct FramesObject {
  PyObject_HEAD;
  zoneplate_frames* frames;
};

PyObject* frames_type = nullptr;

zoneplate_frames* frames_of(PyObject* self) { return reinterpret_cast<FramesObject*>(self)->frames; }

void free_frames(PyObject* self) {
  PyTypeObject* const type = Py_TYPE(self);
  zoneplate_frames_free(frames_of(self));
  reinterpret_cast<freefunc>(PyType_GetSlot(type, Py_tp_free))(self);
  Py_DECREF(type);
}

PyObject* next_frame(PyObject* self) {
  zoneplate_image* image = nullptr;
  if (!succeeds([&] { return zoneplate_frames_next(frames_of(self), nullptr, &image); }) || image == nullptr)
    return nullptr;
  return make_image(image);
}

Py_ssize_t count_frames(PyObject* self) { return static_cast<Py_ssize_t>(zoneplate_frames_count(frames_of(self))); }

PyType_Slot frames_slots[] = {{Py_tp_dealloc, reinterpret_cast<void*>(free_frames)},
                              {Py_tp_iter, reinterpret_cast<void*>(PyObject_SelfIter)},
                              {Py_tp_iternext, reinterpret_cast<void*>(next_frame)},
                              {Py_sq_length, reinterpret_cast<void*>(count_frames)},
                              {Py_tp_doc, const_cast<char*>("The frames of a sequence, rendered one after the other.")},
                              {0, nullptr}};
PyType_Spec frames_spec = {"zoneplate._native.Frames", sizeof(FramesObject), 0,
                           Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION, frames_slots};

}  // namespace

PyObject* load_by_job(PyObject*, PyObject* arguments) {
  const char* path = nullptr;
  PyObject* pairs = nullptr;
  if (PyArg_ParseTuple(arguments, "sO", &path, &pairs) == 0) return nullptr;
  const Job job = job_of(pairs);
  zoneplate_scene* scene = nullptr;
  if (!job || !succeeds([&] { return zoneplate_job_load(job.get(), path, &scene); })) return nullptr;
  return make_scene(scene);
}

PyObject* render_by_job(PyObject*, PyObject* arguments) {
  PyObject *scene = nullptr, *chosen = nullptr, *pairs = nullptr;
  int form = 0;
  zoneplate_camera camera{};
  camera.size = sizeof camera;
  Storage storage;
  if (PyArg_ParseTuple(arguments, "OOiO", &scene, &chosen, &form, &pairs) == 0 ||
      (chosen != Py_None && !read_camera(chosen, storage, camera)))
    return nullptr;
  const Job job = job_of(pairs);
  zoneplate_image* image = nullptr;
  if (!job || !succeeds([&] {
        return zoneplate_job_render(job.get(), scene_of(scene), chosen == Py_None ? nullptr : &camera,
                                    static_cast<zoneplate_form>(form), &image);
      }))
    return nullptr;
  return make_image(image);
}

PyObject* save_by_job(PyObject*, PyObject* arguments) {
  PyObject *scene = nullptr, *pairs = nullptr;
  const char* output = nullptr;
  if (PyArg_ParseTuple(arguments, "OsO", &scene, &output, &pairs) == 0) return nullptr;
  const Job job = job_of(pairs);
  if (!job || !succeeds([&] { return zoneplate_job_save(job.get(), scene_of(scene), output); })) return nullptr;
  return Py_NewRef(Py_None);
}

PyObject* frames_by_job(PyObject*, PyObject* arguments) {
  PyObject *scene = nullptr, *pairs = nullptr;
  int form = 0;
  if (PyArg_ParseTuple(arguments, "OiO", &scene, &form, &pairs) == 0) return nullptr;
  const Job job = job_of(pairs);
  zoneplate_frames* frames = nullptr;
  if (!job || !succeeds([&] {
        return zoneplate_job_frames(job.get(), scene_of(scene), static_cast<zoneplate_form>(form), &frames);
      }))
    return nullptr;
  auto* const type = reinterpret_cast<PyTypeObject*>(frames_type);
  PyObject* const self = reinterpret_cast<allocfunc>(PyType_GetSlot(type, Py_tp_alloc))(type, 0);
  if (self == nullptr)
    zoneplate_frames_free(frames);
  else
    reinterpret_cast<FramesObject*>(self)->frames = frames;
  return self;
}

PyObject* list_options(PyObject*, PyObject*) {
  Reference list(PyList_New(0));
  zoneplate_option o{};
  o.size = sizeof o;
  for (std::size_t i = 0; list && zoneplate_job_option(i, &o) == ZONEPLATE_OK; ++i) {
    const Reference row(Py_BuildValue("(ssiddsss)", o.name, o.value, static_cast<int>(o.kind), o.low, o.high, o.choices,
                                      o.group, o.summary));
    if (!row || PyList_Append(list.get(), row.get()) != 0) return nullptr;
  }
  return list.release();
}

bool add_frames_type(PyObject* module) {
  frames_type = PyType_FromSpec(&frames_spec);
  return frames_type != nullptr && PyModule_AddObjectRef(module, "Frames", frames_type) == 0;
}

}  // namespace zoneplate::python
