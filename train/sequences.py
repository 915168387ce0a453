# SPDX-License-Identifier: Apache-2.0
"""Sequences of `zoneplate dataset --layout npy --ratio 2`, with what no history is needed for."""
import json
from pathlib import Path

import numpy as np
import torch

import mean

PLANES = ("color", "nearness", "motion", "follow", "low", "high", "nearest", "farthest", "alike", "borrowed",
          "uncovered", "steady")


def stack(folder, count):
    return np.stack([np.load(folder / f"{i:04}.npy") for i in range(count)])


def nearness_of(depth, camera):
    """Reversed depth: 1 at the near plane, 0 at the far plane and where nothing is."""
    near, far = camera["Near"], camera["Far"]
    with np.errstate(invalid="ignore"):
        out = ((far - depth) if "HalfHeight" in camera else near * (far - depth) / np.maximum(depth, 1e-6)) / (far - near)
    return np.where(np.isfinite(depth), out, 0).clip(0, 1).astype(np.float32)


def planar(array):
    return torch.from_numpy(np.ascontiguousarray(array.transpose(0, 3, 1, 2)))


def load(folder, name):
    """A sequence: planes of all frames by name, and `truth` and `sample`."""
    folder = Path(folder)
    info = json.loads((folder / f"{name}.json").read_text())
    count, low = len(info["Frames"]), folder / "x2"
    color = planar(stack(low / "color" / name, count)).clamp(0, 65504)
    depth = stack(low / "depth" / name, count)
    nearness = np.stack([nearness_of(d, c) for d, c in zip(depth, info["Frames"])])
    motion = planar(stack(low / "motion" / name, count))
    sample = torch.tensor([[0.5 + v for v in f["Jitter"]] for f in info["Frames"]])
    out = {"truth": planar(stack(folder / "ground_truth" / name, count)), "color": color, "sample": sample,
           "nearness": torch.from_numpy(nearness)[:, None], "motion": motion}
    rows = []
    for t in range(count):
        now = mean.survey(color[t:t + 1], out["nearness"][t:t + 1], motion[t:t + 1])
        zero = torch.zeros_like(now["alike"])
        now["uncovered"], now["steady"] = zero, zero
        if t > 0:
            now["uncovered"], now["steady"] = mean.came_from(now, out["nearness"][t:t + 1], motion[t:t + 1],
                                                             rows[-1]["alike"], sample[t])
        rows.append(now)
    for key in rows[0]:
        out[key] = torch.cat([row[key] for row in rows])
    return out


def frame_of(sequence, t):
    """Frame t as a batch of one."""
    out = {key: sequence[key][t:t + 1] for key in PLANES}
    out["sample"] = sequence["sample"][t:t + 1]
    return out


def names_in(folder):
    """The complete sequences, in order."""
    return sorted(p.stem for p in Path(folder).glob("[0-9]*.json"))
