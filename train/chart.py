# SPDX-License-Identifier: Apache-2.0
"""A curve as a PNG image."""
import numpy as np

from gltf import png


def write(path, values, width=480, height=240):
    """The values from left to right, the least at the bottom; grey lines are whole numbers."""
    image = np.full((height, width, 3), 255, np.uint8)
    low, high = min(values) - 0.1, max(values) + 0.1
    row = lambda v: int(round((high - v) / (high - low) * (height - 1)))
    for line in range(int(np.ceil(low)), int(np.floor(high)) + 1):
        image[row(line)] = 200
    place = np.interp(np.linspace(0, max(len(values) - 1, 1), width), range(len(values)), values)
    for x in range(1, width):
        top, bottom = sorted((row(place[x - 1]), row(place[x])))
        image[top:bottom + 1, x] = (180, 30, 30)
    path.write_bytes(png(image))
