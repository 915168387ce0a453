# SPDX-License-Identifier: Apache-2.0
"""The catalogues: names with a line about each."""

from __future__ import annotations

from . import _native


def methods() -> dict[str, str]:
    """The antialiasing methods, values of `aa`."""
    return _native.list(0)


def metrics() -> dict[str, str]:
    """The metrics of `measure`."""
    return _native.list(1)


def scenes() -> dict[str, str]:
    """The built-in scenes, which `load` makes by their names."""
    return _native.list(2)


def aovs() -> dict[str, str]:
    """The data passes, values of `aovs`."""
    return _native.list(3)


def kernels() -> dict[str, str]:
    """The kernels of `resample`."""
    return _native.list(4)
