# SPDX-License-Identifier: Apache-2.0
"""Zoneplate renders 3D models to antialiased images on the CPU.

    import zoneplate

    image = zoneplate.render("chair.glb", size=(800, 600), aa="smaa", aovs=["depth"])
    image.save("chair.png")
    color, depth = image.color, image["depth"]    # NumPy arrays that share the image's memory

An image has the same bits for any number of threads, on every processor, and the bytes of the command `zoneplate`.
Angles are in degrees. Matrices are 4 x 4, row by row, and act on column vectors. World space is right-handed with +y up.
"""

from ._images import Image, filter, frequency_filter, load_image, measure, Measurement, resample, spectrum, Spectrum
from ._native import Array, Error, InputError, OutputError, UsageError, __version__
from ._jobs import Frames, options, render, render_file, render_frames
from ._scenes import Camera, Scene, View, load
from ._compare import Comparison, compare
from ._lists import aovs, kernels, methods, metrics, scenes
from .pyrender import OffscreenRenderer

__all__ = [
    "Array",
    "Camera",
    "Comparison",
    "Error",
    "Frames",
    "Image",
    "InputError",
    "Measurement",
    "OffscreenRenderer",
    "OutputError",
    "Scene",
    "Spectrum",
    "UsageError",
    "View",
    "aovs",
    "compare",
    "filter",
    "frequency_filter",
    "kernels",
    "load",
    "load_image",
    "measure",
    "methods",
    "metrics",
    "options",
    "render",
    "render_file",
    "render_frames",
    "resample",
    "scenes",
    "spectrum",
]
