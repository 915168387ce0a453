# SPDX-License-Identifier: Apache-2.0
"""Makes the networks of `learned-smaa` and `learned-still` from nothing: images of the scenes without antialiasing,
with SMAA and with 64 samples per pixel, and the training of two networks, for images of the same and of twice the size.
Stopped at any moment, it continues from its last checkpoint to the same weights.

A network corrects the weights with which each pixel is a mean. At the same size it is the pixel of SMAA, and nine more
weights are those of the 3 x 3 pixels before it; at twice the size nine weights per output pixel are corrections of
bilinear ones, of the 3 x 3 pixels of SMAA. Zeros: SMAA, and its bilinear filtering in linear light."""
import argparse
import hashlib
import math
import multiprocessing
import os
import struct
import subprocess
import time
import zlib
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F

import chart
from gltf import png
from mean import around
from network import LEVELS, InwardClamp, Network
from scenes import make_scene
from solids import make_shapes, make_solids
from train import hash_of_scripts

WIDTH, HEIGHT = 160, 120
FEATURES = 12
OUTPUTS = {1: 16, 2: 40}  # of the network, by scale; of 16 the first 9 count, of 40 the first 36
HELD = 64  # scenes that only judge
AVERAGED = 256


def render(program, scene, moment, width, height, method, path):
    command = [program, scene, "--size", f"{width}x{height}", "--aa", method, "--camera-index", "0", "--threads", "1",
               "-o", path]
    at = ["--animation-time", f"{moment:.4f}"]
    for extra in (at, []):  # some scenes have no animation
        if subprocess.run([*command, *extra], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL).returncode == 0:
            return
    raise SystemExit(f"{scene} cannot be rendered")


def raw(path, width, height):
    return np.fromfile(path, np.uint8).reshape(height, width, 4)[..., :3]


def read_png(path):
    """An RGB or RGBA image of 8 bits, not interlaced."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, _, color = struct.unpack(">IIBB", body[:10])
        packed += body if kind == b"IDAT" else b""
        at += 12 + size
    depth = {2: 3, 6: 4}[color]
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * depth)
    out = np.zeros((height + 1, width + 1, depth), int)  # with a border of zeros above and to the left
    for y in range(height):
        line = rows[y, 1:].reshape(width, depth)
        for x in range(width):
            a, b, c = out[y + 1, x], out[y, x + 1], out[y, x]
            p = a + b - c
            nearest = np.where((abs(p - a) <= abs(p - b)) & (abs(p - a) <= abs(p - c)), a,
                               np.where(abs(p - b) <= abs(p - c), b, c))
            out[y + 1, x + 1] = (line[x] + (0, a, b, (a + b) // 2, nearest)[rows[y, 0]]) % 256
    return out[1:, 1:, :3].astype(np.uint8)


def make_images(program, seed, folder):
    """The images of one scene, in a file of their own: those of twice the size are reduced ones, of textures filtered
    for their own pixels or for finer ones. A quarter of the scenes is of solids, one of flat shapes; most images are
    parts of larger ones."""
    out = folder / f"{seed:05}.npz"
    if out.exists():
        return
    scene, part = folder / f"{seed:05}.glb", folder / f"{seed:05}.rgba"
    (make_scene, make_solids, make_scene, make_shapes)[seed % 4](seed, scene)
    random = np.random.default_rng(seed)
    moment, is_fine, zoom = random.uniform(0, 1.2), random.random() < 0.5, int(random.integers(1, 5))
    width, height = zoom * WIDTH // 2, zoom * HEIGHT // 2  # of the reduced image
    left, top = random.integers(width - WIDTH // 2 + 1), random.integers(height - HEIGHT // 2 + 1)

    def crop(image, scale):
        return image[scale * top:scale * top + scale * HEIGHT // 2, scale * left:scale * left + scale * WIDTH // 2]

    images = {}
    for name, scale, method in (("none", 2, "none"), ("smaa", 2, "smaa"), ("truth", 2, "ssaa:n=8"),
                                ("small", 1, "none"), ("small_smaa", 1, "smaa"), ("fine", 3, "none")):
        if name in (("small", "small_smaa") if is_fine else ("fine",)):
            continue
        render(program, scene, moment, scale * width, scale * height, method, part)
        images[name] = raw(part, scale * width, scale * height)
        if name != "fine":
            images[name] = crop(images[name], scale)
    if is_fine:
        # The middle pixel of three by three is the sample of a pixel of three times the side.
        small = images.pop("fine")[1::3, 1::3]
        source, target = folder / f"{seed:05}.png", folder / f"{seed:05}.smaa.png"
        source.write_bytes(png(crop(small, 1)))
        subprocess.run([program, "filter", source, "--aa", "smaa", "--threads", "1", "-o", target], check=True,
                       stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        images["small"], images["small_smaa"] = crop(small, 1), read_png(target)
        source.unlink()
        target.unlink()
    part.unlink()
    scene.unlink()
    whole = folder / f"{seed:05}.part.npz"
    np.savez_compressed(whole, **images)
    whole.rename(out)


def write_pairs(folder, seeds, output):
    """The images of half and of full size as PNG files, for zoneplate_table."""
    for name in ("small", "truth"):
        (output / name).mkdir(exist_ok=True)
        for seed in seeds:
            path = output / name / f"{seed:05}.png"
            if not path.exists():
                path.write_bytes(png(np.load(folder / f"{seed:05}.npz")[name]))


def load(folder, seeds, scale):
    """Pixels without antialiasing, those of SMAA, and the truth: bytes (image, channel, row, column)."""
    names = ("none", "smaa", "truth") if scale == 1 else ("small", "small_smaa", "truth")
    files = [np.load(folder / f"{seed:05}.npz") for seed in seeds]
    return [torch.from_numpy(np.stack([f[name] for f in files]).transpose(0, 3, 1, 2).copy()) for name in names]


def decode(codes):
    v = codes.float() / 255
    return torch.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055)**2.4)


def encode(x):
    return torch.where(x <= 0.0031308, 12.92 * x, 1.055 * x.clamp(min=1e-8)**(1 / 2.4) - 0.055)


def features(image, smooth):
    """Whole numbers from 0 to 127, of 8-bit pixels (src/zoneplate/antialias/post/learned_smaa)."""
    image, smooth = image.float(), smooth.float()
    luma = torch.floor((2 * image[:, :1] + 5 * image[:, 1:2] + image[:, 2:]) / 8)
    near = around(luma)[:, 0]
    step = torch.cat([near[:, k:k + 1] - luma for k in (3, 5, 1, 7)], 1)
    planes = [torch.floor(image / 2), 64 + smooth - image, near.amax(1, keepdim=True) - luma,
              luma - near.amin(1, keepdim=True), 64 + torch.floor(step / 2)]
    return torch.cat(planes, 1).clamp(0, LEVELS)


BILINEAR = torch.tensor([[(0.25 if (dx == 2) == (s % 2 == 1) and dx != 1 else 0.75 if dx == 1 else 0) *
                          (0.25 if (dy == 2) == (s // 2 == 1) and dy != 1 else 0.75 if dy == 1 else 0)
                          for dy in range(3) for dx in range(3)] for s in range(4)])


def resolve(image, smooth, output, scale):
    """The linear light of the image that the corrections make."""
    clamp = InwardClamp.apply
    if scale == 1:
        weights = clamp(output[:, :9], 0.0, 4.0)
        colors, middle = around(decode(image)), decode(smooth)
        total = weights.sum(1, keepdim=True).clamp(min=1)
        return middle + ((colors - middle.unsqueeze(2)) * (weights / total).unsqueeze(1)).sum(2)
    b, _, h, w = output.shape
    weights = clamp(BILINEAR.view(1, 4, 9, 1, 1) + output[:, :36].view(b, 4, 9, h, w), 0.0, 4.0)
    weights = weights / weights.sum(2, keepdim=True).clamp(min=1e-3)
    light = (around(decode(smooth)).unsqueeze(2) * weights.unsqueeze(1)).sum(3)
    return F.pixel_shuffle(light.reshape(b, 12, h, w), 2)


def make(image, smooth, network, scale):
    return resolve(image, smooth, network(features(image, smooth) / LEVELS), scale)


def score(network, data, scale):
    """PSNR, in dB, of each image as it is without the network, and with it."""
    image, smooth, truth = data
    zero = torch.zeros(1, OUTPUTS[scale], 1, 1)
    out = []
    with torch.no_grad():
        for i in range(len(image)):
            one = image[i:i + 1], smooth[i:i + 1]
            plain = resolve(*one, zero.expand(1, -1, *image.shape[2:]), scale)
            row = []
            for light in (plain, make(*one, network, scale)):
                codes = torch.round(encode(light.clamp(0, 1)) * 255)
                row.append(-10 * math.log10(((codes - truth[i:i + 1].float()) / 255).pow(2).mean().item() + 1e-7))
            out.append(row)
    return torch.tensor(out).mean(0).tolist()


def train(arguments, folder, seeds, held, scale):
    torch.manual_seed(arguments.seed)
    random = np.random.default_rng(arguments.seed)
    data, judged = load(folder, seeds, scale), load(folder, held, scale)
    network, averaged = Network(FEATURES, OUTPUTS[scale]), Network(FEATURES, OUTPUTS[scale])
    averaged.load_state_dict(network.state_dict())
    optimizer = torch.optim.Adam(network.parameters(), lr=0, betas=(0.9, 0.99))
    output, curve, sums, begin, first = Path(arguments.output), [], [], time.monotonic(), 0
    checkpoint = output / f"checkpoint{scale}.pt"
    if checkpoint.exists():
        saved = torch.load(checkpoint)
        network.load_state_dict(saved["network"])
        averaged.load_state_dict(saved["averaged"])
        optimizer.load_state_dict(saved["optimizer"])
        random.bit_generator.state, first, curve = saved["random"], saved["steps"], saved["curve"]
    side_x, side_y = arguments.crop[0] // scale, arguments.crop[1] // scale
    count, _, h, w = data[0].shape
    for step in range(first, arguments.steps):
        rate = arguments.rate * min(1, (step + 1) / 50) * (0.01 + 0.99 * (0.5 + 0.5 * math.cos(
            math.pi * step / arguments.steps)))
        optimizer.param_groups[0]["lr"] = rate
        crops = [[], [], []]
        for _ in range(arguments.batch):
            number, x, y = random.integers(count), random.integers(w - side_x + 1), random.integers(h - side_y + 1)
            flips = [d for d in (1, 2) if random.random() < 0.5]
            order = torch.from_numpy(random.permutation(3))
            turned = random.random() < 0.5
            for k, plane in enumerate(data):
                s = scale if k == 2 else 1
                crop = plane[number, :, s * y:s * (y + side_y), s * x:s * (x + side_x)]
                crop = crop[order].flip(flips)
                crops[k].append(crop.transpose(1, 2) if turned else crop)
        # Turned crops have another form.
        loss, tall = 0, [c.shape[1] > c.shape[2] for c in crops[0]]
        for form in (False, True):
            chosen = [[c for c, t in zip(crop, tall) if t == form] for crop in crops]
            if chosen[0]:
                image, smooth, truth = map(torch.stack, chosen)
                error = encode(make(image, smooth, network, scale)) - truth.float() / 255
                loss = loss + torch.log10(error.pow(2).mean((1, 2, 3)) + arguments.floor).sum() / arguments.batch
        optimizer.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimizer.step()
        share = max(1 / AVERAGED, 1 / (step + 1))
        with torch.no_grad():
            for average, weights in zip(averaged.parameters(), network.parameters()):
                average.add_((weights - average) * share)
        sums.append(10 * loss.item())
        if (step + 1) % arguments.every == 0 or step + 1 == arguments.steps:
            curve.append(sum(sums) / len(sums))
            sums = []
            left = (time.monotonic() - begin) / (step + 1 - first) * (arguments.steps - step - 1) / 60
            plain, now = score(averaged, judged, scale)
            print(f"scale {scale}, step {step + 1}: {curve[-1]:.3f} dB; held out {plain:.2f} -> {now:.2f} dB, "
                  f"{left:.1f} min left", flush=True)
            chart.write(output / f"loss{scale}.png", curve)
            torch.save({"network": network.state_dict(), "averaged": averaged.state_dict(),
                        "optimizer": optimizer.state_dict(), "random": random.bit_generator.state, "steps": step + 1,
                        "curve": curve}, str(checkpoint) + ".part")
            os.replace(str(checkpoint) + ".part", checkpoint)
    averaged.save_weights(output / f"weights{scale}.bin")
    hash_of = lambda parts: hashlib.sha256(b"".join(parts)).hexdigest()
    (output / f"weights{scale}.txt").write_text(
        f"weights  sha256 {hash_of([(output / f'weights{scale}.bin').read_bytes()])}\n"
        f"data     sha256 {hash_of(plane.numpy().tobytes() for plane in data)}, {count} images\n"
        f"scripts  git tree {hash_of_scripts()}\n"
        f"training {arguments.steps} steps of {arguments.batch} crops of {side_x}x{side_y}, rate {arguments.rate}, "
        f"seed {arguments.seed}, cpu\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="./zoneplate")
    parser.add_argument("-o", "--output", default="out/stills")
    parser.add_argument("--scenes", type=int, default=1600)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--steps", type=int, default=5000)
    parser.add_argument("--batch", type=int, default=12)
    parser.add_argument("--crop", type=lambda text: tuple(map(int, text.split("x"))), default=(96, 64))
    parser.add_argument("--rate", type=float, default=3e-3)
    parser.add_argument("--floor", type=float, default=2e-5)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--every", type=int, default=200)
    parser.add_argument("--scale", type=int, choices=(1, 2), action="append")
    arguments = parser.parse_args()
    torch.set_num_threads(arguments.threads)
    torch.use_deterministic_algorithms(True, warn_only=True)
    output = Path(arguments.output)
    folder = output / "images"
    folder.mkdir(parents=True, exist_ok=True)
    seeds, held = range(10000, 10000 + arguments.scenes), range(90000, 90000 + HELD)
    with multiprocessing.Pool(arguments.jobs) as pool:
        pool.starmap(make_images, [(arguments.program, seed, folder) for seed in (*seeds, *held)])
    write_pairs(folder, seeds, output)
    for scale in arguments.scale or (1, 2):
        train(arguments, folder, seeds, held, scale)


if __name__ == "__main__":
    main()
