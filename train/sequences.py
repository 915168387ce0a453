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


def read(folder, name):
    """What a sequence's files contain, in the order of the frames."""
    folder = Path(folder)
    info = json.loads((folder / f"{name}.json").read_text())
    count, low = len(info["Frames"]), folder / "x2"
    depth = stack(low / "depth" / name, count)
    nearness = np.stack([nearness_of(d, c) for d, c in zip(depth, info["Frames"])])
    return {"truth": planar(stack(folder / "ground_truth" / name, count)),
            "color": planar(stack(low / "color" / name, count)).clamp(0, 65504),
            "nearness": torch.from_numpy(nearness)[:, None], "motion": planar(stack(low / "motion" / name, count)),
            "sample": torch.tensor([[0.5 + v for v in f["Jitter"]] for f in info["Frames"]])}


def load(folder, name, device="cpu"):
    """A sequence: planes of all frames by name, and `truth` and `sample`."""
    out = {key: plane.to(device) for key, plane in read(folder, name).items()}
    out.update(mean.survey(out["color"], out["nearness"], out["motion"]))
    later = {key: plane[1:] for key, plane in out.items()}
    uncovered, steady = mean.came_from(later, later["nearness"], later["motion"], out["alike"][:-1], later["sample"])
    zero = torch.zeros_like(out["alike"][:1])
    out["uncovered"], out["steady"] = torch.cat([zero, uncovered]), torch.cat([zero, steady])
    return out


def load_all(folder, names, device="cpu"):
    """Sequences of one size and length: planes by name, whose first two dimensions are sequences and frames."""
    out = {}
    for number, name in enumerate(names):
        for key, plane in load(folder, name, device).items():
            if key not in out:
                out[key] = torch.empty((len(names), *plane.shape), device=device)
            out[key][number] = plane
    return out


def frame_of(sequence, t):
    """Frame t as a batch of one."""
    out = {key: sequence[key][t:t + 1] for key in PLANES}
    out["sample"] = sequence["sample"][t:t + 1]
    return out


def names_in(folder):
    """The complete sequences, in order."""
    return sorted(p.stem for p in Path(folder).glob("[0-9]*.json"))
