# SPDX-License-Identifier: Apache-2.0
"""Metrics, filters, spectra and comparisons on arrays."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np
import zoneplate

PROGRAM = os.environ["ZONEPLATE_PROGRAM"]


class Images(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scene = zoneplate.load("teapot")
        cls.aliased = zoneplate.render(scene, size=(160, 120), aa="none")
        cls.smooth = zoneplate.render(scene, size=(160, 120), aa="smaa")

    def test_metrics_are_those_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            a, b = pathlib.Path(folder) / "a.png", pathlib.Path(folder) / "b.png"
            self.aliased.save(a), self.smooth.save(b)
            names = "mse,psnr,ssim,flip"
            done = subprocess.run([PROGRAM, "metrics", a, b, "--metric", names, "--json"], capture_output=True, text=True)
            report = json.loads(done.stdout)
        for name in names.split(","):
            self.assertEqual(float(zoneplate.measure(self.aliased, self.smooth, name)), report["metrics"][name]["value"])
        difference = self.aliased.rgb.astype(float) - self.smooth.rgb
        mse = float(zoneplate.measure(self.aliased, self.smooth, "mse"))
        self.assertAlmostEqual(255**2 * mse, (difference**2).mean(), places=4)

    def test_maps_and_figures(self):
        measured = zoneplate.measure(self.aliased.rgb, self.smooth.rgb, "flip:ppd=30")
        self.assertEqual(measured.map.shape, (120, 160))
        self.assertAlmostEqual(float(measured.map.mean()), measured.value, places=5)
        self.assertTrue(measured._repr_png_().startswith(b"\x89PNG"))
        self.assertIn("rmse", zoneplate.measure(self.aliased, self.smooth, "mse").figures)
        with self.assertRaises(zoneplate.UsageError):
            zoneplate.measure(self.aliased, self.smooth, "filp")
        with self.assertRaises(zoneplate.InputError):
            zoneplate.measure(self.aliased, self.smooth.rgb[:-1], "mse")

    def test_filters(self):
        self.assertTrue((zoneplate.filter(self.aliased, "smaa") == self.smooth.color).all())
        self.assertEqual(zoneplate.filter(self.aliased.rgb, "fxaa").shape, (120, 160, 3))
        grey = np.ascontiguousarray(self.aliased.color[..., 1])
        self.assertEqual(zoneplate.filter(grey, "fxaa").shape, (120, 160))
        sixteen = self.aliased.color.astype(np.uint16) * 257
        self.assertEqual(zoneplate.filter(sixteen, "smaa").dtype, np.uint16)
        with self.assertRaises(zoneplate.UsageError):
            zoneplate.filter(self.aliased, "msaa:n=4")

    def test_resampling(self):
        half = zoneplate.resample(self.aliased.rgb, (80, 60))
        self.assertEqual((half.shape, half.dtype), ((60, 80, 3), np.uint8))
        constant = np.full((10, 12), 0.25, np.float32)
        self.assertTrue((zoneplate.resample(constant, (5, 7), "mitchell") == 0.25).all())
        # Codes are filtered in linear light: half of 0 and 255 is 188.
        stripes = np.tile(np.array([0, 255], np.uint8), (8, 32))
        self.assertEqual(int(zoneplate.resample(stripes, (1, 1), "box")[0, 0]), 188)

    def test_spectra(self):
        x = np.arange(64)
        wave = np.tile(0.5 + 0.25 * np.cos(2 * np.pi * x / 8), (32, 1)).astype(np.float32)
        spectrum = zoneplate.spectrum(wave)
        expected = np.abs(np.fft.fftshift(np.fft.fft2(wave.astype(float))))
        peaks = np.argwhere(spectrum.magnitude > 0.85)
        self.assertEqual(sorted(map(tuple, peaks)), [(16, 24), (16, 32), (16, 40)])
        self.assertEqual(sorted(map(tuple, np.argwhere(expected > 1))), [(16, 24), (16, 32), (16, 40)])
        self.assertAlmostEqual(float(spectrum.frequency[np.argmax(spectrum.power[1:]) + 1]), 1 / 8, delta=0.02)
        self.assertTrue(spectrum._repr_png_().startswith(b"\x89PNG"))
        mean = zoneplate.frequency_filter(wave, "low", high=0.06, shape="ideal")
        np.testing.assert_allclose(mean, 0.5, atol=1e-6)
        rest = zoneplate.frequency_filter(wave, "high", low=0.06, shape="ideal")
        np.testing.assert_allclose(mean + rest, wave, atol=1e-6)

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.png"
            self.aliased.save(path)
            self.assertTrue((zoneplate.load_image(path).color == self.aliased.color).all())
            linear = zoneplate.render("teapot", size=(32, 24), dtype="float32")
            linear.save(path.with_suffix(".exr"))
            self.assertTrue(np.allclose(zoneplate.load_image(path.with_suffix(".exr")).color, linear.color, rtol=1e-3, atol=1e-6))
            with self.assertRaises(zoneplate.UsageError):
                linear.save(path)
        self.assertTrue(linear._repr_png_().startswith(b"\x89PNG"))
        self.assertEqual(zoneplate.Image(self.aliased.rgb).size, (160, 120))

    def test_comparison(self):
        found = zoneplate.compare("wires", ["none", "msaa:n=4"], size=(120, 90), reference="ssaa:n=8")
        self.assertEqual(list(found.values), ["none", "msaa:n=4"])
        self.assertGreater(found.values["none"]["flip"], found.values["msaa:n=4"]["flip"])
        png = found._repr_png_()
        self.assertTrue(png.startswith(b"\x89PNG"))
        html = found._repr_html_()
        self.assertEqual(html.count("<img"), 6)
        self.assertIn("psnr", repr(found))
        x, y, width, height = found.crop
        self.assertTrue(0 <= x <= 120 - width and 0 <= y <= 90 - height)

    def test_catalogues(self):
        self.assertIn("smaa", zoneplate.methods())
        self.assertIn("flip", zoneplate.metrics())
        self.assertIn("teapot", zoneplate.scenes())
        self.assertIn("depth", zoneplate.aovs())
        self.assertIn("lanczos3", zoneplate.kernels())


if __name__ == "__main__":
    unittest.main()
