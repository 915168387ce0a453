# SPDX-License-Identifier: Apache-2.0
"""Trains the network of `--upscale learned`. Stopped at any moment, it continues from its last checkpoint to the same
weights. See README.md."""
import argparse
import hashlib
import math
import os
import random
import subprocess
import time
from pathlib import Path

import torch

import chart
import ladder
import mean
import sequences
from network import Network

HEIGHT, WIDTH = 32, 48  # of a crop, in frame pixels
WINDOW = 4  # frames through which gradients pass
FLOOR = 5e-5  # errors below 43 dB count little


def light(x):
    """About the sRGB curve, with a small slope above 1."""
    return (torch.where(x > 1, 1 + 0.05 * (x - 1), x).clamp(min=0) + 0.002)**(1 / 2.2)


class Viewer:
    """Walks through a sequence's frames, window by window, in a crop that is flipped, with permuted channels and gain."""

    def __init__(self, random, data):
        self.random, self.data = random, data
        self.start()

    def start(self):
        r = self.random
        self.number, self.time, self.state, self.last = r.randrange(len(self.data)), 0, None, None
        truth = self.data[self.number]["truth"]
        h, w = truth.shape[2] // 2, truth.shape[3] // 2
        self.left, self.top = r.randrange(w - WIDTH + 1), r.randrange(h - HEIGHT + 1)
        self.flips = [r.random() < 0.5, r.random() < 0.5]
        self.order, self.gain = r.sample(range(3), 3), 2**r.uniform(-1, 0.5)

    def view(self, plane, name, t):
        scale = 2 if name == "truth" else 1
        x = plane[t:t + 1, :, scale * self.top:scale * (self.top + HEIGHT), scale * self.left:scale * (self.left + WIDTH)]
        x = x.flip([d for d, f in ((3, self.flips[0]), (2, self.flips[1])) if f])
        if name in ("color", "low", "high", "truth"):
            return x[:, self.order] * self.gain
        if name in ("motion", "follow"):
            return x * torch.tensor([-1.0 if f else 1.0 for f in self.flips]).view(1, 2, 1, 1)
        return x

    def window(self):
        """The next frames, and whether they are a sequence's first."""
        sequence = self.data[self.number]
        if self.time + WINDOW > len(sequence["sample"]):
            self.start()
            sequence = self.data[self.number]
        frames = []
        for t in range(self.time, self.time + WINDOW):
            frame = {name: self.view(sequence[name], name, t) for name in (*sequences.PLANES, "truth")}
            sample = sequence["sample"][t:t + 1]
            frame["sample"] = torch.where(torch.tensor([self.flips]), 1 - sample, sample)
            frames.append(frame)
        self.time += WINDOW
        return frames


class Trainer:
    def __init__(self, arguments, data):
        self.arguments = arguments
        torch.manual_seed(arguments.seed)
        self.random = random.Random(arguments.seed)
        self.network = Network()
        self.optimizer = torch.optim.Adam(self.network.parameters(), lr=arguments.rate, betas=(0.9, 0.99))
        self.viewers = [Viewer(self.random, data) for _ in range(arguments.batch)]
        self.steps, self.curve, self.spent = 0, [], 0.0

    def step(self):
        a = self.arguments
        part = self.steps / a.steps
        rate = a.rate * min(1, (self.steps + 1) / 50) * (0.01 + 0.99 * (0.5 + 0.5 * math.cos(math.pi * part)))
        for group in self.optimizer.param_groups:
            group["lr"] = rate
        windows = [v.window() for v in self.viewers]
        is_first = [v.time == WINDOW for v in self.viewers]
        states = [mean.first_state(1, HEIGHT, WIDTH) if f else v.state for f, v in zip(is_first, self.viewers)]
        state = {k: torch.cat([s[k] for s in states]) for k in states[0]}
        last = [None if f else v.last for f, v in zip(is_first, self.viewers)]
        loss = torch.zeros(())
        errors = []
        for i in range(WINDOW):
            frames = [w[i] for w in windows]
            frame = {k: torch.cat([f[k] for f in frames]) for k in frames[0]}
            image, state = mean.step(frame, state, torch.tensor(is_first) & (i == 0), self.network)
            seen = light(image)
            error = seen - light(frame["truth"])
            loss = loss + torch.log10(error.pow(2).mean((1, 2, 3)) + FLOOR).mean()
            before = [errors[-1][k:k + 1] for k in range(len(frames))] if errors else last
            known = [k for k, error_before in enumerate(before) if error_before is not None]
            if known:
                change = error[known] - torch.cat([before[k] for k in known])
                loss = loss + a.temporal * torch.log10(change.pow(2).mean((1, 2, 3)) + FLOOR).sum() / len(frames)
            errors.append(error)
        loss = loss / WINDOW
        self.optimizer.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), 1.0)
        self.optimizer.step()
        for k, viewer in enumerate(self.viewers):
            viewer.state = {name: plane[k:k + 1].detach() for name, plane in state.items()}
            viewer.last = errors[-1][k:k + 1].detach()
        self.steps += 1
        return 10 * loss.item()

    def checkpoint(self, path):
        viewers = [{k: v for k, v in vars(viewer).items() if k not in ("random", "data")} for viewer in self.viewers]
        torch.save({"network": self.network.state_dict(), "optimizer": self.optimizer.state_dict(), "steps": self.steps,
                    "random": self.random.getstate(), "viewers": viewers, "curve": self.curve, "spent": self.spent},
                   str(path) + ".part")
        os.replace(str(path) + ".part", path)

    def resume(self, path):
        saved = torch.load(path)
        self.network.load_state_dict(saved["network"])
        self.optimizer.load_state_dict(saved["optimizer"])
        self.random.setstate(saved["random"])
        for viewer, kept in zip(self.viewers, saved["viewers"]):
            vars(viewer).update(kept)
        self.steps, self.curve, self.spent = saved["steps"], saved["curve"], saved["spent"]


def hash_of_data(folder, names):
    """Of the bytes that training reads: the same data on any machine have the same hash."""
    out = hashlib.sha256()
    for name in names:
        for plane in ("ground_truth", "x2/color", "x2/depth", "x2/motion"):
            for path in sorted((Path(folder) / plane / name).iterdir()):
                out.update(path.read_bytes())
        out.update((Path(folder) / "jitter" / f"{name}.txt").read_bytes())
    return out.hexdigest()


def hash_of_scripts():
    """The tree of this folder in git."""
    tree = subprocess.run(["git", "-C", Path(__file__).parent, "rev-parse", "HEAD:./"], capture_output=True, text=True)
    return tree.stdout.strip() or "unknown"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", help="folder of zoneplate dataset --layout npy --ratio 2")
    parser.add_argument("--ladder", help="folder of the sequences that only judge")
    parser.add_argument("-o", "--output", default="out", help="folder of checkpoints, curves and weights")
    parser.add_argument("--steps", type=int, default=2000)
    parser.add_argument("--stop", type=int, help="stop after so many steps, at the rate that they have in --steps")
    parser.add_argument("--sequences", type=int, default=100000, help="use at most so many")
    parser.add_argument("--batch", type=int, default=6)
    parser.add_argument("--rate", type=float, default=3e-3)
    parser.add_argument("--temporal", type=float, default=0.1, help="weight of the change of the error between frames")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--every", type=int, default=50, help="steps between checkpoints")
    arguments = parser.parse_args()
    torch.set_num_threads(arguments.threads)
    torch.use_deterministic_algorithms(True, warn_only=True)
    output = Path(arguments.output)
    output.mkdir(parents=True, exist_ok=True)
    names = sequences.names_in(arguments.data)[:arguments.sequences]
    data = [sequences.load(arguments.data, name) for name in names]
    judges = [sequences.load(arguments.ladder, n) for n in sequences.names_in(arguments.ladder)] if arguments.ladder else []
    trainer = Trainer(arguments, data)
    path = output / "checkpoint.pt"
    if path.exists():
        trainer.resume(path)
    print(f"{len(data)} sequences, {sum(p.numel() for p in trainer.network.parameters())} parameters, "
          f"{trainer.steps} of {arguments.steps} steps done", flush=True)
    if judges and trainer.steps == 0:
        print("taau     PSNR %.2f dB, tPSNR %.2f dB" % tuple(ladder.table(judges)[1]), flush=True)
    sums, begin = [], time.monotonic()
    end = min(arguments.stop or arguments.steps, arguments.steps)
    while trainer.steps < end:
        sums.append(trainer.step())
        if trainer.steps % arguments.every and trainer.steps < end:
            continue
        now = time.monotonic()
        trainer.spent += now - begin
        begin = now
        trainer.curve.append(sum(sums) / len(sums))
        sums = []
        trainer.checkpoint(path)
        left = trainer.spent / trainer.steps * (end - trainer.steps)
        print(f"step {trainer.steps} of {arguments.steps}: {trainer.curve[-1]:.3f} dB, {left / 60:.1f} min left", flush=True)
        chart.write(output / "loss.png", trainer.curve)
        trainer.network.save_weights(output / "weights.bin")
        if judges and trainer.steps % (10 * arguments.every) == 0:
            print("ladder   PSNR %.2f dB, tPSNR %.2f dB" % tuple(ladder.table(judges, trainer.network)[1]), flush=True)
            begin = time.monotonic()
    if end < arguments.steps:
        return
    trainer.network.save_weights(output / "weights.bin")
    weights = hashlib.sha256((output / "weights.bin").read_bytes()).hexdigest()
    text = (f"weights  sha256 {weights}\ndata     sha256 {hash_of_data(arguments.data, names)}, {len(data)} sequences\n"
            f"scripts  git tree {hash_of_scripts()}\n"
            f"training {arguments.steps} steps of {arguments.batch} windows of {WINDOW} frames, rate {arguments.rate}, "
            f"temporal {arguments.temporal}, seed {arguments.seed}\n")
    (output / "weights.txt").write_text(text)
    print(text, end="")
    if judges:
        for name, row in zip(sequences.names_in(arguments.ladder), ladder.table(judges, trainer.network)[0]):
            print(f"{name}     PSNR {row[0]:.2f} dB, tPSNR {row[1]:.2f} dB")


if __name__ == "__main__":
    main()
