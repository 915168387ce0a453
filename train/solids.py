# SPDX-License-Identifier: Apache-2.0
"""Scenes for the networks of one image, made from a seed: shaded blobs, tori, boxes, cones and height fields, beams near
the axes, textured floors and specks before a wall; and flat shapes of one colour. None is a model or a built-in scene."""
import numpy as np

from gltf import Gltf
from scenes import PIXEL, disc, quads, rectangle, texture


def surface(place, columns, rows):
    """A grid of points with smooth normals: positions, indices, texture coordinates and normals. `place` maps arrays
    u and v in [0, 1] to points."""
    u, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1))
    step = 1e-4
    point = place(u, v)
    normals = np.cross(place(u + step, v) - point, place(u, v + step) - point)
    length = np.linalg.norm(normals, axis=-1, keepdims=True)
    normals = np.where(length > 1e-12, normals / np.maximum(length, 1e-12), [0, 0, 1])
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    corners = np.stack([first, first + 1, first + columns + 2, first, first + columns + 2, first + columns + 1], 1)
    flat = lambda x: x.reshape(-1, x.shape[-1])
    return flat(point), corners, flat(np.stack([u, v], -1)), flat(normals)


def blob(random):
    waves = [(random.integers(1, 5), random.integers(1, 5), random.uniform(0, 6.3), random.uniform(0, 0.15))
             for _ in range(int(random.integers(0, 4)))]

    def place(u, v):
        a, b = 2 * np.pi * u, np.pi * v
        r = 1 + sum(s * np.sin(m * a + p) * np.sin(n * b) for m, n, p, s in waves)
        return np.stack([r * np.sin(b) * np.cos(a), r * np.cos(b), r * np.sin(b) * np.sin(a)], -1)
    return surface(place, 48, 32)


def torus(random):
    thin = random.uniform(0.05, 0.45)

    def place(u, v):
        a, b = 2 * np.pi * u, 2 * np.pi * v
        r = 1 + thin * np.cos(b)
        return np.stack([r * np.cos(a), r * np.sin(a), thin * np.sin(b)], -1)
    return surface(place, 56, 20)


def cone(random):
    top = random.uniform(0, 1)

    def place(u, v):
        a, r = 2 * np.pi * u, 1 + (top - 1) * v
        return np.stack([r * np.cos(a), 2 * v - 1, r * np.sin(a)], -1)
    return surface(place, 40, 4)


def field(random):
    waves = [(random.uniform(1, 9, 2), random.uniform(0, 6.3), random.uniform(0.02, 0.15)) for _ in range(4)]

    def place(u, v):
        height = sum(s * np.sin(k[0] * u * 3 + k[1] * v * 3 + p) for k, p, s in waves)
        return np.stack([2 * u - 1, height, 2 * v - 1], -1)
    return surface(place, 40, 40)


def box(random):
    sides = [surface(lambda u, v, k=k, s=s: np.stack(np.roll(
        [s * (2 * u - 1), 2 * v - 1, np.full_like(u, s)], k, 0), -1), 1, 1) for k in range(3) for s in (-1, 1)]
    positions, corners, uv, normals = zip(*sides)
    return (np.concatenate(positions), np.concatenate([c + 4 * i for i, c in enumerate(corners)]), np.concatenate(uv),
            np.concatenate(normals))


def turned(random, points):
    axes, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return points @ (axes * np.sign(np.linalg.det(axes)))


def with_camera():
    out = Gltf()
    out.node((0, 0, 4), camera=out.add("cameras", {"type": "perspective", "perspective": {
        "yfov": float(2 * np.arctan(1 / 4)), "aspectRatio": 4 / 3, "znear": 0.1, "zfar": 200.0}}))
    return out


def make_shapes(seed, path):
    """A few large triangles, bars and discs of one colour each: long straight and round edges at all angles."""
    random, out = np.random.default_rng(seed), with_camera()
    color = lambda: random.uniform(0, 1, 3)**2 if random.random() < 0.8 else np.ones(3) * random.choice([0, 0.02, 1])
    positions, indices, _ = quads([rectangle(0, 0, 9, 9)])
    out.node((0, 0, -5), mesh=out.mesh(positions, indices, out.material(color())))
    for i in range(int(random.integers(1, 7))):
        kind, size = random.integers(3), random.uniform(0.3, 2)
        if kind == 0:
            positions, indices = [(*(random.normal(0, size, 2)), 0) for _ in range(3)], [0, 1, 2]
        elif kind == 1:
            tilt = random.choice([0, np.pi / 2]) + random.normal(0, 0.05) if random.random() < 0.4 else random.uniform(0, 4)
            positions, indices, _ = quads([rectangle(0, 0, 2 * size, random.uniform(2, 40) * PIXEL, 0, tilt)])
        else:
            positions, indices, _ = disc(0.5 * size, 200)
        out.node((*random.uniform(-1, 1, 2), -2 + 0.3 * i), mesh=out.mesh(positions, indices, out.material(color())))
    out.save(path)


def make_solids(seed, path):
    random, out = np.random.default_rng(seed), with_camera()
    has_texture = random.random() < 0.3
    positions, indices, uv = quads([rectangle(0, 0, 9, 9)], random.uniform(1, 12))
    wall = out.material(random.uniform(0.02, 0.9, 3), out.texture(texture(random)) if has_texture else None, True)
    out.node((0, 0, -5), mesh=out.mesh(positions, indices, wall, uv))
    if random.random() < 0.35:
        # A floor or ceiling whose texture is seen at ever flatter angles.
        side = random.choice([-1, 1])
        positions, indices, uv = quads([rectangle(0, 0, 9, 9)], random.uniform(8, 80))
        positions = [(x, side * random.uniform(0.6, 0.61), y) for x, y, _ in positions]
        floor = out.material(np.ones(3) * random.uniform(0.3, 1), out.texture(texture(random)), True)
        out.node((0, 0, 0), mesh=out.mesh(positions, indices, floor, uv, normals=np.tile([0, -side, 0], (4, 1))))
    if random.random() < 0.35:
        beams = [rectangle(*random.uniform(-1, 1, 2), random.uniform(0.3, 2), random.uniform(1, 12) * PIXEL, 0,
                           random.normal(0, 0.06) + random.choice([0, np.pi / 2]))
                 for _ in range(int(random.integers(1, 9)))]
        positions, indices, _ = quads(beams)
        colors = np.repeat(random.uniform(0.02, 0.95, (len(beams), 3)), 4, 0)
        out.node((0, 0, random.uniform(-2, 0.5)),
                 mesh=out.mesh(positions, indices, out.material((1, 1, 1)), colors=colors))
    if random.random() < 0.2:
        specks = [rectangle(*random.uniform(-1.3, 1.3, 2), *random.uniform(0.2, 1, 2) * PIXEL)
                  for _ in range(int(random.integers(10, 200)))]
        positions, indices, _ = quads(specks)
        out.node((0, 0, random.uniform(-2, 0.5)),
                 mesh=out.mesh(positions, indices, out.material(random.uniform(0.3, 1, 3))))
    for _ in range(int(random.integers(0, 8))):
        positions, corners, uv, normals = (blob, torus, cone, field, box)[random.integers(5)](random)
        size = random.uniform(0.1, 0.9) * random.uniform(0.3, 1, 3)  # unlike sides
        points = turned(random, np.concatenate([positions * size, normals / size]))
        normals = points[len(positions):]
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        has_texture = random.random() < 0.3
        material = out.material(random.uniform(0.02, 0.95, 3), out.texture(texture(random)) if has_texture else None,
                                random.random() < 0.9)
        mesh = out.mesh(points[:len(positions)], corners, material, uv * random.uniform(0.5, 4), normals=normals)
        out.node((random.uniform(-1, 1), random.uniform(-0.8, 0.8), random.uniform(-2, 0.5)), mesh=mesh)
    for _ in range(int(random.integers(1, 4))):
        out.light(random.uniform(0.5, 4), *random.uniform(-0.9, 0.9, 2))
    out.save(path)
