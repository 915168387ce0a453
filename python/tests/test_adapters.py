# SPDX-License-Identifier: Apache-2.0
"""Objects with the attributes of trimesh and Open3D, and programs that are written for pyrender."""

import math
import unittest
from types import SimpleNamespace

import numpy as np
import zoneplate
import zoneplate.pyrender as pyrender

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)
FRONT = zoneplate.View(azimuth=0, elevation=0)


def trimesh(**visual):
    return SimpleNamespace(vertices=CUBE, faces=FACES, visual=SimpleNamespace(**visual) if visual else None)


def render(source, **options):
    return zoneplate.render(source, FRONT, (64, 48), **options)


class Trimesh(unittest.TestCase):
    def test_plain_mesh(self):
        expected = render(zoneplate.Scene.from_arrays(CUBE, FACES))
        self.assertEqual(render(trimesh()).encode(), expected.encode())
        self.assertEqual(render(trimesh(kind=None)).encode(), expected.encode())
        open3d = SimpleNamespace(vertices=CUBE.tolist(), triangles=FACES.tolist(), vertex_colors=[])
        self.assertEqual(render(open3d).encode(), expected.encode())

    def test_colors_of_vertices_and_faces(self):
        green = np.array([0, 255, 0, 255], np.uint8)
        for visual in (
            {"kind": "vertex", "vertex_colors": np.tile(green, (8, 1))},
            {"kind": "face", "face_colors": np.tile(green, (12, 1))},
        ):
            color = render(trimesh(**visual)).color[24, 32]
            self.assertGreater(int(color[1]), 100)
            self.assertLess(int(color[0]), 60)

    def test_texture_begins_at_the_bottom(self):
        # v = 0 is the last row of the image: the lower half of the quad is blue.
        pixels = np.zeros((2, 1, 3), np.uint8)
        pixels[0, 0], pixels[1, 0] = (255, 0, 0), (0, 0, 255)
        uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
        material = SimpleNamespace(
            baseColorFactor=np.array([255, 255, 255, 255], np.uint8), baseColorTexture=pixels, metallicFactor=0.0, roughnessFactor=1.0
        )
        quad = SimpleNamespace(
            vertices=np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float),
            faces=np.array([[0, 1, 2], [0, 2, 3]]),
            visual=SimpleNamespace(kind="texture", uv=uv, material=material),
        )
        color = render(quad).color
        self.assertGreater(int(color[38, 32, 2]), int(color[38, 32, 0]) + 50)
        self.assertGreater(int(color[10, 32, 0]), int(color[10, 32, 2]) + 50)
        simple = SimpleNamespace(diffuse=np.array([255, 255, 255, 255], np.uint8), image=pixels)
        quad.visual.material = simple
        self.assertGreater(int(render(quad).color[10, 32, 0]), 100)

    def test_scene(self):
        moved = np.eye(4)
        moved[0, 3] = 3
        graph = {"a": (np.eye(4), "cube"), "b": (moved, "cube")}
        source = SimpleNamespace(
            geometry={"cube": trimesh()}, graph=type("Graph", (dict,), {"nodes_geometry": ["a", "b"]})(graph)
        )
        scene = zoneplate.Scene.from_trimesh(source)
        self.assertEqual(scene.objects, ["a", "b"])
        self.assertEqual(scene.meshes, ["a"])
        self.assertEqual(scene.bounds, ((-1.0, -1.0, -1.0), (4.0, 1.0, 1.0)))

    def test_point_cloud(self):
        cloud = SimpleNamespace(vertices=CUBE, colors=np.full((8, 4), 255, np.uint8))
        ids = render(cloud, aovs=["object-id"], aa="none")["object-id"]
        self.assertTrue(1 <= (ids == 0).sum() <= 16)


class Pyrender(unittest.TestCase):
    def scene(self):
        scene = pyrender.Scene(bg_color=[0, 0, 0, 255], ambient_light=[0.2, 0.2, 0.2])
        self.near = scene.add(pyrender.Mesh.from_trimesh(trimesh()), name="near")
        far = np.eye(4)
        far[:3, 3] = (3, 0, -3)
        red = pyrender.MetallicRoughnessMaterial(baseColorFactor=(1, 0, 0, 1), metallicFactor=0)
        self.far = scene.add(pyrender.Mesh([pyrender.Primitive(CUBE, indices=FACES, material=red)]), pose=far)
        pose = np.eye(4)
        pose[2, 3] = 6
        scene.add(pyrender.PerspectiveCamera(yfov=math.pi / 3), pose=pose)
        scene.add(pyrender.DirectionalLight(intensity=2), pose=pose)
        return scene

    def test_color_and_depth(self):
        renderer = pyrender.OffscreenRenderer(viewport_width=160, viewport_height=120)
        scene = self.scene()
        color, depth = renderer.render(scene)
        self.assertEqual((color.shape, color.dtype.name), ((120, 160, 3), "uint8"))
        self.assertEqual((depth.shape, depth.dtype.name), ((120, 160), "float32"))
        self.assertAlmostEqual(float(depth[60, 80]), 5, places=4)  # from z = 6 to the face at z = 1
        self.assertEqual(float(depth[0, 0]), 0)
        self.assertEqual(tuple(color[0, 0]), (0, 0, 0))
        flags = pyrender.RenderFlags
        self.assertEqual(renderer.render(scene, flags=flags.RGBA)[0].shape, (120, 160, 4))
        self.assertTrue((renderer.render(scene, flags=flags.DEPTH_ONLY)[60, 80] == depth[60, 80]).all())
        segments, _ = renderer.render(scene, flags=flags.SEG, seg_node_map={self.far: (1, 2, 3)})
        self.assertEqual({tuple(c) for c in segments.reshape(-1, 3)}, {(0, 0, 0), (1, 2, 3)})
        with self.assertRaises(zoneplate.UsageError):
            renderer.render(scene, flags=8)  # ALL_WIREFRAME
        renderer.delete()

    def test_a_moved_node_moves(self):
        renderer = zoneplate.OffscreenRenderer(64, 48)
        scene = self.scene()
        before = renderer.render(scene)[1]
        pose = np.eye(4)
        pose[2, 3] = 1
        scene.set_pose(self.near, pose)
        self.assertAlmostEqual(float(before[24, 32] - renderer.render(scene)[1][24, 32]), 1, places=4)

    def test_cameras(self):
        pose = np.eye(4)
        pose[2, 3] = 6
        by_angle, by_pixels = pyrender.Scene(), pyrender.Scene()
        for scene, camera in (
            (by_angle, pyrender.PerspectiveCamera(yfov=2 * math.atan(0.5))),
            (by_pixels, pyrender.IntrinsicsCamera(fx=48, fy=48, cx=32, cy=24)),
        ):
            scene.add(pyrender.Mesh.from_trimesh(trimesh()))
            scene.add(camera, pose=pose)
        renderer = zoneplate.OffscreenRenderer(64, 48)
        # Their planes differ, which may change the last bit of the depth.
        np.testing.assert_allclose(renderer.render(by_angle)[1], renderer.render(by_pixels)[1], rtol=1e-5)
        shifted = pyrender.Scene()
        shifted.add(pyrender.Mesh.from_trimesh(trimesh()))
        shifted.add(pyrender.IntrinsicsCamera(fx=48, fy=48, cx=37, cy=21), pose=pose)
        moved, centred = renderer.render(shifted)[1], renderer.render(by_pixels)[1]
        np.testing.assert_allclose(moved[:45, 5:], centred[3:, :59], rtol=1e-5)
        parallel = pyrender.Scene()
        parallel.add(pyrender.Mesh.from_trimesh(trimesh()))
        parallel.add(pyrender.OrthographicCamera(xmag=2, ymag=2), pose=pose)
        self.assertEqual((renderer.render(parallel)[1] > 0).sum(), 24 * 24)

    def test_scenes_of_other_kinds(self):
        color, depth = zoneplate.OffscreenRenderer(64, 48).render(zoneplate.load("teapot"))
        self.assertEqual(color.shape, (48, 64, 3))
        self.assertGreater(depth.max(), 0)


if __name__ == "__main__":
    unittest.main()
