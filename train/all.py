# SPDX-License-Identifier: Apache-2.0
"""Makes the network of `--upscale learned` from nothing: scenes, data, training, and the ladder's figures. What is done
already is not done again."""
import argparse
import subprocess
import sys
from pathlib import Path

from scenes import make_scene

LADDER = ("teleport", "passing-fence", "panning-wires", "disocclusion", "light-switch", "swaying-foliage",
          "falling-snow", "moving-texture")


def make_data(program, scenes, folder, frames, size):
    subprocess.run([program, "dataset", *map(str, scenes), "--layout", "npy", "-o", folder, "--sequences",
                    str(len(scenes)), "--frames", str(frames), "--rate", "24", "--size", size, "--start", "0",
                    "--camera", "own", "--reference", "converged:samples=64", "--bias", "-1"], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="./zoneplate")
    parser.add_argument("-o", "--output", default="out/learned")
    parser.add_argument("--scenes", type=int, default=112)
    parser.add_argument("--steps", type=int, default=2000)
    parser.add_argument("--smoke", action="store_true", help="a run of some minutes that shows that all parts work")
    arguments = parser.parse_args()
    scenes, steps, ladder = arguments.scenes, arguments.steps, LADDER
    if arguments.smoke:
        scenes, steps, ladder = 4, 40, LADDER[:1]
    output = Path(arguments.output)
    (output / "scenes").mkdir(parents=True, exist_ok=True)
    paths = [output / "scenes" / f"{seed:04}.glb" for seed in range(scenes)]
    for seed, path in enumerate(paths):
        make_scene(seed, path)
    make_data(arguments.program, paths, output / "data", 24, "160x120")
    make_data(arguments.program, ladder, output / "ladder", 24, "160x120")
    subprocess.run([sys.executable, Path(__file__).parent / "train.py", output / "data", "--ladder", output / "ladder",
                    "-o", output / "network", "--steps", str(steps), "--every", "10" if arguments.smoke else "50"],
                   check=True)


if __name__ == "__main__":
    main()
