# SPDX-License-Identifier: Apache-2.0
"""PSNR and tPSNR of `taau` and of a network on sequences, with pooled squared errors of 8-bit values as `compare`."""
import math

import torch

import mean
import sequences


def codes(x):
    x = x.clamp(0, 1)
    return torch.round(255 * torch.where(x <= 0.0031308, 12.92 * x, 1.055 * x.clamp(min=1e-8)**(1 / 2.4) - 0.055)) / 255


def run(sequence, network=None):
    h, w = sequence["color"].shape[2:]
    device = sequence["color"].device
    state, out = mean.first_state(1, h, w, device), []
    with torch.no_grad():
        for t in range(len(sequence["sample"])):
            is_first = torch.tensor([t == 0], device=device)
            image, state = mean.step(sequences.frame_of(sequence, t), state, is_first, network)
            out.append(image)
    return torch.cat(out)


def score(images, truth):
    """PSNR and tPSNR, in dB."""
    error = codes(images) - codes(truth)
    decibels = lambda e: -10 * math.log10(e.pow(2).mean().item())
    return decibels(error), decibels(error[1:] - error[:-1])


def table(ladder, network=None):
    """The scores of each sequence, and their means."""
    rows = [score(run(s, network), s["truth"]) for s in ladder]
    return rows, [sum(r[k] for r in rows) / len(rows) for k in (0, 1)]
