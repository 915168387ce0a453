# SPDX-License-Identifier: Apache-2.0
"""Writes glTF 2.0 binaries: meshes, textures, lights, and animations of nodes and, by KHR_animation_pointer, of materials."""
import json
import struct
import zlib

import numpy as np


def png(pixels):
    """The PNG file of an array (height, width, 3 or 4) of bytes."""
    height, width, channels = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in np.ascontiguousarray(pixels))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 6 if channels == 4 else 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b"")


class Gltf:
    LIGHTS = "KHR_lights_punctual"

    def __init__(self):
        self.data = bytearray()
        self.lists = {name: [] for name in ("accessors", "bufferViews", "cameras", "images", "materials", "meshes",
                                            "nodes", "textures")}
        self.channels, self.samplers, self.lights = [], [], []

    def add(self, name, item):
        self.lists[name].append(item)
        return len(self.lists[name]) - 1

    def view(self, data):
        self.data += b"\0" * (-len(self.data) % 4)
        begin = len(self.data)
        self.data += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": begin, "byteLength": len(data)})

    def accessor(self, array):
        array = np.ascontiguousarray(array)
        kind = "SCALAR" if array.ndim == 1 else "VEC%d" % array.shape[1]
        flat = array.reshape(len(array), -1)
        number = int if array.dtype == np.uint32 else float
        return self.add("accessors", {
            "bufferView": self.view(array.tobytes()), "componentType": 5125 if array.dtype == np.uint32 else 5126,
            "count": len(array), "type": kind,
            "min": [number(v) for v in flat.min(0)], "max": [number(v) for v in flat.max(0)]})

    def texture(self, pixels):
        image = self.add("images", {"bufferView": self.view(png(pixels)), "mimeType": "image/png"})
        return self.add("textures", {"source": image, "sampler": 0})

    def material(self, color, texture=None, is_lit=False, is_cut_out=False):
        surface = {"baseColorFactor": [float(c) for c in color] + [1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}
        if texture is not None:
            surface["baseColorTexture"] = {"index": texture,
                                           "extensions": {"KHR_texture_transform": {"offset": [0.0, 0.0]}}}
        material = {"pbrMetallicRoughness": surface, "doubleSided": True}
        if is_cut_out:
            material["alphaMode"] = "MASK"
        if not is_lit:
            material["extensions"] = {"KHR_materials_unlit": {}}
        return self.add("materials", material)

    def mesh(self, positions, indices, material, uv=None, colors=None, normals=None):
        """Without normals those of +z."""
        positions = np.asarray(positions, np.float32)
        if normals is None:
            normals = np.tile([0, 0, 1], (len(positions), 1))
        attributes = {"POSITION": self.accessor(positions), "NORMAL": self.accessor(np.asarray(normals, np.float32))}
        if uv is not None:
            attributes["TEXCOORD_0"] = self.accessor(np.asarray(uv, np.float32))
        if colors is not None:
            attributes["COLOR_0"] = self.accessor(np.asarray(colors, np.float32))
        indices = self.accessor(np.asarray(indices, np.uint32).ravel())
        return self.add("meshes", {"primitives": [{"attributes": attributes, "indices": indices,
                                                   "material": material}]})

    def node(self, place=(0, 0, 0), **rest):
        return self.add("nodes", {"translation": [float(v) for v in place], **rest})

    def light(self, intensity, tilt_x, tilt_y):
        """A directional light that shines along -z, tilted by two angles."""
        self.lights.append({"type": "directional", "intensity": float(intensity)})
        turn = [np.sin(tilt_x / 2) * np.cos(tilt_y / 2), np.cos(tilt_x / 2) * np.sin(tilt_y / 2), 0.0,
                np.cos(tilt_x / 2) * np.cos(tilt_y / 2)]
        turn = np.array(turn) / np.linalg.norm(turn)
        self.node(rotation=[float(v) for v in turn], extensions={self.LIGHTS: {"light": len(self.lights) - 1}})
        return len(self.lights) - 1

    def animate(self, times, values, node=None, path=None, pointer=None, is_stepped=False):
        """Moves a node's `path`, or the property that a JSON pointer names."""
        self.samplers.append({"input": self.accessor(np.asarray(times, np.float32)),
                              "output": self.accessor(np.asarray(values, np.float32)),
                              "interpolation": "STEP" if is_stepped else "LINEAR"})
        target = {"node": node, "path": path}
        if pointer is not None:
            target = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}
        self.channels.append({"sampler": len(self.samplers) - 1, "target": target})

    def save(self, path):
        self.data += b"\0" * (-len(self.data) % 4)
        file = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(self.lists["nodes"])))}],
                "buffers": [{"byteLength": len(self.data)}],
                "extensionsUsed": ["KHR_materials_unlit", "KHR_texture_transform"],
                **{name: items for name, items in self.lists.items() if items}}
        if self.lists["textures"]:
            file["samplers"] = [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}]
        if self.lights:
            file["extensionsUsed"].append(self.LIGHTS)
            file["extensions"] = {self.LIGHTS: {"lights": self.lights}}
        if self.channels:
            file["extensionsUsed"].append("KHR_animation_pointer")
            file["animations"] = [{"channels": self.channels, "samplers": self.samplers}]
        text = json.dumps(file).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as out:
            out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.data)))
            out.write(struct.pack("<I4s", len(text), b"JSON") + text)
            out.write(struct.pack("<I4s", len(self.data), b"BIN\0") + bytes(self.data))
