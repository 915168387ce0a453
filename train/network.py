# SPDX-License-Identifier: Apache-2.0
"""The network, whose numbers are already those of the integers that the renderer computes with.

Activations are 0 ... 127 for 0 ... 1, and weights -127 ... 127 times a scale of their output channel. Rounding has the
gradient of the identity."""
import struct

import numpy as np
import torch
import torch.nn as nn
import torch.nn.functional as F

from mean import FEATURES, OUTPUTS, InwardClamp

LEVELS = 127


def rounded(x):
    return x + (torch.round(x) - x).detach()


def activation(x):
    """Clamped to [0, 1] and rounded to a 127th. Below 0 a hundredth of the gradient passes, so that no unit dies."""
    return rounded((torch.where(x < 0, x * 0.01 - (x * 0.01).detach(), x)).clamp(-1, 1) * LEVELS) / LEVELS


class Convolution(nn.Conv2d):
    def __init__(self, inputs, outputs, side, stride=1, gain=1.0):
        super().__init__(inputs, outputs, side, stride)
        with torch.no_grad():
            self.weight *= gain
            self.bias *= gain

    def scale(self):
        return self.weight.detach().abs().amax((1, 2, 3)).clamp(min=1e-6) / LEVELS

    def forward(self, x):
        scale = self.scale()
        weight = rounded(self.weight / scale.view(-1, 1, 1, 1)) * scale.view(-1, 1, 1, 1)
        bias = rounded(self.bias / scale * LEVELS) * scale / LEVELS
        side = self.kernel_size[0] // 2
        return F.conv2d(F.pad(x, (side,) * 4, mode="replicate") if side else x, weight, bias, self.stride)


class Network(nn.Module):
    """At half the frame's resolution three layers see 15 x 15 pixels; at the frame's, one sees 3 x 3."""

    LAYERS = ("wide0", "wide1", "wide2", "own", "joined", "out")

    def __init__(self, features=FEATURES, outputs=4 * OUTPUTS):
        super().__init__()
        self.wide0 = Convolution(features, 16, 3, 2, gain=1.5)
        self.wide1 = Convolution(16, 16, 3, gain=1.5)
        self.wide2 = Convolution(16, 24, 3, gain=1.5)
        self.own = Convolution(features, 8, 1, gain=1.5)
        self.joined = Convolution(14, 16, 3, gain=1.5)
        self.out = Convolution(16, outputs, 1, gain=0.0)

    def forward(self, x):
        h, w = x.shape[2:]
        wide = activation(self.wide2(activation(self.wide1(activation(self.wide0(x))))))
        wide = F.pixel_shuffle(wide, 2)[:, :, :h, :w]
        both = torch.cat([wide, activation(self.own(x))], 1)
        # The features are rounded where they are made: see features_of.
        return self.out(activation(self.joined(both)))

    def save_weights(self, path):
        """Layer by layer: inputs, outputs and side as bytes; a float32 scale and an int32 bias per output; the int8
        weights by output, row, column and input."""
        with open(path, "wb") as file:
            file.write(b"ZPLEARN1")
            for name in self.LAYERS:
                layer = getattr(self, name)
                scale = layer.scale()
                outputs, inputs, side, _ = layer.weight.shape
                file.write(struct.pack("<BBBB", inputs, outputs, side, layer.stride[0]))
                file.write(scale.cpu().numpy().astype("<f4").tobytes())
                file.write(torch.round(layer.bias.detach() / scale * LEVELS).cpu().numpy().astype("<i4").tobytes())
                weights = torch.round(layer.weight.detach() / scale.view(-1, 1, 1, 1)).cpu().numpy()
                file.write(np.ascontiguousarray(weights.transpose(0, 2, 3, 1)).astype(np.int8).tobytes())

    @classmethod
    def of_weights(cls, path):
        """The network that save_weights has written, with its numbers of features and outputs."""
        data, at, layers = open(path, "rb").read(), 8, []
        for _ in cls.LAYERS:
            inputs, outputs, side, _ = data[at:at + 4]
            scale = np.frombuffer(data, "<f4", outputs, at + 4)
            bias = np.frombuffer(data, "<i4", outputs, at + 4 + 4 * outputs)
            at += 4 + 8 * outputs
            count = outputs * side * side * inputs
            weights = np.frombuffer(data, np.int8, count, at).reshape(outputs, side, side, inputs).transpose(0, 3, 1, 2)
            at += count
            layers.append((weights * scale.reshape(-1, 1, 1, 1), bias * scale / LEVELS))
        network = cls(layers[0][0].shape[1], len(layers[-1][1]))
        with torch.no_grad():
            for name, (weight, bias) in zip(cls.LAYERS, layers):
                getattr(network, name).weight.copy_(torch.from_numpy(weight))
                getattr(network, name).bias.copy_(torch.from_numpy(bias))
        return network
