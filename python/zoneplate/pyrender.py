# SPDX-License-Identifier: Apache-2.0
"""The names of pyrender: OffscreenRenderer, and the parts of scenes, for programs that were written for it.

    import zoneplate.pyrender as pyrender

OffscreenRenderer also takes scenes of pyrender itself, and zoneplate.Scene. Angles are in radians here, as in pyrender. A
scene without lights and ambient light gets the default light of the command, where pyrender draws it black.
"""

from __future__ import annotations

import math

from . import _native
from ._jobs import render
from ._scenes import Camera, Scene as NativeScene, View

TYPE_CHECKING = False  # type checkers take it as true; to import typing takes milliseconds
if TYPE_CHECKING:
    from typing import Any, Iterable, Sequence

    import numpy as np


class RenderFlags:
    """The flags of `OffscreenRenderer.render`, with the values of pyrender."""

    NONE = 0
    DEPTH_ONLY = 1  #: returns the depth alone
    OFFSCREEN = 2  #: always so
    SHADOWS_DIRECTIONAL = 32  #: any of the flags of shadows casts those of all lights
    SHADOWS_POINT = 64
    SHADOWS_SPOT = 128
    SHADOWS_ALL = 224
    SKIP_CULL_FACES = 1024  #: back faces are drawn
    RGBA = 2048  #: the colour has an alpha channel
    FLAT = 4096  #: without lights
    SEG = 8192  #: the colour is that of `seg_node_map`


SUPPORTED = sum(getattr(RenderFlags, n) for n in ("DEPTH_ONLY", "OFFSCREEN", "SHADOWS_ALL", "SKIP_CULL_FACES", "RGBA", "FLAT", "SEG"))


class MetallicRoughnessMaterial:
    """A material of glTF 2.0; textures are arrays."""

    def __init__(
        self,
        name: str | None = None,
        normalTexture: Any = None,
        occlusionTexture: Any = None,
        emissiveTexture: Any = None,
        emissiveFactor: Sequence[float] | None = None,
        alphaMode: str | None = None,
        alphaCutoff: float | None = None,
        doubleSided: bool = False,
        baseColorFactor: Sequence[float] | None = None,
        baseColorTexture: Any = None,
        metallicFactor: float = 1.0,
        roughnessFactor: float = 1.0,
        metallicRoughnessTexture: Any = None,
    ):
        self.name = name
        self.normalTexture, self.occlusionTexture, self.emissiveTexture = normalTexture, occlusionTexture, emissiveTexture
        self.emissiveFactor = (0.0, 0.0, 0.0) if emissiveFactor is None else emissiveFactor
        self.alphaMode = alphaMode or "OPAQUE"
        self.alphaCutoff = 0.5 if alphaCutoff is None else alphaCutoff
        self.doubleSided = doubleSided
        self.baseColorFactor = (1.0, 1.0, 1.0, 1.0) if baseColorFactor is None else baseColorFactor
        self.baseColorTexture = baseColorTexture
        self.metallicFactor, self.roughnessFactor = metallicFactor, roughnessFactor
        self.metallicRoughnessTexture = metallicRoughnessTexture


class Primitive:
    """Vertex arrays and a material. `mode`: 0 points, 1 lines, 4 triangles."""

    def __init__(
        self,
        positions: Any,
        normals: Any = None,
        texcoord_0: Any = None,
        color_0: Any = None,
        indices: Any = None,
        material: MetallicRoughnessMaterial | None = None,
        mode: int = 4,
        poses: Any = None,
    ):
        self.positions, self.normals, self.texcoord_0, self.color_0 = positions, normals, texcoord_0, color_0
        self.indices, self.material, self.mode, self.poses = indices, material, mode, poses


class Mesh:
    """Primitives that move together."""

    def __init__(self, primitives: Iterable[Any], name: str | None = None):
        self.primitives = list(primitives)
        self.name = name

    @staticmethod
    def from_trimesh(mesh: Any, material: Any = None, poses: Any = None, smooth: bool = True) -> Mesh:
        """A mesh of one or several trimesh objects. `smooth`: the normals of the vertices, otherwise of the faces."""
        meshes = mesh if isinstance(mesh, (list, tuple)) else [mesh]
        return Mesh([TrimeshPrimitive(m, material, poses, smooth) for m in meshes])

    @staticmethod
    def from_points(points: Any, colors: Any = None, normals: Any = None, poses: Any = None) -> Mesh:
        """A mesh of points."""
        return Mesh([Primitive(points, normals, color_0=colors, mode=0, poses=poses)])


class TrimeshPrimitive:
    """A trimesh object, which is read when it is rendered."""

    def __init__(self, source: Any, material: Any, poses: Any, smooth: bool):
        self.source, self.material, self.poses, self.smooth = source, material, poses, smooth


class PerspectiveCamera:
    """A camera with a vertical field of view in radians."""

    def __init__(self, yfov: float, znear: float = 0.05, zfar: float | None = None, aspectRatio: float | None = None):
        self.yfov, self.znear, self.zfar, self.aspectRatio = yfov, znear, zfar, aspectRatio


class OrthographicCamera:
    """A camera with a parallel projection; `ymag` is half the height that it shows."""

    def __init__(self, xmag: float, ymag: float, znear: float = 0.05, zfar: float = 100.0):
        self.xmag, self.ymag, self.znear, self.zfar = xmag, ymag, znear, zfar


class IntrinsicsCamera:
    """A pinhole camera by focal lengths and principal point in pixels from the image's top-left corner."""

    def __init__(self, fx: float, fy: float, cx: float, cy: float, znear: float = 0.05, zfar: float = 100.0):
        self.fx, self.fy, self.cx, self.cy, self.znear, self.zfar = fx, fy, cx, cy, znear, zfar


class DirectionalLight:
    """Parallel light along -z of its node, in lux."""

    def __init__(self, color: Sequence[float] | None = None, intensity: float = 1.0):
        self.color, self.intensity = color, intensity


class PointLight:
    """Light from its node's position, in candela."""

    def __init__(self, color: Sequence[float] | None = None, intensity: float = 1.0, range: float | None = None):
        self.color, self.intensity, self.range = color, intensity, range


class SpotLight:
    """Light from its node's position along its -z, in candela; angles in radians from the axis."""

    def __init__(
        self,
        color: Sequence[float] | None = None,
        intensity: float = 1.0,
        range: float | None = None,
        innerConeAngle: float = 0.0,
        outerConeAngle: float = math.pi / 4,
    ):
        self.color, self.intensity, self.range = color, intensity, range
        self.innerConeAngle, self.outerConeAngle = innerConeAngle, outerConeAngle


class Node:
    """A mesh, a camera or a light with its pose in the world."""

    def __init__(
        self, name: str | None = None, camera: Any = None, light: Any = None, mesh: Any = None, matrix: Any = None
    ):
        self.name, self.camera, self.light, self.mesh = name, camera, light, mesh
        self.matrix = identity() if matrix is None else matrix


class Scene:
    """Nodes, a background and ambient light."""

    def __init__(
        self,
        nodes: Iterable[Node] | None = None,
        bg_color: Sequence[float] | None = None,
        ambient_light: Sequence[float] | None = None,
        name: str | None = None,
    ):
        self.nodes = list(nodes or ())
        self.bg_color = (1.0, 1.0, 1.0, 1.0) if bg_color is None else bg_color
        self.ambient_light = (0.0, 0.0, 0.0) if ambient_light is None else ambient_light
        self.name = name
        self.main_camera_node = next((n for n in self.nodes if n.camera is not None), None)

    def add(self, obj: Any, name: str | None = None, pose: Any = None) -> Node:
        """Adds a mesh, a camera or a light at a pose (4 x 4, world from object)."""
        parts = {"mesh": obj} if hasattr(obj, "primitives") else {"light": obj} if hasattr(obj, "intensity") else {"camera": obj}
        node = Node(name=name, matrix=pose, **parts)
        self.add_node(node)
        return node

    def add_node(self, node: Node) -> None:
        """Adds a node; the first camera is the main one."""
        self.nodes.append(node)
        if node.camera is not None and self.main_camera_node is None:
            self.main_camera_node = node

    def remove_node(self, node: Node) -> None:
        """Removes a node."""
        self.nodes.remove(node)
        if node is self.main_camera_node:
            self.main_camera_node = next((n for n in self.nodes if n.camera is not None), None)

    def get_pose(self, node: Node) -> Any:
        """The pose of a node."""
        return node.matrix

    def set_pose(self, node: Node, pose: Any) -> None:
        """Moves a node."""
        node.matrix = pose

    @property
    def mesh_nodes(self) -> list[Node]:
        return [n for n in self.nodes if n.mesh is not None]

    @property
    def light_nodes(self) -> list[Node]:
        return [n for n in self.nodes if n.light is not None]


class OffscreenRenderer:
    """Renders scenes to arrays, as pyrender.OffscreenRenderer does; it needs no display and no OpenGL.

    `aa` is the antialiasing method. Scenes: those of this module, of pyrender, and zoneplate.Scene or what
    zoneplate.render takes (with a `camera`).
    """

    def __init__(self, viewport_width: int, viewport_height: int, point_size: float = 1.0, aa: str = "msaa:n=8,alpha=samples"):
        self.viewport_width, self.viewport_height, self.point_size, self.aa = viewport_width, viewport_height, point_size, aa

    def render(
        self, scene: Any, flags: int = RenderFlags.NONE, seg_node_map: dict[Any, Any] | None = None, camera: Any = None
    ) -> Any:
        """The colour (height x width x 3, or 4 with RGBA; uint8) and the depth (float32, metres, 0 where nothing is).

        With DEPTH_ONLY the depth alone. With SEG the colours that `seg_node_map` gives to nodes, black for others.
        """
        import numpy as np

        if int(flags) & ~SUPPORTED:
            raise _native.UsageError(f"flags: {int(flags) & ~SUPPORTED} are not supported")
        flags = int(flags)
        owners: list[Any] = []
        options: dict[str, Any] = {}
        if hasattr(scene, "mesh_nodes"):
            native, owners = scene_of(scene, bool(flags & RenderFlags.FLAT))
            camera = camera or camera_of(scene, self.viewport_width, self.viewport_height)
            background = np.asarray(scene.bg_color, dtype=float)
            background = background / 255 if background.max() > 1 else background
            options["background"] = tuple(background.tolist())
        else:
            native = scene
        only_data = flags & (RenderFlags.DEPTH_ONLY | RenderFlags.SEG)
        image = render(
            native,
            camera,
            (self.viewport_width, self.viewport_height),
            aa="none" if only_data else self.aa,
            aovs=["depth", "object-id"] if flags & RenderFlags.SEG else ["depth"],
            cull_back_faces=not flags & RenderFlags.SKIP_CULL_FACES,
            point_size=self.point_size,
            shadows="hard" if flags & RenderFlags.SHADOWS_ALL else "none",
            **options,
        )
        depth = image["depth"]
        depth[np.isinf(depth)] = 0
        if flags & RenderFlags.DEPTH_ONLY:
            return depth
        if flags & RenderFlags.SEG:
            return segments_of(image["object-id"], owners, seg_node_map or {}), depth
        return (image.color if flags & RenderFlags.RGBA else np.ascontiguousarray(image.rgb)), depth

    def delete(self) -> None:
        """Does nothing: there is no context to be freed."""


def identity() -> np.ndarray:
    import numpy as np

    return np.eye(4)


def segments_of(ids: np.ndarray, owners: list[Any], colors: dict[Any, Any]) -> np.ndarray:
    """The colour of each pixel's node. Object i belongs to the node owners[i]."""
    import numpy as np

    table = np.zeros((len(owners) + 1, 3), np.uint8)
    for i, node in enumerate(owners):
        if node in colors:
            table[i] = colors[node]  # three numbers, or one for all channels
    return table[np.minimum(ids, len(owners))]


def source_of(texture: Any) -> Any:
    """The pixels of a pyrender.Texture, of an array or of a PIL image."""
    from ._adapters import pixels_of

    return pixels_of(getattr(texture, "source", texture))


def scene_of(source: Any, is_flat: bool) -> tuple[NativeScene, list[Any]]:
    """The scene of a pyrender scene, and the node of each object."""
    import numpy as np

    scene = NativeScene()
    owners: list[Any] = []
    for node in source.mesh_nodes:
        pose = np.asarray(source.get_pose(node), dtype=float)
        for primitive in node.mesh.primitives:
            poses = [pose] if primitive.poses is None else [pose @ p for p in np.asarray(primitive.poses)]
            add_primitive(scene, primitive, poses, node.name or node.mesh.name or "mesh", is_flat)
            owners.extend([node] * len(poses))
    for node in source.light_nodes:
        pose = np.asarray(source.get_pose(node), dtype=float)
        light = node.light
        kind = "spot" if hasattr(light, "outerConeAngle") else "point" if hasattr(light, "range") else "directional"
        cone: dict[str, Any] = {}
        if kind == "spot":
            cone = {"inner_cone": math.degrees(light.innerConeAngle), "outer_cone": math.degrees(light.outerConeAngle)}
        scene.add_light(
            kind,
            color=None if light.color is None else tuple(float(c) for c in light.color),
            intensity=light.intensity,
            position=tuple(pose[:3, 3]),
            direction=tuple(-pose[:3, 2]),
            range=getattr(light, "range", None),
            **cone,
        )
    ambient = [float(c) for c in source.ambient_light[:3]]
    if source.light_nodes or any(ambient):
        scene.set_environment(ambient)
    return scene, owners


def add_primitive(scene: NativeScene, primitive: Any, poses: list[Any], name: str, is_flat: bool) -> None:
    if isinstance(primitive, TrimeshPrimitive):
        from ._adapters import mesh_of

        arguments = mesh_of(scene, primitive.source)
        if not primitive.smooth:
            arguments["flat"] = True
        if primitive.material is not None:
            arguments = {k: arguments[k] for k in ("positions", "indices", "uvs", "flat") if k in arguments}
            arguments.update(material_of(scene, primitive.material))
    else:
        modes = {0: "points", 1: "lines", 4: "triangles"}
        if primitive.mode not in modes:
            raise _native.UsageError(f"Primitive.mode: is {primitive.mode}, expected 0, 1 or 4")
        arguments = {
            "positions": primitive.positions,
            "indices": primitive.indices,
            "normals": primitive.normals,
            "uvs": flipped(primitive.texcoord_0),
            "colors": primitive.color_0,
            "topology": modes[primitive.mode],
        }
        if primitive.material is not None:
            arguments.update(material_of(scene, primitive.material))
    if is_flat:
        arguments["model"] = "unlit"
    scene.add_mesh(name=name, instances=poses, **arguments)


def flipped(uv: Any) -> Any:
    """Coordinates whose v grows downwards; those of pyrender grow upwards."""
    import numpy as np

    if uv is None:
        return None
    array = np.asarray(uv)
    return np.stack([array[:, 0], 1 - array[:, 1]], axis=1)


def material_of(scene: NativeScene, material: Any) -> dict[str, Any]:
    """The arguments of Scene.add_material."""
    texture = lambda image: None if image is None else scene.add_texture(source_of(image))
    arguments = {
        "color": tuple(float(c) for c in material.baseColorFactor),
        "metallic": material.metallicFactor,
        "roughness": material.roughnessFactor,
        "emissive": tuple(float(c) for c in material.emissiveFactor),
        "alpha_mode": material.alphaMode.lower(),
        "alpha_cutoff": material.alphaCutoff,
        "double_sided": material.doubleSided,
        "texture": texture(material.baseColorTexture),
        "metallic_roughness_texture": texture(material.metallicRoughnessTexture),
        "normal_texture": texture(material.normalTexture),
        "occlusion_texture": texture(material.occlusionTexture),
        "emissive_texture": texture(material.emissiveTexture),
    }
    return {k: v for k, v in arguments.items() if v is not None}


def camera_of(scene: Any, width: int, height: int) -> Camera | View:
    """The main camera of a scene; without one, the view of the whole scene."""
    node = scene.main_camera_node
    if node is None:
        return View()
    camera, pose = node.camera, scene.get_pose(node)
    if hasattr(camera, "ymag"):
        return Camera(pose, height=2 * camera.ymag, near=camera.znear, far=camera.zfar)
    if hasattr(camera, "fx"):
        # pyrender's (0, 0) is the corner of the top-left pixel.
        intrinsics = (camera.fx, camera.fy, camera.cx - 0.5, camera.cy - 0.5)
        return Camera(pose, near=camera.znear, far=camera.zfar, intrinsics=intrinsics)
    return Camera(pose, math.degrees(camera.yfov), near=camera.znear, far=camera.zfar)
