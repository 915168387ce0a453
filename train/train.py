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

FLOOR = 5e-5  # errors below 43 dB count little
AVERAGED = 256  # steps over which the weights that are judged and saved are a mean


def light(x):
    """About the sRGB curve, with a small slope above 1."""
    return (torch.where(x > 1, 1 + 0.05 * (x - 1), x).clamp(min=0) + 0.002)**(1 / 2.2)


class Walk:
    """Walks through a sequence's frames, window by window, in a crop that is flipped, of permuted channels and gain."""

    def __init__(self, random, data, window, height, width):
        self.random, self.window, self.height, self.width = random, window, height, width
        self.sequences, self.length, _, self.frame_height, self.frame_width = data["color"].shape
        self.time = self.length

    def next(self):
        r = self.random
        self.time += self.window
        if self.time + self.window > self.length:
            self.number, self.time = r.randrange(self.sequences), 0
            self.left, self.top = (r.randrange(self.frame_width - self.width + 1),
                                   r.randrange(self.frame_height - self.height + 1))
            self.flips = [r.random() < 0.5, r.random() < 0.5]
            self.order, self.gain = r.sample(range(3), 3), 2**r.uniform(-1, 0.5)
        return self

    def places(self, first, count, is_flipped):
        out = range(first, first + count)
        return list(reversed(out)) if is_flipped else list(out)


def window_of(walks):
    """Where the walks are: tensors whose first dimension is the walk."""
    places = lambda scale: {
        f"rows{scale}": [w.places(scale * w.top, scale * w.height, w.flips[1]) for w in walks],
        f"columns{scale}": [w.places(scale * w.left, scale * w.width, w.flips[0]) for w in walks]}
    lists = {"number": [w.number for w in walks], "time": [w.time for w in walks], "order": [w.order for w in walks],
             "is_flipped": [w.flips for w in walks], "is_first": [w.time == 0 for w in walks],
             "gain": [w.gain for w in walks], **places(1), **places(2)}
    return {key: torch.tensor(values) for key, values in lists.items()}


def frame_at(data, window, t):
    """Frame t of a window, and its truth."""
    number, time = window["number"].view(-1, 1, 1, 1), (window["time"] + t).view(-1, 1, 1, 1)
    out = {}
    for name in (*sequences.PLANES, "truth"):
        scale, is_color = 2 if name == "truth" else 1, name in ("color", "low", "high", "truth")
        channels = window["order"] if is_color else torch.arange(data[name].shape[2], device=number.device)[None]
        x = data[name][number, time, channels[:, :, None, None], window[f"rows{scale}"][:, None, :, None],
                       window[f"columns{scale}"][:, None, None]]
        if is_color:
            x = x * window["gain"].view(-1, 1, 1, 1)
        if name in ("motion", "follow"):
            x = x * (1 - 2 * window["is_flipped"].float())[:, :, None, None]
        out[name] = x
    sample = data["sample"][window["number"], window["time"] + t]
    out["sample"] = torch.where(window["is_flipped"], 1 - sample, sample)
    return out


class Trainer:
    def __init__(self, arguments, data):
        self.arguments, self.data = arguments, data
        self.device = torch.device(arguments.device)
        torch.manual_seed(arguments.seed)
        self.random = random.Random(arguments.seed)
        self.network, self.averaged = Network().to(self.device), Network().to(self.device)
        is_cuda = self.device.type == "cuda"
        rate = torch.tensor(0.0, device=self.device) if is_cuda else 0.0
        self.optimizer = torch.optim.Adam(self.network.parameters(), lr=rate, betas=(0.9, 0.99), capturable=is_cuda)
        width, height = arguments.crop
        self.walks = [Walk(self.random, data, arguments.window, height, width) for _ in range(arguments.batch)]
        self.state = mean.first_state(arguments.batch, height, width, self.device)
        self.last_error = torch.zeros_like(self.state["history"])
        self.share = torch.tensor(1.0, device=self.device)
        self.steps, self.curve, self.spent = 0, [], 0.0
        self.window = self.graph = None

    def update(self):
        """One step of the optimizer, in the window; all of it can be recorded."""
        a, is_first = self.arguments, self.window["is_first"]
        first = is_first.view(-1, 1, 1, 1)
        state = {k: torch.where(first, torch.zeros_like(v), v) for k, v in self.state.items()}
        before, has_before = self.last_error, (~is_first).float()
        loss = 0
        for t in range(a.window):
            frame = frame_at(self.data, self.window, t)
            image, state = mean.step(frame, state, is_first & (t == 0), self.network)
            error = light(image) - light(frame["truth"])
            change = (error - before).pow(2).mean((1, 2, 3))
            loss = loss + (torch.log10(error.pow(2).mean((1, 2, 3)) + FLOOR).mean() +
                           a.temporal * (torch.log10(change + FLOOR) * has_before).mean()) / a.window
            before, has_before = error, torch.ones_like(has_before)
        self.optimizer.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), 1.0)
        self.optimizer.step()
        with torch.no_grad():
            for average, weights in zip(self.averaged.parameters(), self.network.parameters()):
                average.copy_(average + (weights - average) * self.share)
            for key, plane in state.items():
                self.state[key].copy_(plane)
            self.last_error.copy_(before)
        return 10 * loss.detach()

    def step(self, part):
        """One step, where `part` of the training is done."""
        cooled = 0.01 + 0.99 * (0.5 + 0.5 * math.cos(math.pi * part))
        rate = self.arguments.rate * min(1, (self.steps + 1) / 50) * cooled
        self.share.fill_(max(1 / AVERAGED, 1 / (self.steps + 1)))
        window = window_of([w.next() for w in self.walks])
        if self.window is None:
            self.window = {key: values.to(self.device) for key, values in window.items()}
        for key, values in window.items():
            self.window[key].copy_(values)
        self.steps += 1
        if self.device.type == "cpu":
            self.optimizer.param_groups[0]["lr"] = rate
            return self.update().item()
        self.optimizer.param_groups[0]["lr"].fill_(rate)
        if self.graph is not None:
            self.graph.replay()
        elif self.steps <= 3:  # what is recorded must have run before
            stream = torch.cuda.Stream()
            stream.wait_stream(torch.cuda.current_stream())
            with torch.cuda.stream(stream):
                self.loss = self.update()
            torch.cuda.current_stream().wait_stream(stream)
        else:
            self.optimizer.zero_grad(set_to_none=True)
            torch.cuda.empty_cache()
            self.graph = torch.cuda.CUDAGraph()
            with torch.cuda.graph(self.graph):
                self.loss = self.update()
            self.graph.replay()
        return self.loss.item()

    def checkpoint(self, path):
        walks = [{k: v for k, v in vars(walk).items() if k != "random"} for walk in self.walks]
        torch.save({"network": self.network.state_dict(), "averaged": self.averaged.state_dict(),
                    "optimizer": self.optimizer.state_dict(), "steps": self.steps, "random": self.random.getstate(),
                    "walks": walks, "state": self.state, "last_error": self.last_error, "curve": self.curve,
                    "spent": self.spent}, str(path) + ".part")
        os.replace(str(path) + ".part", path)

    def resume(self, path):
        saved = torch.load(path)
        self.network.load_state_dict(saved["network"])
        self.averaged.load_state_dict(saved["averaged"])
        self.optimizer.load_state_dict(saved["optimizer"])
        self.random.setstate(saved["random"])
        for walk, kept in zip(self.walks, saved["walks"]):
            vars(walk).update(kept)
        self.state, self.last_error = saved["state"], saved["last_error"]
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
    parser.add_argument("--held", help="folder of further ones, made as the data are")
    parser.add_argument("-o", "--output", default="out", help="folder of checkpoints, curves and weights")
    parser.add_argument("--steps", type=int, default=2000)
    parser.add_argument("--minutes", type=float, help="train for this time, instead of a number of steps")
    parser.add_argument("--stop", type=int, help="stop after so many steps, at the rate that they have in --steps")
    parser.add_argument("--batch", type=int, default=6)
    parser.add_argument("--window", type=int, default=4, help="frames through which gradients pass")
    parser.add_argument("--crop", type=lambda text: tuple(map(int, text.split("x"))), default=(48, 32),
                        help="frame pixels that a step sees")
    parser.add_argument("--rate", type=float, default=3e-3)
    parser.add_argument("--temporal", type=float, default=0.15, help="weight of the change of the error between frames")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--device", default="cpu", help="cpu, or cuda, on which weights are not repeated bit by bit")
    parser.add_argument("--every", type=int, default=50, help="steps between checkpoints")
    arguments = parser.parse_args()
    torch.set_num_threads(arguments.threads)
    torch.use_deterministic_algorithms(arguments.device == "cpu", warn_only=True)
    torch.backends.cudnn.allow_tf32 = False
    output = Path(arguments.output)
    output.mkdir(parents=True, exist_ok=True)
    names = sequences.names_in(arguments.data)
    data = sequences.load_all(arguments.data, names, arguments.device)
    judges = {folder: [sequences.load(folder, n, arguments.device) for n in sequences.names_in(folder)]
              for folder in (arguments.ladder, arguments.held) if folder}
    trainer = Trainer(arguments, data)
    path = output / "checkpoint.pt"
    if path.exists():
        trainer.resume(path)
    print(f"{len(names)} sequences, {sum(p.numel() for p in trainer.network.parameters())} parameters, "
          f"{trainer.steps} of {arguments.steps} steps done", flush=True)

    def judge(network=None):
        for folder, judged in judges.items():
            rows, means = ladder.table(judged, network)
            print(f"{Path(folder).name}, PSNR and tPSNR of {trainer.steps} steps in dB: {means[0]:.2f} {means[1]:.2f}; "
                  + ", ".join("%.2f %.2f" % row for row in rows), flush=True)

    if trainer.steps == 0:
        judge()
    sums, begin = [], time.monotonic()
    end = min(arguments.stop or arguments.steps, arguments.steps)

    def part():
        if arguments.minutes:
            return min((trainer.spent + time.monotonic() - begin) / 60 / arguments.minutes, 1)
        return trainer.steps / arguments.steps

    while part() < 1 and (arguments.minutes or trainer.steps < end):
        sums.append(trainer.step(part()))
        if trainer.steps % arguments.every and part() < 1 and (arguments.minutes or trainer.steps < end):
            continue
        now = time.monotonic()
        trainer.spent += now - begin
        begin = now
        trainer.curve.append(sum(sums) / len(sums))
        sums = []
        trainer.checkpoint(path)
        left = arguments.minutes * 60 - trainer.spent if arguments.minutes else (
            trainer.spent / trainer.steps * (end - trainer.steps))
        print(f"step {trainer.steps}: {trainer.curve[-1]:.3f} dB, {left / 60:.1f} min left", flush=True)
        chart.write(output / "loss.png", trainer.curve)
        trainer.averaged.save_weights(output / "weights.bin")
        if trainer.steps % (10 * arguments.every) == 0:
            judge(trainer.averaged)
            begin = time.monotonic()
    if not arguments.minutes and end < arguments.steps:
        return
    trainer.averaged.save_weights(output / "weights.bin")
    weights = hashlib.sha256((output / "weights.bin").read_bytes()).hexdigest()
    text = (f"weights  sha256 {weights}\n"
            f"data     sha256 {hash_of_data(arguments.data, names)}, {len(names)} sequences\n"
            f"scripts  git tree {hash_of_scripts()}\n"
            f"training {trainer.steps} steps of {arguments.batch} windows of {arguments.window} frames of "
            f"{arguments.crop[0]}x{arguments.crop[1]}, rate {arguments.rate}, temporal {arguments.temporal}, "
            f"seed {arguments.seed}, {arguments.device}\n")
    (output / "weights.txt").write_text(text)
    print(text, end="")
    judge(trainer.averaged)


if __name__ == "__main__":
    main()
