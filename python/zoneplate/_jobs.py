# SPDX-License-Identifier: Apache-2.0
"""Renderings by the options of the command."""

from __future__ import annotations

import os

from . import _native
from ._images import Image
from ._scenes import View, camera_of, choose, scene_of

FORMS = {"uint8": 0, "uint16": 1, "float32": 2}

# Names of keywords that Python or the functions' own arguments take, and those of the rows.
ALIASES = {"scene_index": "scene"}


def text_of(value):
    """A value as on the command line: "a,b" of a sequence."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if hasattr(value, "__iter__"):
        return ",".join(text_of(part) for part in value)
    return repr(int(value) if hasattr(value, "__index__") else float(value))


def pairs_of(options):
    """The rows of keywords. None, and False for a switch, leave an option out; `quality` comes first, since it sets
    several options, which others change."""
    rows = {row[0] for row in _native.options()}
    out = []
    for name, value in sorted(options.items(), key=lambda item: item[0] != "quality"):
        row = ALIASES.get(name, name.replace("_", "-"))
        if row not in rows:
            raise unknown(name, rows)
        if value is not None and value is not False:
            out.append((row, None if value is True else text_of(value)))
    return out


def unknown(name, rows):
    """The error about a keyword that is no option."""
    from difflib import get_close_matches

    near = get_close_matches(name, [row.replace("-", "_") for row in rows], 1)
    return TypeError(f"there is no option {name!r}" + (f"; did you mean {near[0]!r}?" if near else ""))


def pairs_of_view(view):
    """The rows of a view, for sequences and files."""
    if view is None:
        return []
    if not isinstance(view, View):
        raise _native.UsageError("camera: frames and files are seen by a View")
    return pairs_of(
        {
            "camera_index": view.index,
            "camera_position": view.position,
            "camera_focal_point": view.focal_point,
            "camera_view_up": view.view_up,
            "camera_view_angle": view.vertical_fov,
            "camera_azimuth_angle": view.azimuth,
            "camera_elevation_angle": view.elevation,
            "camera_orthographic": bool(view.orthographic),
        }
    )


def rows_of(
    size=None,
    aa=None,
    aovs=(),
    crop=None,
    threads=0,
    background=None,
    transparent=False,
    environment=None,
    ambient_occlusion=None,
    shadow_ground=False,
    anisotropy=0,
    cull_back_faces=True,
    point_size=0,
    exposure=None,
    **options,
):
    """The rows of the keywords of `render`: those that are named here are shorter or typed."""
    aovs = aovs if isinstance(aovs, str) else ",".join(aovs)
    if environment is not None and not isinstance(environment, str):
        environment = "linear:" + text_of(environment)
    if isinstance(ambient_occlusion, int):
        ambient_occlusion = f"rays:samples={ambient_occlusion}" if ambient_occlusion > 0 else None
    if shadow_ground:
        options["ground"] = "shadow"
    own = {
        "resolution": size,
        "anti_aliasing": aa,
        "aov": aovs or None,
        "crop": crop,
        "threads": threads or None,
        "background_color": background,
        "no_background": bool(transparent),
        "environment": environment,
        "ambient_occlusion": ambient_occlusion,
        "anisotropy": anisotropy or None,
        "no_cull": not cull_back_faces,
        "point_size": point_size or None,
        "exposure": None if exposure == 0 else exposure,
    }
    return pairs_of({**options, **{name: value for name, value in own.items() if value is not None}})


def model_of(scene, rows):
    """A scene, that of a file by the rows of reading, or that of an object in memory."""
    if isinstance(scene, (str, os.PathLike)):
        from ._scenes import Scene

        return Scene._of(_native.load_by_job(os.fspath(scene), rows))
    return scene_of(scene)


def render(scene, camera=None, size=(800, 600), *, dtype="uint8", **options):
    """Renders an image of a scene: a Scene, the path of a model, or a trimesh object.

    camera       a View, a Camera, a 4 x 4 pose, or None: the default view of the command
    size         width and height in pixels
    aa           the antialiasing method with its parameters, such as "smaa", "ssaa:n=4" or "none" (see `methods`)
    aovs         data passes, such as "depth", "normal" or "object-id" (see `aovs`), as further arrays of the image
    dtype        "uint8" and "uint16": sRGB codes with straight alpha; "float32": linear light, premultiplied
    crop         x, y, width, height: the rectangle of the image that is rendered
    threads      0: as many as the process may use
    background   "#rrggbb", or sRGB numbers in [0, 1]; "environment": the light's image; `transparent`: none
    environment  a colour whose light from all directions replaces the default light; numbers are linear
    ambient_occlusion  rays from each fragment, or "rays:samples=64,distance=2"
    shadow_ground  a ground that is visible only where it is in shadow
    cull_back_faces  False: back faces of single-sided materials are drawn

    Every other option of the command that describes a rendering is a keyword, with underscores for dashes: see
    `options`. Such as shadows="soft:samples=64", hdri_file="sky.hdr", exposure="auto", quality="best", tone_mapping="agx".
    True sets a switch, a sequence is a list of numbers, angles are in degrees, None is the default.

    Other Python threads run while an image is rendered.
    """
    width, height = int(size[0]), int(size[1])
    rows = rows_of(size=(width, height), **options)
    source = model_of(scene, rows)
    members = camera_of(source, camera, width / height if height > 0 else 1.0)
    return Image(_native.render_by_job(source._native, members, choose(FORMS, str(dtype), "dtype"), rows))


class Frames:
    """The images of a sequence, rendered one at a time."""

    __slots__ = ("_native",)

    def __init__(self, native):
        self._native = native

    def __len__(self):
        return len(self._native)

    def __iter__(self):
        return self

    def __next__(self):
        return Image(next(self._native))


def render_frames(scene, camera=None, size=(800, 600), *, dtype="uint8", **options):
    """Renders a sequence: an iterator of its images, by the options `turntable`, `frames`, `frame_start`, `frame_end`,
    `frame_rate` and `shutter`, and those of `render`. The camera is a View. Its length is the number of frames."""
    rows = rows_of(size=tuple(size), **options) + pairs_of_view(camera)
    source = model_of(scene, rows)
    return Frames(_native.frames_by_job(source._native, choose(FORMS, str(dtype), "dtype"), rows))


def render_file(scene, path, camera=None, size=(800, 600), **options):
    """Renders a scene and writes the files of the command `zoneplate render SCENE -o PATH`, with the same bytes: an image
    with its data passes, numbered frames as "chair.####.png", or a film such as "chair.webp" or "chair.mp4" (by ffmpeg).

    The options are those of `render` and `render_frames`, and in addition those of files, such as jpeg_quality=80."""
    rows = rows_of(size=tuple(size), **options) + pairs_of_view(camera)
    _native.save_by_job(model_of(scene, rows)._native, os.fspath(path), rows)


def options():
    """The options of the command that `render` and the other functions take as keywords, with a sentence about each."""
    names = {row: name for name, row in ALIASES.items()}
    return {names.get(row[0], row[0].replace("-", "_")): row[7] for row in _native.options()}
