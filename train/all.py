# SPDX-License-Identifier: Apache-2.0
"""Makes the network of `--upscale learned` from nothing: scenes, data, training, and the ladder's figures. What is done
already is not done again. Further options are those of train.py."""
import argparse
import multiprocessing
import subprocess
import sys
from pathlib import Path

from scenes import make_scene

LADDER = ("teleport", "passing-fence", "panning-wires", "disocclusion", "light-switch", "swaying-foliage",
          "falling-snow", "moving-texture")
HELD = 16  # scenes that only judge
TRAINING = ("--steps", "3000", "--batch", "12", "--window", "8")


def make_scenes(folder, seeds, jobs):
    """Files of scenes, by seed."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"{seed:04}.glb" for seed in seeds]
    with multiprocessing.Pool(jobs) as pool:
        pool.starmap(make_scene, zip(seeds, paths))
    return paths


def make_data(program, scenes, folder, reference, jobs):
    """Films of a second of each scene."""
    command = [program, "dataset", *map(str, scenes), "--layout", "npy", "-o", folder, "--sequences", str(len(scenes)),
               "--frames", "24", "--rate", "24", "--size", "160x120", "--start", "0", "--camera", "own", "--reference",
               reference, "--bias", "-1", "--threads", "1"]
    shards = [subprocess.Popen([*command, "--shard", f"{job}/{jobs}"]) for job in range(jobs)]
    if any([shard.wait() for shard in shards]):
        sys.exit("the data could not be made")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default="./zoneplate")
    parser.add_argument("-o", "--output", default="out/learned")
    parser.add_argument("--scenes", type=int, default=600)
    parser.add_argument("--jobs", type=int, default=2, help="processes that make scenes and data")
    parser.add_argument("--smoke", action="store_true", help="a run of some minutes that shows that all parts work")
    arguments, further = parser.parse_known_args()
    scenes, ladder, training = arguments.scenes, LADDER, [*TRAINING, *further]
    if arguments.smoke:
        scenes, ladder, training = 4, LADDER[:1], ["--steps", "40", "--every", "10", *further]
    output, jobs = Path(arguments.output), arguments.jobs
    paths = make_scenes(output / "scenes", range(scenes), jobs)
    make_data(arguments.program, paths, output / "data", "ssaa:n=6", jobs)
    make_data(arguments.program, ladder, output / "ladder", "converged:samples=64", jobs)
    command = [sys.executable, Path(__file__).parent / "train.py", output / "data", "--ladder", output / "ladder", "-o",
               output / "network", *training]
    if not arguments.smoke:
        held = make_scenes(output / "held_scenes", range(90000, 90000 + HELD), jobs)
        make_data(arguments.program, held, output / "held", "ssaa:n=6", jobs)
        command += ["--held", output / "held"]
    subprocess.run(command, check=True)


if __name__ == "__main__":
    main()
