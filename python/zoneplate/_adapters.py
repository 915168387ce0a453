# SPDX-License-Identifier: Apache-2.0
"""Objects of other libraries as meshes, by their attributes: none of those libraries is imported."""

from __future__ import annotations


from . import _native

TYPE_CHECKING = False  # type checkers take it as true; to import typing takes milliseconds
if TYPE_CHECKING:
    from typing import Any

    from ._scenes import Scene


def add_object(scene: Scene, source: Any, transform: Any = None, name: str = "mesh") -> None:
    """Adds a trimesh.Scene, Trimesh or PointCloud, or an Open3D mesh or point cloud."""
    if hasattr(source, "geometry") and hasattr(source, "graph"):
        add_trimesh_scene(scene, source)
    elif hasattr(source, "vertices") and (hasattr(source, "faces") or hasattr(source, "triangles")):
        scene.add_mesh(transform=transform, name=name, **mesh_of(scene, source))
    elif hasattr(source, "vertices") or hasattr(source, "points"):
        colors = array_of(getattr(source, "colors", None))
        positions = array_of(source.vertices if hasattr(source, "vertices") else source.points)
        scene.add_mesh(positions, colors=colors, topology="points", transform=transform, name=name)
    else:
        raise _native.UsageError(
            f"{type(source).__name__} is not a scene: expected a Scene, a path, or an object with vertices and faces"
        )


def array_of(values: Any) -> Any:
    """A NumPy array, or None where there are no values."""
    import numpy as np

    if values is None:
        return None
    array = np.asarray(values)
    return array if array.size > 0 else None


def add_trimesh_scene(scene: Scene, source: Any) -> None:
    indices: dict[str, int] = {}
    for node in source.graph.nodes_geometry:
        transform, key = source.graph[node]
        mesh = source.geometry[key]
        if key in indices:
            scene.add_instance(indices[key], transform, str(node))
        else:
            add_object(scene, mesh, transform, str(node))
            indices[key] = len(scene._meshes) - 1


def mesh_of(scene: Scene, source: Any) -> dict[str, Any]:
    """The arguments of Scene.add_mesh."""
    positions = array_of(source.vertices)
    faces = array_of(source.faces if hasattr(source, "faces") else source.triangles)
    if positions is None or faces is None:
        raise _native.UsageError(f"{type(source).__name__}: has no triangles")
    visual = getattr(source, "visual", None)
    kind = getattr(visual, "kind", None)
    if kind == "face":  # every triangle gets vertices of its own
        colors = array_of(visual.face_colors)
        return {"positions": positions[faces].reshape(-1, 3), "colors": colors.repeat(3, axis=0), "flat": True, **matte(colors)}
    if kind == "vertex":
        colors = array_of(visual.vertex_colors)
        return {"positions": positions, "indices": faces, "colors": colors, **matte(colors)}
    if kind == "texture":
        return {"positions": positions, "indices": faces, **textured(scene, visual)}
    return {"positions": positions, "indices": faces, "colors": array_of(getattr(source, "vertex_colors", None))}


def matte(colors: Any) -> dict[str, Any]:
    has_alpha = colors.shape[1] == 4 and bool((colors[:, 3] < 255).any())
    return {"double_sided": True, "roughness": 1.0, "alpha_mode": "blend" if has_alpha else "opaque"}


def factor(value: Any) -> tuple[float, ...] | None:
    """A colour factor of trimesh: integers are 8-bit numbers."""
    import numpy as np

    if value is None:
        return None
    array = np.asarray(value)
    return tuple(float(x) for x in (array / 255 if array.dtype.kind in "iu" else array))


def textured(scene: Scene, visual: Any) -> dict[str, Any]:
    """Coordinates and material of trimesh.visual.TextureVisuals, whose v grows upwards."""
    import numpy as np

    uv = array_of(visual.uv)
    arguments: dict[str, Any] = {"uvs": None if uv is None else np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1)}
    material = visual.material
    texture = lambda image: None if image is None or uv is None else scene.add_texture(pixels_of(image))
    color = getattr(material, "baseColorFactor", None)
    if hasattr(material, "diffuse"):  # SimpleMaterial
        arguments.update(color=factor(material.diffuse), texture=texture(material.image), roughness=1.0, double_sided=True)
    else:
        arguments.update(
            color=factor(color),
            metallic=getattr(material, "metallicFactor", None),
            roughness=getattr(material, "roughnessFactor", None),
            emissive=factor(getattr(material, "emissiveFactor", None)),
            texture=texture(getattr(material, "baseColorTexture", None)),
            metallic_roughness_texture=texture(getattr(material, "metallicRoughnessTexture", None)),
            normal_texture=texture(getattr(material, "normalTexture", None)),
            occlusion_texture=texture(getattr(material, "occlusionTexture", None)),
            emissive_texture=texture(getattr(material, "emissiveTexture", None)),
            alpha_mode=(getattr(material, "alphaMode", None) or "OPAQUE").lower(),
            alpha_cutoff=getattr(material, "alphaCutoff", None),
            double_sided=bool(getattr(material, "doubleSided", False)),
        )
    if arguments["texture"] is None:
        del arguments["texture"]
    return arguments


def pixels_of(image: Any) -> Any:
    """The pixels of an array or of a PIL image."""
    import numpy as np

    if hasattr(image, "convert"):
        image = image.convert("RGBA" if image.mode in ("RGBA", "LA", "PA", "P") else "RGB")
    return np.ascontiguousarray(image)
