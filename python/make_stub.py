#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints zoneplate/_jobs.pyi: the types of the functions whose keywords are the rows of the table of options.

    PYTHONPATH=build/release/python/installed python3 -P python/make_stub.py > python/zoneplate/_jobs.pyi

The module is the one that is installed (-P): this folder has none.
"""

from zoneplate import _native
from zoneplate._jobs import ALIASES

HEAD = '''# SPDX-License-Identifier: Apache-2.0
# Made by python/make_stub.py from the table of options.
import os
from typing import Any, Iterable, Literal, Sequence

import numpy as np

from ._images import Image
from ._native import Rows
from ._scenes import Camera, Scene, View

Floats = Sequence[float]
Matrix = Sequence[Sequence[float]] | np.ndarray
Source = Scene | str | os.PathLike[str] | Any

ALIASES: dict[str, str]

def pairs_of(options: dict[str, Any]) -> Rows: ...
def options() -> dict[str, str]: ...

class Frames:
    def __len__(self) -> int: ...
    def __iter__(self) -> Frames: ...
    def __next__(self) -> Image: ...
'''

# The keywords of `render` that are shorter than a row, or typed otherwise, and the rows whose names they take.
OWN = {
    "aa": "str | None = None",
    "aovs": "str | Iterable[str] = ()",
    "crop": "tuple[int, int, int, int] | None = None",
    "threads": "int = 0",
    "background": "str | Floats | None = None",
    "transparent": "bool = False",
    "environment": "str | Floats | None = None",
    "ambient_occlusion": "str | int | None = None",
    "shadow_ground": "bool = False",
    "anisotropy": "int = 0",
    "cull_back_faces": "bool = True",
    "point_size": "float = 0.0",
    "exposure": 'float | Literal["auto"] | str = 0.0',
}
REPLACED = {"anti_aliasing", "aov", "background_color", "no_background", "no_cull", "resolution"}
FILES = {"jpeg_quality", "webp_quality", "png_compression", "exr_compression"}
FRAMES = "Sequences"
SWITCH, NUMBER, WHOLE, CHOICE, TEXT = range(5)


def type_of(value, kind, choices):
    if kind == SWITCH:
        return "bool = False"
    if kind == CHOICE:
        if choices.replace(",", "").isdigit():
            return "int | None = None"
        return f"Literal[{', '.join(repr(name) for name in choices.split(','))}] | None = None".replace("'", '"')
    if kind == TEXT:
        return ("str | Floats | None" if "," in value else "str | float | None") + " = None"
    return ("int" if kind == WHOLE else "float") + " | None = None"


def keywords(has_frames, has_files):
    names = {row: name for name, row in ALIASES.items()}
    out = [f"    {name}: {kind},\n" for name, kind in OWN.items()]
    for row, value, kind, _, _, choices, group, _ in _native.options():
        name = names.get(row, row.replace("-", "_"))
        if name in OWN or name in REPLACED or (group == FRAMES and not has_frames) or (name in FILES and not has_files):
            continue
        out.append(f"    {name}: {type_of(value, kind, choices)},\n")
    return "".join(out)


def stub():
    def function(name, first, has_camera, form, result, has_frames, has_files):
        camera = "View | Camera | Matrix | None" if has_camera else "View | None"
        return (
            f"\ndef {name}(\n    scene: Source,\n{first}    camera: {camera} = None,\n"
            f"    size: tuple[int, int] = (800, 600),\n    *,\n{form}{keywords(has_frames, has_files)}) -> {result}: ...\n"
        )

    form = '    dtype: str = "uint8",\n'
    return (
        HEAD
        + function("render", "", True, form, "Image", False, False)
        + function("render_frames", "", False, form, "Frames", True, False)
        + function("render_file", "    path: str | os.PathLike[str],\n", False, "", "None", True, True)
    )


if __name__ == "__main__":
    print(stub(), end="")
