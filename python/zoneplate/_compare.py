# SPDX-License-Identifier: Apache-2.0
"""Comparison of antialiasing methods with a reference, for notebooks."""

from __future__ import annotations


from ._images import Image, measure, png_of
from ._jobs import render
from ._scenes import scene_of

TYPE_CHECKING = False  # type checkers take it as true; to import typing takes milliseconds
if TYPE_CHECKING:
    from typing import Any, Iterable

    import numpy as np

FACTOR = 8  #: by which crops are enlarged: to the size of the image


class Comparison:
    """Images of one scene by several methods, measured against a reference.

    A notebook shows the images, a crop where the methods differ most from the reference, and the measurements.
    """

    def __init__(self, reference: Image, images: dict[str, Image], metrics: tuple[str, ...]):
        self.reference = reference
        self.images = images  #: by method
        measured = {name: {m: measure(reference, image, m) for m in metrics} for name, image in images.items()}
        self.values = {name: {m: float(v) for m, v in row.items()} for name, row in measured.items()}
        maps = [v.map for row in measured.values() for v in row.values() if v.map is not None]
        self.crop = worst_crop(maps, reference.size)  #: x, y, width, height

    def _crop_of(self, image: Image) -> np.ndarray:
        x, y, width, height = self.crop
        return image.color[y : y + height, x : x + width].repeat(FACTOR, axis=0).repeat(FACTOR, axis=1)

    def _repr_png_(self) -> bytes:
        """The reference and the images in a row, above their crops, enlarged by 8."""
        import numpy as np

        columns = []
        for image in (self.reference, *self.images.values()):
            color, crop = image.color, self._crop_of(image)
            width = max(color.shape[1], crop.shape[1])
            column = np.zeros((color.shape[0] + 8 + crop.shape[0], width + 8, 4), color.dtype)
            column[: color.shape[0], : color.shape[1]] = color
            column[color.shape[0] + 8 :, : crop.shape[1]] = crop
            columns.append(column)
        return png_of(np.concatenate(columns, axis=1)[:, :-8])

    def _repr_html_(self) -> str:
        from base64 import b64encode
        from html import escape

        picture = lambda pixels: f'<img src="data:image/png;base64,{b64encode(png_of(pixels)).decode()}">'
        cells: list[tuple[str, Image, dict[str, float]]] = [("reference", self.reference, {})]
        cells += [(name, image, self.values[name]) for name, image in self.images.items()]
        rows = [
            "".join(f"<th>{escape(name)}</th>" for name, _, _ in cells),
            "".join(f"<td>{picture(image.color)}</td>" for _, image, _ in cells),
            "".join(f"<td>{picture(self._crop_of(image))}</td>" for _, image, _ in cells),
            "".join(
                "<td>" + "<br>".join(f"{escape(m)} {v:.4g}" for m, v in values.items()) + "</td>" for _, _, values in cells
            ),
        ]
        return "<table>" + "".join(f"<tr>{row}</tr>" for row in rows) + "</table>"

    def __repr__(self) -> str:
        names = list(next(iter(self.values.values()), {}))
        width = max([len("method"), *map(len, self.values)])
        lines = ["  ".join(["method".ljust(width), *(m.rjust(10) for m in names)])]
        for method, row in self.values.items():
            lines.append("  ".join([method.ljust(width), *(f"{row[m]:10.4g}" for m in names)]))
        return "\n".join(lines)


def worst_crop(maps: list[np.ndarray], size: tuple[int, int]) -> tuple[int, int, int, int]:
    """The rectangle with the greatest sum of all maps, an eighth of the image along each side; without maps the top-left
    one."""
    import numpy as np

    width, height = max(1, size[0] // FACTOR), max(1, size[1] // FACTOR)
    if not maps:
        return 0, 0, width, height
    total = np.zeros((size[1] + 1, size[0] + 1))
    total[1:, 1:] = np.sum(maps, axis=0, dtype=np.float64).cumsum(axis=0).cumsum(axis=1)
    sums = total[height:, width:] - total[:-height, width:] - total[height:, :-width] + total[:-height, :-width]
    y, x = np.unravel_index(np.argmax(sums), sums.shape)
    return int(x), int(y), width, height


def compare(
    scene: Any,
    aa: Iterable[str] = ("none", "fxaa", "smaa", "msaa:n=8"),
    *,
    camera: Any = None,
    size: tuple[int, int] = (400, 300),
    reference: str = "converged",
    metrics: Iterable[str] = ("flip", "psnr"),
    **options: Any,
) -> Comparison:
    """Renders a scene by several antialiasing methods and measures each against a reference method.

    `options` are those of `render`.
    """
    source = scene_of(scene)
    draw = lambda method: render(source, camera, size, aa=method, **options)
    return Comparison(draw(reference), {method: draw(method) for method in aa}, tuple(metrics))
