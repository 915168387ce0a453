# SPDX-License-Identifier: Apache-2.0
"""Images as arrays: memory is shared, lives as long as it is used, and is freed."""

import ctypes
import gc
import unittest

import numpy as np
import zoneplate


def resident_bytes():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * 4096


class Arrays(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = zoneplate.load("teapot")

    def render(self, **options):
        return zoneplate.render(self.scene, size=(64, 48), **options)

    def test_numpy_shares_the_memory(self):
        image = self.render(aovs=["depth", "normal", "object-id", "crypto-object"])
        self.assertEqual(image.names[:4], ("color", "depth", "normal", "object-id"))
        for name in image.names:
            array = image.array(name)
            self.assertEqual(np.asarray(array).ctypes.data, array.address, name)
            self.assertEqual(image[name].ctypes.data, array.address, name)
            self.assertEqual(np.from_dlpack(array).ctypes.data, array.address, name)
            self.assertEqual(ctypes.addressof(ctypes.c_char.from_buffer(memoryview(array).cast("B"))), array.address)
            self.assertEqual(np.from_dlpack(array).shape, array.shape)
        self.assertEqual(np.from_dlpack(image).ctypes.data, image.array().address)
        self.assertEqual(np.asarray(image).ctypes.data, image.array().address)
        image.color[:, :, 0] = 7
        self.assertTrue((image.color[:, :, 0] == 7).all())

    def test_types_and_shapes(self):
        image = self.render(aovs=["depth", "normal", "uv", "object-id", "crypto-object"])
        shapes = {name: (image[name].dtype.name, image[name].shape) for name in image.names}
        self.assertEqual(shapes["color"], ("uint8", (48, 64, 4)))
        self.assertEqual(shapes["depth"], ("float32", (48, 64)))
        self.assertEqual(shapes["normal"], ("float32", (48, 64, 3)))
        self.assertEqual(shapes["uv"], ("float32", (48, 64, 2)))
        self.assertEqual(shapes["object-id"], ("uint32", (48, 64)))
        self.assertEqual(shapes["CryptoObject00"], ("float32", (48, 64, 4)))
        self.assertEqual(self.render(dtype="uint16").color.dtype, np.uint16)
        self.assertEqual(self.render(dtype="float32").color.dtype, np.float32)
        self.assertEqual(self.render().size, (64, 48))

    def test_an_array_outlives_its_image(self):
        color = self.render().color
        before = color.copy()
        tensor = np.from_dlpack(self.render())
        gc.collect()
        for _ in range(20):
            self.render()
        self.assertTrue((color == before).all())
        self.assertTrue((tensor == before).all())

    def test_capsules_are_freed_unused(self):
        image = self.render()
        array = image.array()
        for _ in range(100):
            array.__dlpack__()
            array.__dlpack__(stream=None, max_version=(1, 0), dl_device=(1, 0), copy=False)
        with self.assertRaises(BufferError):
            array.__dlpack__(copy=True)
        self.assertEqual(image.array().__dlpack_device__(), (1, 0))

    def test_doubles_far_from_the_origin_keep_their_places(self):
        corners, place = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.5]]), np.array([500000.125, 5200000.25, 300.5])
        eye, focus = np.array([1.0, 1.5, 3.0]), np.array([0.3, 0.3, 0.2])

        def rendered(origin):
            scene = zoneplate.Scene.from_arrays(corners + origin, [[0, 1, 2]], flat=True)
            camera = scene.camera(zoneplate.View(position=tuple(eye + origin), focal_point=tuple(focus + origin)))
            np.testing.assert_allclose([row[3] for row in camera.matrix[:3]], eye + origin, rtol=0, atol=1e-5)
            self.assertEqual(scene.bounds[0], tuple(origin))
            return np.asarray(scene.render(camera, size=(40, 30)).color).astype(int)

        self.assertLessEqual(abs(rendered(place) - rendered(0 * place)).max(), 2)

    def test_no_object_is_leaked(self):
        import sys

        positions = np.eye(3)
        indices = np.array([[0, 1, 2]])

        def use():
            scene = zoneplate.Scene.from_arrays(positions, indices, color="#ff8000")
            image = scene.render(zoneplate.View(azimuth=20), size=(8, 8), aovs=["depth"])
            image.color, image["depth"], image.encode(), image.names, scene.bounds, scene.objects
            np.from_dlpack(image)
            zoneplate.measure(image, image, "mse")
            zoneplate.filter(image, "fxaa")
            for wrong in (lambda: image["no"], lambda: scene.render(aa="no"), lambda: scene.render(size=(-1, 1))):
                try:
                    wrong()
                except (KeyError, zoneplate.Error):
                    pass

        for _ in range(20):
            use()
        gc.collect()
        objects, references = len(gc.get_objects()), sys.getrefcount(positions)
        blocks = sys.getallocatedblocks()
        for _ in range(200):
            use()
        gc.collect()
        self.assertLessEqual(len(gc.get_objects()) - objects, 5)
        self.assertEqual(sys.getrefcount(positions), references)
        self.assertLess(sys.getallocatedblocks() - blocks, 200)  # less than one of each round

    def test_ten_thousand_renders_do_not_grow(self):
        scene = zoneplate.load("triangles")
        render = lambda: zoneplate.render(scene, size=(16, 16), threads=1, aovs=["depth"])["depth"]
        for _ in range(500):
            render()
        before = resident_bytes()
        for _ in range(10000):
            render()
        growth = resident_bytes() - before
        print(f"\n10,000 renders: {growth / 1024:.0f} KiB more")
        self.assertLess(growth, 1 << 20)


if __name__ == "__main__":
    unittest.main()
