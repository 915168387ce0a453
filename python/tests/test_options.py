# SPDX-License-Identifier: Apache-2.0
"""The options of the command as keywords: tests/options/rows.txt through Python, and the example of a product shot."""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import zoneplate

PROGRAM = os.environ["ZONEPLATE_PROGRAM"]
SOURCE = pathlib.Path(__file__).resolve().parents[2]


def rows():
    """The option, the model, the output and further options of each line, as (name, value) pairs."""
    for line in (SOURCE / "tests/options/rows.txt").read_text().splitlines():
        if not line.startswith("#"):
            option, model, output, others = (part.strip() for part in line.split("|"))
            name, _, value = option.partition(" ")
            pairs = [tuple(word.partition("=")[::2]) for word in others.split() if word != "="]
            yield (name, value), model, output, pairs


def keywords_of(pairs):
    """The keywords of rows: those of `render` where it has shorter ones."""
    own = {"anti-aliasing": "aa", "aov": "aovs", "background-color": "background", "no-background": "transparent",
           "scene": "scene_index"}
    out = {own.get(name, name.replace("-", "_")): value or True for name, value in pairs}
    if out.pop("no_cull", False):
        out["cull_back_faces"] = False
    if "resolution" in out:
        out["size"] = tuple(int(side) for side in out.pop("resolution").split(","))
    return out


class Options(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        shutil.copytree(SOURCE / "tests/options", self.folder, dirs_exist_ok=True)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)

    def files(self, folder):
        return {path.name: path.read_bytes() for path in (self.folder / folder).iterdir()}

    def test_each_row_gives_the_bytes_of_the_command(self):
        for option, model, output, others in rows():
            pairs = [("resolution", "48,40")] * (option[0] != "resolution") + others + [option]
            with self.subTest(option=option):
                for folder in "command", "python":
                    shutil.rmtree(self.folder / folder, ignore_errors=True)
                    (self.folder / folder).mkdir()
                arguments = [f"--{name}={value}" if value else f"--{name}" for name, value in pairs]
                subprocess.run([PROGRAM, "render", model, "-o", "command/" + output, "-q", *arguments], check=True)
                zoneplate.render_file(model, "python/" + output, **keywords_of(pairs))
                self.assertEqual(self.files("python"), self.files("command"))

    def test_each_row_is_a_keyword_with_a_summary(self):
        listed = zoneplate.options()
        self.assertEqual(len(listed), len({option[0] for option, *_ in rows()}))
        self.assertIn("soft:samples=N", listed["shadows"])
        with self.assertRaisesRegex(TypeError, "did you mean 'shadows'"):
            zoneplate.render("teapot", size=(8, 8), shadow="hard")
        with self.assertRaises(zoneplate.UsageError):
            zoneplate.render("teapot", size=(8, 8), turntable=3)

    def test_frames_are_an_iterator(self):
        frames = zoneplate.render_frames("teapot", zoneplate.View(elevation=40), (32, 24), turntable=4, shadows="hard")
        self.assertEqual(len(frames), 4)
        images = [frame.color for frame in frames]
        self.assertEqual(len(images), 4)
        self.assertTrue(all((a != b).any() for a, b in zip(images, images[1:])))
        zoneplate.render_file("teapot", "f.#.png", zoneplate.View(elevation=40), (32, 24), turntable=4, shadows="hard")
        self.assertTrue((zoneplate.load_image("f.2.png").color == images[2]).all())
        vertices = np.array([[0, 1, 0], [-1, 0, 1], [1, 0, 1]])
        own = zoneplate.Scene.from_arrays(vertices, [[0, 1, 2]])
        self.assertEqual(len(list(zoneplate.render_frames(own, size=(16, 16), turntable=2))), 2)

    def test_the_stub_is_that_of_the_table(self):
        spec = importlib.util.spec_from_file_location("make_stub", SOURCE / "python/make_stub.py")
        make_stub = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(make_stub)
        self.assertEqual((SOURCE / "python/zoneplate/_jobs.pyi").read_text(), make_stub.stub())

    def test_the_example_makes_a_turntable(self):
        script = SOURCE / "examples/product_shot.py"
        subprocess.run([sys.executable, script, "model.gltf", "sky.hdr", "shot.webp"], check=True)
        film = (self.folder / "shot.webp").read_bytes()
        self.assertEqual(film.count(b"ANMF"), 12)


if __name__ == "__main__":
    unittest.main()
