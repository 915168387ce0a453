# SPDX-License-Identifier: Apache-2.0
"""Images, metrics, filters and spectra."""

from __future__ import annotations

import os

from . import _native

TYPE_CHECKING = False  # type checkers take it as true; to import typing takes milliseconds
if TYPE_CHECKING:
    from typing import Any, Union

    import numpy as np

    Pixels = Union[np.ndarray, "Image", Any]


def buffer_of(values: Any) -> Any:
    """The object itself where it has the buffer protocol, else a NumPy array of it (lists, PIL images, tensors)."""
    if isinstance(values, Image):
        return values.array("color")
    try:
        memoryview(values)
        return values
    except (TypeError, BufferError):
        import numpy as np

        return np.asarray(values)


def shape_of(values: Any) -> tuple[int, ...]:
    """The shape of a buffer."""
    return memoryview(values).shape or ()


def plane_of(values: Any) -> Any:
    """The values as float32."""
    import numpy as np

    return np.ascontiguousarray(np.asarray(values), dtype=np.float32)


class Image:
    """A rendered image: "color" and data passes, as NumPy arrays that share its memory.

    An array keeps the memory alive. `numpy.asarray(image)` is "color"; `image.array(name)` is the buffer itself, which
    has the buffer protocol and `__dlpack__`, for libraries other than NumPy.
    """

    __slots__ = ("_native",)

    def __init__(self, pixels: Pixels | _native.Image):
        """A copy of an array of height x width (x 1, 3 or 4): uint8 or uint16 sRGB codes, or float32 linear light."""
        self._native = pixels if isinstance(pixels, _native.Image) else _native.image_new(buffer_of(pixels))

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the arrays: "color" and those of the data passes."""
        return self._native.names

    def array(self, name: str = "color") -> _native.Array:
        """The array of that name as an object with the buffer protocol and DLPack."""
        return self._native.array(name)

    def __getitem__(self, name: str) -> np.ndarray:
        """The array of that name, without a copy."""
        import numpy as np

        return np.asarray(self._native.array(name))

    def __contains__(self, name: str) -> bool:
        return name in self._native.names

    @property
    def color(self) -> np.ndarray:
        """height x width x 4: red, green, blue and alpha."""
        return self["color"]

    @property
    def rgb(self) -> np.ndarray:
        """height x width x 3: a view of `color` without alpha."""
        return self["color"][..., :3]

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        height, width = self._native.array(self._native.names[0]).shape[:2]
        return width, height

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        color = self.color
        if dtype is not None and color.dtype != dtype:
            return color.astype(dtype)
        return color.copy() if copy else color

    def __dlpack__(self, **keywords: Any) -> object:
        return self._native.array("color").__dlpack__(**keywords)

    def __dlpack_device__(self) -> tuple[int, int]:
        return self._native.array("color").__dlpack_device__()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes "color" by the extension: .png, .jpg, .webp, .avif, .jxl; float32: .exr, .pfm; whole or not at all."""
        self._native.save(os.fspath(path))

    def encode(self, format: str = "png") -> bytes:
        """ "color" as the bytes of a file: "png", "jpg", "webp", "avif", "jxl"; float32: "exr", "pfm"."""
        return self._native.encode(format)

    def _repr_png_(self) -> bytes:
        return self.encode() if self.array().format != "f" else png_of(self.color)

    def __repr__(self) -> str:
        width, height = self.size
        return f"<zoneplate.Image {width} x {height}: {', '.join(self.names)}>"


def load_image(path: str | os.PathLike[str]) -> Image:
    """Reads a PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, BMP, TGA, HDR, EXR or PFM file. The last three, and TIFF of
    floats, are linear light (float32); of an animation the first frame is read.

    Colour profiles are converted to sRGB, light to Rec.709 primaries; the image is turned as its Exif data says.
    """
    return Image(_native.image_load(os.fspath(path)))


def codes_of(linear: np.ndarray) -> np.ndarray:
    """Linear light as uint8 sRGB codes, clamped; alpha stays linear."""
    import numpy as np

    x = np.clip(np.nan_to_num(np.asarray(linear, dtype=np.float32)), 0, 1)
    codes = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    if x.ndim == 3 and x.shape[2] == 4:
        codes[..., 3] = x[..., 3]
    return np.floor(255 * codes + 0.5).astype(np.uint8)


def png_of(pixels: np.ndarray) -> bytes:
    """A PNG of an array: integers are sRGB codes, floats linear light."""
    import numpy as np

    codes = pixels if pixels.dtype in (np.uint8, np.uint16) else codes_of(pixels)
    return _native.image_new(np.ascontiguousarray(codes)).encode("png")


class Measurement:
    """The result of a metric. `float(measurement)` is its value."""

    __slots__ = ("metric", "value", "figures", "map")

    def __init__(self, metric: str, value: float, figures: dict[str, float], map: np.ndarray | None):
        self.metric = metric
        self.value = value
        self.figures = figures  #: other values of the metric, by name
        self.map = map  #: height x width, 0 (no error) to 1; None if the metric has no map

    def __float__(self) -> float:
        return self.value

    def __repr__(self) -> str:
        return f"{self.metric} {self.value:.6g}"

    def _repr_png_(self) -> bytes | None:
        return None if self.map is None else png_of(self.map)


def measure(reference: Pixels, test: Pixels, metric: str = "flip") -> Measurement:
    """Measures the difference of two images by a metric, such as "psnr", "ssim" or "flip:ppd=30" (see `metrics`).

    Integer arrays are sRGB codes, float32 arrays linear light.
    """
    value, map_image, figure_image = _native.measure(buffer_of(reference), buffer_of(test), metric)
    figures = {name: float(Image(figure_image)[name][0]) for name in figure_image.names}
    return Measurement(metric, value, figures, Image(map_image)["map"] if map_image.names else None)


def filter(pixels: Pixels, aa: str = "smaa") -> np.ndarray:
    """Antialiases an existing image by a post-process filter, such as "smaa" or "fxaa:preset=39".

    The result has the type and the number of channels of `pixels` (uint8 or uint16 sRGB codes).
    """
    source = buffer_of(pixels)
    result = Image(_native.filter(source, aa)).color
    shape = shape_of(source)
    return result[..., 0] if len(shape) == 2 else result[..., : shape[2]]


def resample(pixels: Pixels, size: tuple[int, int], kernel: str = "lanczos3") -> np.ndarray:
    """Resamples an image to a size (width, height). sRGB codes are filtered in linear light, with premultiplied alpha."""
    source = buffer_of(pixels)
    result = Image(_native.resample(source, int(size[0]), int(size[1]), kernel)).color
    shape = shape_of(source)
    if result.ndim == len(shape):
        return result[..., : shape[2]] if len(shape) == 3 else result
    return result[..., 0]


def frequency_filter(
    pixels: Pixels, kind: str = "low", *, low: float = 0.0, high: float = 0.0, shape: str = "gaussian"
) -> np.ndarray:
    """Filters the frequencies of an image, as float32; the image counts as one period.

    `kind`: "low" keeps what is below `high`, "high" what is above `low`; "band" keeps what is between both, "stop"
    removes it. Cut-off frequencies are in cycles per pixel: 0.5 is the Nyquist frequency. `shape`: "ideal", "gaussian"
    or "butterworth:order=2".
    """
    return Image(_native.frequency_filter(plane_of(pixels), kind, low, high, shape)).color


class Spectrum:
    """The Fourier transform of a plane, with frequency 0 in the middle."""

    __slots__ = ("magnitude", "phase", "frequency", "power")

    def __init__(self, image: Image):
        self.magnitude = image["magnitude"]  #: height x width: log magnitude, 1 at the maximum, 0 at -120 dB
        self.phase = image["phase"]  #: height x width, in radians
        self.frequency = image["frequency"]  #: the middle of each ring of radial frequency, in cycles per pixel
        self.power = image["power"]  #: the mean power in each ring

    def _repr_png_(self) -> bytes:
        import numpy as np

        return png_of(np.floor(255 * self.magnitude + 0.5).astype(np.uint8))


def spectrum(plane: Any) -> Spectrum:
    """The spectrum of an array of height x width, or of the luma of an image of height x width x channels."""
    import numpy as np

    values = np.asarray(plane)
    scale = np.float32(np.iinfo(values.dtype).max) if values.dtype.kind in "iu" else np.float32(1)
    values = values.astype(np.float32) / scale
    if values.ndim == 3:
        values = values[..., :3] @ np.array([0.2126, 0.7152, 0.0722], np.float32) if values.shape[2] >= 3 else values[..., 0]
    return Spectrum(Image(_native.spectrum(np.ascontiguousarray(values))))
