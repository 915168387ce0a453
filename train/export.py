# SPDX-License-Identifier: Apache-2.0
"""Writes the weights of a network as an ONNX model of the renderer's integers, and frames to check it with
(check_onnx.mjs).

The model reads features (1, F, height, width), whole numbers from 0 to 127, of an even height and width, and returns
corrections (1, C, height, width): F and C are 40 and 56 of learned.bin, 12 and 16 of learned_smaa.bin, 12 and 40 of
learned_still.bin. All its sums are exact, so that any order of additions gives the same numbers."""
import argparse
from pathlib import Path

import numpy as np
import torch
import torch.nn as nn
import torch.nn.functional as F

from network import LEVELS, Network


class Integers(nn.Module):
    """The network as the renderer computes it."""

    def __init__(self, network):
        super().__init__()
        self.strides = {name: getattr(network, name).stride for name in network.LAYERS}
        for name in network.LAYERS:
            layer = getattr(network, name)
            scale = layer.scale()
            weight, bias = layer.weight.detach() / scale.view(-1, 1, 1, 1), layer.bias.detach() / scale * LEVELS
            self.register_buffer(f"{name}_weight", torch.round(weight))
            self.register_buffer(f"{name}_bias", torch.round(bias))
            self.register_buffer(f"{name}_scale", scale.view(1, -1, 1, 1))

    def sums(self, name, x):
        weight = getattr(self, f"{name}_weight")
        side = weight.shape[2] // 2
        x = F.pad(x, (side,) * 4, mode="replicate") if side else x
        return F.conv2d(x, weight, getattr(self, f"{name}_bias"), self.strides[name])

    def layer(self, name, x):
        return torch.floor(self.sums(name, x) * getattr(self, f"{name}_scale") + 0.5).clamp(0, LEVELS)

    def forward(self, x):
        wide = F.pixel_shuffle(self.layer("wide2", self.layer("wide1", self.layer("wide0", x))), 2)
        joined = self.layer("joined", torch.cat([wide, self.layer("own", x)], 1))
        return self.sums("out", joined) * (self.out_scale / LEVELS)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("weights")
    parser.add_argument("-o", "--output", default="out/onnx", help="folder of network.onnx and the frames")
    parser.add_argument("--frames", type=int, default=20)
    arguments = parser.parse_args()
    output = Path(arguments.output)
    output.mkdir(parents=True, exist_ok=True)
    network = Network.of_weights(arguments.weights)
    inputs = network.wide0.in_channels
    model, random = Integers(network), np.random.default_rng(1)
    height, width = 60, 80
    with torch.no_grad():
        example = torch.zeros(1, inputs, height, width)
        torch.onnx.export(model, example, output / "network.onnx", opset_version=13, input_names=["features"],
                          output_names=["corrections"],
                          dynamic_axes={name: {2: "height", 3: "width"} for name in ("features", "corrections")})
        for number in range(arguments.frames):
            # Smooth, as features are, with noise.
            coarse = torch.from_numpy(random.uniform(-40, 170, (1, inputs, 8, 10)).astype(np.float32))
            smooth = F.interpolate(coarse, (height, width), mode="bilinear", align_corners=False)
            noise = torch.from_numpy(random.normal(0, 8, tuple(smooth.shape)).astype(np.float32))
            features = torch.round(smooth + noise).clamp(0, LEVELS)
            network_says, model_says = network(features / LEVELS), model(features)
            print(f"frame {number}: PyTorch's training form differs by {(network_says - model_says).abs().max():.2g}")
            (output / f"{number:02}.features").write_bytes(features.numpy().tobytes())
            (output / f"{number:02}.corrections").write_bytes(model_says.numpy().tobytes())


if __name__ == "__main__":
    main()
