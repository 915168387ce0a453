# SPDX-License-Identifier: Apache-2.0
"""Scenes, cameras and rendering."""

from __future__ import annotations

import math
import os

from . import _native
from ._images import Image, buffer_of

TYPE_CHECKING = False  # type checkers take it as true; to import typing takes milliseconds
if TYPE_CHECKING:
    from typing import Any, Iterable, Sequence

    import numpy as np

    Floats = Sequence[float]
    Matrix = Sequence[Sequence[float]] | np.ndarray

MODELS = {"metallic-roughness": 0, "blinn-phong": 1, "phong": 2, "unlit": 3}
ALPHA_MODES = {"opaque": 0, "mask": 1, "blend": 2}
TOPOLOGIES = {"triangles": 0, "lines": 1, "points": 2}
LIGHTS = {"directional": 0, "point": 1, "spot": 2}


def choose(names: dict[str, int], name: str, argument: str) -> int:
    if name not in names:
        raise _native.UsageError(f"{argument}: is {name!r}, expected one of {', '.join(names)}")
    return names[name]


def codes_of_text(text: str) -> tuple[float, ...]:
    """The numbers in [0, 1] of "#rrggbb" or "#rrggbbaa"."""
    digits = text[1:]
    if not text.startswith("#") or len(digits) not in (6, 8):
        raise _native.UsageError(f"{text!r} is not a colour, expected #rrggbb, #rrggbbaa or numbers")
    try:
        return tuple(int(digits[i : i + 2], 16) / 255 for i in range(0, len(digits), 2))
    except ValueError:
        raise _native.UsageError(f"{text!r} is not a colour, expected #rrggbb, #rrggbbaa or numbers") from None


def linear_color(color: str | Floats, count: int) -> tuple[float, ...]:
    """Linear red, green, blue (and alpha): text is sRGB-encoded, numbers are linear."""
    if isinstance(color, str):
        codes = codes_of_text(color)
        decode = lambda c: c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
        numbers = tuple(decode(c) for c in codes[:3]) + codes[3:]
    else:
        numbers = tuple(float(c) for c in color)
    return (numbers + (1.0,))[:count] if len(numbers) == 3 else numbers[:count]


def flat_matrix(matrix: Matrix) -> tuple[float, ...]:
    """The 16 numbers of a 4 x 4 matrix, row by row."""
    rows = [tuple(row) for row in matrix]
    if len(rows) != 4 or any(len(row) != 4 for row in rows):
        raise _native.UsageError("a transform is a 4 x 4 matrix")
    return tuple(float(x) for row in rows for x in row)


class View:
    """A choice of the camera by what it shows, completed for each image's aspect ratio.

    Without arguments it shows the whole scene, three-quarter from above. `azimuth` (from the front to the right) and
    `elevation` (above the horizon) turn it; `position`, `focal_point`, `view_up` and `vertical_fov` replace its own;
    `index` is a camera of the file. Angles in degrees; places in the coordinates of the file or the arrays, in doubles.
    """

    __slots__ = ("index", "position", "focal_point", "view_up", "vertical_fov", "azimuth", "elevation", "orthographic")

    def __init__(
        self,
        *,
        azimuth: float | None = None,
        elevation: float | None = None,
        position: Floats | None = None,
        focal_point: Floats | None = None,
        view_up: Floats | None = None,
        vertical_fov: float | None = None,
        index: int | None = None,
        orthographic: bool = False,
    ):
        self.azimuth, self.elevation = azimuth, elevation
        self.position, self.focal_point, self.view_up = position, focal_point, view_up
        self.vertical_fov, self.index, self.orthographic = vertical_fov, index, orthographic

    def _members(self) -> dict[str, Any]:
        radians = lambda angle: None if angle is None else math.radians(angle)
        return {
            "index": self.index,
            "position": self.position,
            "focal_point": self.focal_point,
            "view_up": self.view_up,
            "vertical_fov": radians(self.vertical_fov),
            "azimuth": radians(self.azimuth),
            "elevation": radians(self.elevation),
            "is_orthographic": self.orthographic,
        }


_identity = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Camera:
    """A camera in the world, which looks along its own -z with +y up.

    `matrix`: its pose, world from camera, 4 x 4 and rigid. `vertical_fov` in degrees; `height` instead makes a parallel
    projection that shows this height in world units. `near` and `far` are distances along the view axis.

    `intrinsics` = (fx, fy, cx, cy) instead of a field of view, in pixels of the image that is rendered, where (0, 0) is
    the centre of the top-left pixel, and `distortion` = (k1, k2, p1, p2[, k3[, k4, k5, k6]]) are those of OpenCV.
    """

    __slots__ = ("matrix", "vertical_fov", "height", "near", "far", "intrinsics", "distortion")

    def __init__(
        self,
        matrix: Matrix,
        vertical_fov: float = 30.0,
        *,
        height: float | None = None,
        near: float = 0.01,
        far: float | None = None,
        intrinsics: Sequence[float] | None = None,
        distortion: Sequence[float] = (),
    ):
        if intrinsics is None and len(distortion) > 0:
            raise _native.UsageError("distortion: requires intrinsics")
        if intrinsics is not None and height is not None:
            raise _native.UsageError("intrinsics: a camera with a height has a parallel projection")
        self.matrix = matrix
        self.vertical_fov, self.height, self.near = vertical_fov, height, near
        self.intrinsics = None if intrinsics is None else tuple(float(v) for v in intrinsics)
        if self.intrinsics is not None and len(self.intrinsics) != 4:
            raise _native.UsageError("intrinsics: expected fx, fy, cx, cy")
        self.distortion = tuple(float(v) for v in distortion)
        if len(self.distortion) not in (0, 4, 5, 8):
            raise _native.UsageError(f"distortion: has {len(self.distortion)} coefficients, expected 4, 5 or 8")
        self.far = far if far is not None else (math.inf if height is None else 1000.0)

    def _members(self) -> dict[str, Any]:
        return {
            "world_from_camera": flat_matrix(self.matrix),
            "is_orthographic": self.height is not None,
            "vertical_fov": math.radians(self.vertical_fov),
            "half_height": 1.0 if self.height is None else self.height / 2,
            "near": self.near,
            "far": self.far,
            "intrinsics": self.intrinsics or (0.0,) * 4,
            "distortion": self.distortion + (0.0,) * (8 - len(self.distortion)),
        }

    @classmethod
    def from_opencv(
        cls,
        camera_matrix: Any,
        distortion: Any = (),
        *,
        rotation: Matrix | None = None,
        translation: Sequence[float] = (0.0, 0.0, 0.0),
        near: float = 0.01,
        far: float | None = None,
    ) -> Camera:
        """A camera from OpenCV's camera matrix (3 x 3) and distortion coefficients, as cv2.calibrateCamera gives them.

        `rotation` (3 x 3, of cv2.Rodrigues) and `translation` move points of the world to OpenCV's camera, whose y axis
        points downwards and whose z axis points ahead, as rvec and tvec do.
        """
        k = [[float(camera_matrix[i][j]) for j in range(3)] for i in range(3)]
        if k[0][1] != 0 or k[1][0] != 0 or k[2] != [0, 0, 1]:
            raise _native.UsageError("camera_matrix: has a skew or a last row that is not 0, 0, 1")
        coefficients = [float(v) for v in (distortion.ravel() if hasattr(distortion, "ravel") else distortion)]
        while len(coefficients) > 8 and coefficients[-1] == 0:
            coefficients.pop()
        if 5 < len(coefficients) < 8:
            coefficients += [0.0] * (8 - len(coefficients))
        r = [[float(rotation[i][j]) for j in range(3)] for i in range(3)] if rotation is not None else _identity
        t = [float(v) for v in (translation.ravel() if hasattr(translation, "ravel") else translation)]
        # World from camera: the transposed rotation, whose second and third column turn from OpenCV's axes to these.
        signs = (1.0, -1.0, -1.0)
        matrix = [
            [r[column][row] * signs[column] for column in range(3)] + [-sum(r[k][row] * t[k] for k in range(3))]
            for row in range(3)
        ]
        matrix.append([0.0, 0.0, 0.0, 1.0])
        intrinsics = (k[0][0], k[1][1], k[0][2], k[1][2])
        return cls(matrix, near=near, far=far, intrinsics=intrinsics, distortion=coefficients)

    def __repr__(self) -> str:
        x, y, z = (float(self.matrix[row][3]) for row in range(3))
        lens = f"{self.vertical_fov:.4g} degrees" if self.height is None else f"height {self.height:.4g}"
        if self.intrinsics is not None:
            lens = f"focal length {self.intrinsics[0]:.4g}, {self.intrinsics[1]:.4g} pixels"
        return f"<zoneplate.Camera at ({x:.4g}, {y:.4g}, {z:.4g}), {lens}>"


class Scene:
    """Meshes, materials, lights and cameras. The first rendering completes a scene: afterwards nothing can be added.

    `Scene()` is empty; `load` reads a file, `Scene.from_arrays` and `Scene.from_trimesh` take data in memory. Several
    threads may render one scene.
    """

    __slots__ = ("_native", "_meshes")

    def __init__(self) -> None:
        self._native = _native.Scene()
        self._meshes: list[str] = []

    @staticmethod
    def _of(native: _native.Scene) -> Scene:
        scene = Scene.__new__(Scene)
        scene._native = native
        scene._meshes = scene._native.names(_native.MESHES)
        return scene

    @classmethod
    def from_arrays(
        cls,
        positions: Any,
        indices: Any = None,
        *,
        normals: Any = None,
        uvs: Any = None,
        colors: Any = None,
        texture: Any = None,
        transform: Matrix | None = None,
        name: str = "mesh",
        topology: str = "triangles",
        flat: bool = False,
        **material: Any,
    ) -> Scene:
        """A scene of one mesh; see `add_mesh`. Further keywords are those of `add_material`."""
        scene = cls()
        scene.add_mesh(
            positions,
            indices,
            normals=normals,
            uvs=uvs,
            colors=colors,
            texture=texture,
            transform=transform,
            name=name,
            topology=topology,
            flat=flat,
            **material,
        )
        return scene

    @classmethod
    def from_trimesh(cls, source: Any) -> Scene:
        """A scene of a trimesh.Trimesh, PointCloud or Scene, an Open3D mesh, or any object with their attributes."""
        from ._adapters import add_object

        scene = cls()
        add_object(scene, source)
        return scene

    def add_texture(self, pixels: Any) -> int:
        """Adds an image for textures: height x width (x 3 or 4) of uint8 or uint16, or of float32 linear light."""
        return self._native.add_image(buffer_of(pixels))

    def add_material(
        self,
        *,
        name: str = "material",
        color: str | Floats | None = None,
        metallic: float | None = None,
        roughness: float | None = None,
        emissive: str | Floats | None = None,
        model: str = "metallic-roughness",
        specular: str | Floats | None = None,
        exponent: float | None = None,
        alpha_mode: str = "opaque",
        alpha_cutoff: float | None = None,
        double_sided: bool = False,
        texture: int | None = None,
        metallic_roughness_texture: int | None = None,
        normal_texture: int | None = None,
        occlusion_texture: int | None = None,
        emissive_texture: int | None = None,
    ) -> int:
        """Adds a material; returns its index. Colours: "#rrggbb", or linear numbers. Textures: see `add_texture`.

        `metallic` is 0 and `roughness` 0.5 by default. `model`: "metallic-roughness", "blinn-phong", "phong" or "unlit".
        `alpha_mode`: "opaque", "mask" or "blend".
        """
        return self._native.add_material(
            name=name,
            model=choose(MODELS, model, "model"),
            alpha_mode=choose(ALPHA_MODES, alpha_mode, "alpha_mode"),
            alpha_cutoff=alpha_cutoff,
            is_double_sided=double_sided,
            base_color=None if color is None else linear_color(color, 4),
            emissive=None if emissive is None else linear_color(emissive, 3),
            metallic=metallic,
            roughness=roughness,
            specular=None if specular is None else linear_color(specular, 3),
            exponent=exponent,
            base_color_texture=texture,
            metallic_roughness_texture=metallic_roughness_texture,
            normal_texture=normal_texture,
            occlusion_texture=occlusion_texture,
            emissive_texture=emissive_texture,
        )

    def add_mesh(
        self,
        positions: Any,
        indices: Any = None,
        *,
        normals: Any = None,
        uvs: Any = None,
        colors: Any = None,
        texture: Any = None,
        transform: Matrix | None = None,
        name: str = "mesh",
        topology: str = "triangles",
        flat: bool = False,
        material: int | None = None,
        instances: Iterable[Matrix | None] | None = None,
        **material_options: Any,
    ) -> int:
        """Adds a mesh and places it once, or by each transform of `instances`; returns the mesh's index.

        positions: n x 3; indices: m x 3 (lines: m x 2; points: m), without them every three positions are a triangle;
        normals: n x 3, by default smooth across edges that bend by less than 50 degrees (`flat`: one for each
        triangle); uvs: n x 2, (0, 0) is the top-left of the texture; colors: n x 3 or n x 4, uint8 sRGB codes or
        linear floats. Arrays are anything with the buffer protocol, of integers or floats in any layout, or lists.

        `texture` is an array or the index of one. With further keywords, those of `add_material`, the mesh gets a
        material of its own; without any, a scene that has no materials gets the grey one of STL files.
        """
        if texture is not None:
            material_options["texture"] = texture if isinstance(texture, int) else self.add_texture(texture)
        if material_options:
            if material is not None:
                raise _native.UsageError("add_mesh: `material` and keywords of a material exclude each other")
            if colors is not None:
                material_options.setdefault("color", (1.0, 1.0, 1.0))
            material = self.add_material(**material_options)
        optional = lambda values: None if values is None else buffer_of(values)
        index = self._native.add_mesh(
            name=name,
            topology=choose(TOPOLOGIES, topology, "topology"),
            positions=buffer_of(positions),
            normals=optional(normals),
            uvs=optional(uvs),
            colors=optional(colors),
            indices=optional(indices),
            material=material,
            has_flat_normals=flat,
        )
        self._meshes.append(name)
        for matrix in [transform] if instances is None else instances:
            self.add_instance(index, matrix)
        return index

    def add_instance(self, mesh: int, transform: Matrix | None = None, name: str | None = None) -> int:
        """Places a mesh a further time; returns the index of the object, its value in the data pass "object-id"."""
        return self._native.add_instance(mesh, None if transform is None else flat_matrix(transform), name)

    def add_light(
        self,
        kind: str = "directional",
        *,
        color: str | Floats | None = None,
        intensity: float | None = None,
        position: Floats | None = None,
        direction: Floats | None = None,
        range: float | None = None,
        inner_cone: float = 0.0,
        outer_cone: float = 45.0,
        radius: float = 0.0,
        in_camera_space: bool = False,
    ) -> None:
        """Adds a "directional", "point" or "spot" light, in lux or candela; cones in degrees from the axis.

        A scene without lights and environment gets the default light of the command.
        """
        self._native.add_light(
            kind=choose(LIGHTS, kind, "kind"),
            color=None if color is None else linear_color(color, 3),
            intensity=intensity,
            position=position,
            direction=direction,
            range=range,
            inner_cone=math.radians(inner_cone),
            outer_cone=math.radians(outer_cone),
            radius=radius,
            is_in_camera_space=in_camera_space,
        )

    def set_environment(self, light: Any, *, rotation: float = 0.0, strength: float = 1.0) -> None:
        """Sets the light from all directions: a colour, or an equirectangular image (height x width x 3 or 4)."""
        if isinstance(light, str) or (hasattr(light, "__len__") and len(light) == 3 and not hasattr(light[0], "__len__")):
            r, g, b = linear_color(light, 3)
            color, image = (strength * r, strength * g, strength * b), -1
        else:
            color, image = (strength, strength, strength), self.add_texture(light)
        self._native.set_environment(color, image, math.radians(rotation))

    def set_up(self, up: Floats) -> None:
        """Sets the upward axis, (0, 1, 0) by default, or (0, 0, 1) for STL files."""
        self._native.set_up(*up)

    @property
    def objects(self) -> list[str]:
        """The names of the objects, by their values in the data pass "object-id"."""
        return self._native.names(_native.OBJECTS)

    @property
    def materials(self) -> list[str]:
        """The names of the materials, by their values in the data pass "material-id"."""
        return self._native.names(_native.MATERIALS)

    @property
    def meshes(self) -> list[str]:
        """The names of the meshes."""
        return self._native.names(_native.MESHES)

    @property
    def cameras(self) -> list[str]:
        """The names of the file's cameras, by `View.index`."""
        return self._native.names(_native.CAMERAS)

    @property
    def animations(self) -> list[str]:
        """The names of the file's animations, by the `animation` of `load`."""
        return self._native.names(_native.ANIMATIONS)

    @property
    def variants(self) -> list[str]:
        """The names of the file's material variants."""
        return self._native.names(_native.VARIANTS)

    @property
    def warnings(self) -> list[str]:
        """What the loader ignored."""
        return self._native.names(_native.WARNINGS)

    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """The minimum and the maximum of all positions in world space."""
        return self._native.bounds()

    def camera(self, view: View | None = None, aspect: float = 4 / 3) -> Camera:
        """The camera of a view for images of the aspect ratio width / height."""
        found = self._native.camera(aspect, **(view or View())._members())
        m = found["world_from_camera"]
        return Camera(
            [m[0:4], m[4:8], m[8:12], m[12:16]],
            math.degrees(found["vertical_fov"]),
            height=2 * found["half_height"] if found["is_orthographic"] else None,
            near=found["near"],
            far=found["far"],
        )

    def render(self, camera: View | Camera | Matrix | None = None, **options: Any) -> Image:
        """The same as `zoneplate.render(scene, camera, ...)`."""
        from ._jobs import render

        return render(self, camera, **options)

    def _repr_png_(self) -> bytes:
        return self.render(size=(400, 300))._repr_png_()

    def __repr__(self) -> str:
        return f"<zoneplate.Scene: {len(self.meshes)} meshes, {len(self.objects)} objects, {len(self.materials)} materials>"


def load(
    path: str | os.PathLike[str],
    *,
    format: str | None = None,
    variant: str | None = None,
    scene: int | None = None,
    animation: int | str | None = None,
    time: float = 0.0,
    sandbox: bool = False,
    max_memory: int | None = None,
    max_seconds: float | None = None,
) -> Scene:
    """Loads a model (glTF, OBJ, PLY, STL and others) or a built-in scene: "chair.glb", "teapot".

    `animation`, an index or a name, and `time` pose an animated glTF file; -1 means all its animations. `sandbox` reads an untrusted file in a
    child process with limits.
    """
    return Scene._of(
        _native.Scene(
            os.fspath(path),
            format=format,
            variant=variant,
            scene=scene,
            animation=None if isinstance(animation, str) else animation,
            animation_name=animation if isinstance(animation, str) else None,
            time=time,
            is_sandboxed=sandbox,
            max_memory=max_memory,
            max_seconds=max_seconds,
        )
    )


def scene_of(source: Any) -> Scene:
    """A scene, the scene of a file, or that of an object in memory."""
    if isinstance(source, Scene):
        return source
    if isinstance(source, (str, os.PathLike)):
        return load(source)
    return Scene.from_trimesh(source)


def camera_of(scene: Scene, camera: Any, aspect: float) -> dict[str, Any] | None:
    """The members of zoneplate_camera; None for the default view."""
    if camera is None:
        return None
    if isinstance(camera, View):
        return scene._native.camera(aspect, **camera._members())
    return (camera if isinstance(camera, Camera) else Camera(camera))._members()

