# SPDX-License-Identifier: Apache-2.0
"""Runs inside Blender: draws one model by Cycles under an environment image, on a ground, and takes the time.

    blender --background --factory-startup --python scene.py -- JOB.json

The job is written by shots.py. "convert" makes a GLB file instead: of an OBJ file, or of Blender's monkey, subdivided.

Cycles gets the quantity that Zoneplate computes: the light of the environment that arrives without a bounce, on the
model and on a diffuse ground that the camera alone sees, whose colour is the background's where nothing is in the way.
"""
import json
import os
import sys
import time

import bpy
import numpy
from mathutils import Matrix, Vector


numpy.bool = bool  # Debian's importer of glTF uses the name, which Debian's NumPy no longer has


def blender_from_gltf(v):
    """+Y up to +Z up, as Blender's importer does."""
    return Vector((v[0], -v[2], v[1]))


def clear():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)


def grey_material():
    material = bpy.data.materials.new("grey")
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (0.6, 0.6, 0.6, 1)
    shader.inputs["Roughness"].default_value = 0.4
    return material


def convert(job):
    """A GLB file of smooth surfaces of one grey material."""
    if job["model"] == "monkey":
        bpy.ops.mesh.primitive_monkey_add()
        modifier = bpy.context.object.modifiers.new("subdivide", "SUBSURF")
        modifier.levels = modifier.render_levels = 5
        bpy.ops.object.modifier_apply(modifier="subdivide")
    else:
        bpy.ops.wm.obj_import(filepath=job["model"])
    for thing in bpy.data.objects:
        thing.data.materials.clear()
        thing.data.materials.append(grey_material())
        thing.data.polygons.foreach_set("use_smooth", [True] * len(thing.data.polygons))
    bpy.ops.export_scene.gltf(filepath=job["output"], export_format="GLB")


def import_model(path):
    bpy.ops.import_scene.gltf(filepath=path)
    for thing in bpy.data.objects:
        thing.animation_data_clear()
        for bone in thing.pose.bones if thing.pose else ():
            bone.matrix_basis.identity()  # the importer leaves the pose of an animation, a still of Zoneplate has none
        if thing.type in ("LIGHT", "CAMERA"):
            bpy.data.objects.remove(thing)


def add_camera(camera):
    lens = bpy.data.cameras.new("camera")
    lens.sensor_fit, lens.angle = "VERTICAL", camera["view_angle"]
    lens.clip_start, lens.clip_end = camera["near"], camera["far"]
    thing = bpy.data.objects.new("camera", lens)
    right, up, back = (blender_from_gltf(camera[axis]) for axis in ("right", "up", "back"))
    rotation = Matrix((right, up, back)).transposed().to_4x4()
    thing.matrix_world = Matrix.Translation(blender_from_gltf(camera["position"])) @ rotation
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.scene.camera = thing


def add_ground(ground):
    centre, half = blender_from_gltf(ground["centre"]), ground["half_side"]
    mesh = bpy.data.meshes.new("ground")
    corners = [centre + Vector((x * half, y * half, 0)) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    material = bpy.data.materials.new("ground")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*ground["albedo"], 1)
    material.node_tree.links.new(diffuse.outputs["BSDF"], nodes["Material Output"].inputs["Surface"])
    mesh.materials.append(material)
    thing = bpy.data.objects.new("ground", mesh)
    thing.visible_diffuse = thing.visible_glossy = thing.visible_transmission = thing.visible_shadow = False
    bpy.context.scene.collection.objects.link(thing)


def add_environment(path):
    world = bpy.data.worlds.new("environment")
    world.use_nodes = True
    image = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    image.image = bpy.data.images.load(path)
    world.node_tree.links.new(image.outputs["Color"], world.node_tree.nodes["Background"].inputs["Color"])
    bpy.context.scene.world = world


def settings(job):
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = True
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.color_mode = "RGBA"
    scene.render.threads_mode, scene.render.threads = "FIXED", job["threads"]
    scene.view_settings.view_transform = "Standard"


def use_cycles():
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = 0
    cycles.sample_clamp_indirect = 0
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0


def render(path):
    """Renders to a file of linear RGBA from the top; the processor and wall time of the render alone."""
    exr = path + ".exr"
    bpy.context.scene.render.filepath = exr
    before, begin = os.times(), time.perf_counter()
    bpy.ops.render.render(write_still=True)
    wall, after = time.perf_counter() - begin, os.times()
    image = bpy.data.images.load(exr, check_existing=False)
    width, height = image.size
    pixels = numpy.empty(width * height * 4, numpy.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    os.remove(exr)
    numpy.save(path, pixels.reshape(height, width, 4)[::-1])
    return {"cpu": after.user + after.system - before.user - before.system, "wall": wall}


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as file:
        job = json.load(file)
    clear()
    if job.get("convert"):
        convert(job)
        return
    import_model(job["model"])
    add_camera(job["camera"])
    add_ground(job["ground"])
    add_environment(job["environment"])
    settings(job)
    use_cycles()
    times = []
    for shot in job["shots"]:
        bpy.context.scene.cycles.samples, bpy.context.scene.cycles.seed = shot["samples"], shot["seed"]
        times.append({**shot, **render(shot["output"])})
    with open(job["times"], "w", encoding="utf-8") as file:
        json.dump(times, file)


main()
