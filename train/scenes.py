# SPDX-License-Identifier: Apache-2.0
"""Scenes to train on, made from a seed: jumps, changes of light, particles, foliage, scrolling textures, thin
structures and rest.

Left out for good, so that the ladder can show what happens there: transparent surfaces, shadows, reflections and all
models and built-in scenes. A scene is seen through a view 2 units high, of 120 pixels."""
import numpy as np

from gltf import Gltf

PIXEL = 2 / 120
SECONDS = 1.25
FRAME = 1 / 24


def rectangle(x, y, half_width, half_height, z=0.0, angle=0.0):
    c, s = np.cos(angle), np.sin(angle)
    corners = ((-half_width, -half_height), (half_width, -half_height), (half_width, half_height),
               (-half_width, half_height))
    return [(x + c * u - s * v, y + s * u + c * v, z) for u, v in corners]


def quads(rectangles, repeat=1.0):
    """Positions, indices and texture coordinates of rectangles."""
    positions, indices, uv = [], [], []
    for corners in rectangles:
        first = len(positions)
        positions += corners
        indices += [first, first + 1, first + 2, first, first + 2, first + 3]
        uv += [(0, repeat), (repeat, repeat), (repeat, 0), (0, 0)]
    return positions, indices, np.array(uv)


def disc(radius, sides=24):
    angles = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    positions = [(0, 0, 0)] + [(radius * np.cos(a), radius * np.sin(a), 0) for a in angles]
    indices = [(0, 1 + i, 1 + (i + 1) % sides) for i in range(sides)]
    uv = [(0.5 + 0.5 * p[0] / radius, 0.5 + 0.5 * p[1] / radius) for p in positions]
    return positions, indices, uv


def smooth_noise(random, side, cells):
    """Noise of so many cells, by linear interpolation."""
    grid = random.random((cells + 1, cells + 1, 3))
    place = np.arange(side) * cells / side
    i, f = place.astype(int), (place % 1)[:, None]
    rows = grid[i] * (1 - f[:, :, None]) + grid[i + 1] * f[:, :, None]
    return rows[:, i] * (1 - f) + rows[:, i + 1] * f


def texture(random):
    side = 128
    colors = random.integers(10, 250, (2, 3))
    kind = random.choice(["cells", "checker", "noise", "stripes", "patches", "lines"])
    if kind == "cells":
        cell = int(random.choice([1, 2, 4, 8]))
        out = np.kron(random.random((side // cell, side // cell, 3)) * 220 + 15, np.ones((cell, cell, 1)))
    elif kind == "checker":
        index = np.arange(side) // int(random.choice([2, 4, 8, 16])) % 2
        out = np.where((index[:, None] ^ index[None, :])[..., None], *colors)
    elif kind == "noise":
        out = sum(smooth_noise(random, side, 4 << o) * 0.6**o for o in range(5))
        out = (out - out.min()) / np.ptp(out) * 230 + 10
    elif kind == "stripes":
        wave = np.sin(np.arange(side)[:, None] * 2 * np.pi * random.integers(8, 48) / side) * np.ones((1, side))
        out = np.where(((wave if random.random() < 0.5 else wave.T) > random.uniform(-0.8, 0.8))[..., None], *colors)
    else:
        is_lines = kind == "lines"
        out = np.ones((side, side, 3)) * colors[0]
        for _ in range(80 if is_lines else int(random.integers(40, 250))):
            x, y = random.integers(0, side, 2)
            w, h = (random.integers(3, 24), random.integers(1, 3)) if is_lines else random.integers(1, 14, 2)
            out[y:y + h, x:x + w] = colors[1] if is_lines else random.integers(0, 255, 3)
    return out.clip(0, 255).astype(np.uint8)


def leaf_texture(random):
    """Leaves that an alpha test cuts out."""
    side = 128
    y, x = np.mgrid[0:side, 0:side] / side
    out = np.zeros((side, side, 4))
    out[..., :3] = random.uniform(30, 150, 3)
    for _ in range(int(random.integers(12, 60))):
        angle, cx, cy = random.uniform(0, np.pi), *random.random(2)
        u = (x - cx) * np.cos(angle) + (y - cy) * np.sin(angle)
        v = (y - cy) * np.cos(angle) - (x - cx) * np.sin(angle)
        inside = (u / random.uniform(0.04, 0.14))**2 + (v / random.uniform(0.015, 0.05))**2 < 1
        out[inside, :3] = out[0, 0, :3] * random.uniform(0.4, 1.6)
        out[inside, 3] = 255
    return out.clip(0, 255).astype(np.uint8)


class Maker:
    def __init__(self, seed):
        self.random = np.random.default_rng(seed)
        self.out = Gltf()
        self.rests = self.chance(0.2)
        self.is_lit = self.chance(0.42)

    def chance(self, part):
        return self.random.random() < part

    def color(self):
        return self.random.uniform(0.02, 0.9, 3) if self.chance(0.8) else np.ones(3) * self.random.choice([0.03, 0.9])

    def speed(self):
        """Of most things 0.1 to 6 pixels per frame, of the others less."""
        pixels = self.random.uniform(0.1, 6) if self.chance(0.65) else self.random.uniform(0.02, 0.5)
        return pixels * PIXEL / FRAME

    def span(self):
        """When a thing moves: all the time, or only until a moment, or from one on."""
        moment = self.random.uniform(0.25, 0.8) * SECONDS
        return [(0, SECONDS), (0, moment), (moment, SECONDS)][self.random.choice(3, p=[0.55, 0.25, 0.2])]

    def slide(self, node, begin, end):
        """Moves a node towards a place that it reaches if it moves all the time; before and after it rests."""
        first, last = self.span()
        times = np.array(sorted({0, first, last, SECONDS}))
        part = (np.clip(times, first, last) - first)[:, None] / SECONDS
        self.out.animate(times, begin + (np.asarray(end) - begin) * part, node, "translation")

    def direction(self):
        angle = self.random.uniform(0, 2 * np.pi) if self.chance(0.5) else self.random.integers(0, 4) * np.pi / 2
        return np.array([np.cos(angle), np.sin(angle), 0])

    def camera(self):
        distance = 4.0
        kind = {"type": "orthographic", "orthographic": {"xmag": 4 / 3, "ymag": 1.0, "znear": 0.1, "zfar": 100.0}}
        if self.chance(0.5):
            kind = {"type": "perspective", "perspective": {"yfov": float(2 * np.arctan(1 / distance)),
                                                           "aspectRatio": 4 / 3, "znear": 0.1, "zfar": 200.0}}
        node = self.out.node((0, 0, distance), camera=self.out.add("cameras", kind))
        if not self.rests and self.chance(0.35):
            end = np.array([0, 0, distance]) + self.direction() * self.speed() * 0.6 * SECONDS
            self.slide(node, np.array([0, 0, distance]), end)

    def move(self, node, place):
        """Lets a node rest, slide, jump, sway or turn."""
        if self.rests:
            return
        place, random = np.array(place, float), self.random
        kind = random.choice(["rest", "slide", "jump", "sway", "turn"], p=[0.2, 0.36, 0.18, 0.14, 0.12])
        times = np.linspace(0, SECONDS, 40)
        if kind == "slide":
            half = self.direction() * self.speed() * SECONDS / 2
            self.slide(node, place - half, place + half)
        elif kind == "jump":
            count = int(random.integers(2, 9))
            places = np.tile(place, (count, 1))
            places[:, :2] += random.normal(0, 0.45, (count, 2))
            self.out.animate(np.linspace(0, SECONDS, count), places, node, "translation", is_stepped=True)
        elif kind == "sway":
            self.sway(node, place, random.uniform(0.02, 0.3), random.uniform(0.3, 1.5))
        elif kind == "turn":
            first, last = self.span()
            half = random.uniform(-2.5, 2.5) * np.clip(times, first, last) / 2
            self.out.animate(times, np.stack([0 * half, 0 * half, np.sin(half), np.cos(half)], 1), node, "rotation")

    def sway(self, node, place, size, frequency):
        times = np.linspace(0, SECONDS, 40)
        phase = 2 * np.pi * (frequency * times + self.random.random())
        places = np.tile(np.array(place, float), (40, 1))
        places[:, 0] += size * np.sin(phase)
        places[:, 1] += size / 2 * np.cos(phase)
        self.out.animate(times, places, node, "translation")

    def scroll(self, material, units_per_repeat):
        offset = self.direction()[:2] * self.speed() * SECONDS / units_per_repeat
        self.out.animate([0, SECONDS], [(0, 0), offset],
                         pointer=f"/materials/{material}/pbrMetallicRoughness/baseColorTexture/extensions/"
                         "KHR_texture_transform/offset")

    def wall(self):
        random, half = self.random, 6.0
        kind = random.choice(["squares", "texture", "gradient"], p=[0.5, 0.35, 0.15])
        colors = uv = None
        if kind == "squares":
            side = PIXEL * random.choice([1.25, 2, 3, 5, 8, 15, 30])
            count = int(min(5.6 / side, 90))
            squares = [rectangle((i - count / 2) * side, (j - count / 2) * side, side / 2, side / 2)
                       for j in range(count) for i in range(count)]
            positions, indices, _ = quads([rectangle(0, 0, half, half, -0.2)] + squares)
            colors = np.repeat(random.uniform(0.03, 0.85, (count * count + 1, 3)) * random.choice([1, 1, 0.12]), 4, 0)
            material = self.out.material((1, 1, 1), is_lit=self.is_lit)
        elif kind == "texture":
            repeat = random.uniform(2, 14)
            positions, indices, uv = quads([rectangle(0, 0, half, half)], repeat)
            material = self.out.material(np.ones(3) * random.uniform(0.4, 1), self.out.texture(texture(random)),
                                         self.is_lit)
            if not self.rests and self.chance(0.25):
                self.scroll(material, 2 * half / repeat)
        else:
            positions, indices, _ = quads([rectangle(0, 0, half, half)])
            colors = np.repeat(random.uniform(0.01, 0.5, (2, 3)), 2, 0)
            material = self.out.material((1, 1, 1), is_lit=self.is_lit)
        place = (0, 0, -3)
        node = self.out.node(place, mesh=self.out.mesh(positions, indices, material, uv, colors))
        if self.chance(0.4):
            self.move(node, place)

    def bars(self):
        random, count = self.random, int(self.random.integers(3, 40))
        gap, half = random.uniform(3, 14) * PIXEL, random.choice([0.2, 0.35, 0.5, 0.8, 1.2, 2]) * PIXEL / 2
        tilt = random.uniform(-0.6, 0.6) + (np.pi / 2 if self.chance(0.4) else 0)
        across = np.array([np.cos(tilt), np.sin(tilt)])
        return quads([rectangle(*(across * (i - count / 2) * gap), half, 1.5, 0, tilt) for i in range(count)])

    def spokes(self):
        half = self.random.uniform(0.3, 3) * PIXEL
        angles = np.linspace(0, 2 * np.pi, int(self.random.integers(3, 12)), endpoint=False)
        return quads([rectangle(0.2 * np.cos(a), 0.2 * np.sin(a), 0.22, half, 0, a) for a in angles])

    def thing(self, z):
        """Bars, spokes, a disc, or a card with or without a texture, which may scroll."""
        random, out = self.random, self.out
        place = (random.uniform(-1, 1), random.uniform(-0.8, 0.8), z)
        kind = random.choice(["bars", "spokes", "disc", "card", "foliage"], p=[0.3, 0.14, 0.16, 0.25, 0.15])
        if kind == "foliage":
            return self.foliage(place)
        is_lit = self.is_lit and self.chance(0.7)
        if kind == "card":
            repeat = random.uniform(0.3, 4)
            half = random.uniform(0.1, 0.8)
            positions, indices, uv = quads([rectangle(0, 0, half, random.uniform(0.1, 0.6), 0,
                                                      random.uniform(-0.5, 0.5))], repeat)
            has_texture = self.chance(0.6)
            material = out.material(np.ones(3) if has_texture else self.color(),
                                    out.texture(texture(random)) if has_texture else None, is_lit)
            if has_texture and not self.rests and self.chance(0.35):
                self.scroll(material, 2 * half / repeat)
        else:
            positions, indices, uv = (disc(random.uniform(0.05, 0.4)) if kind == "disc" else
                                      self.bars() if kind == "bars" else self.spokes())
            material = out.material(self.color(), is_lit=is_lit and kind == "disc")
        node = out.node(place, mesh=out.mesh(positions, indices, material, uv))
        self.move(node, place)

    def foliage(self, place):
        """Clouds of leaves that sway on their own: small quads, or cards that are cut out."""
        random, out = self.random, self.out
        is_cut_out = self.chance(0.5)
        base = random.uniform(0.05, 0.6, 3)
        cutout = out.texture(leaf_texture(random)) if is_cut_out else None
        frequency, size = random.uniform(0.3, 2), random.uniform(0.2, 4) * PIXEL
        for cloud in range(int(random.integers(1, 6))):
            count = int(random.integers(4, 20)) if is_cut_out else int(random.integers(30, 200))
            sides = (8, 40) if is_cut_out else (0.5, 6)
            leaves = [rectangle(*random.normal(0, 0.35, 2), random.uniform(*sides) * PIXEL / 2,
                                random.uniform(*sides) * PIXEL / 2, random.uniform(0, 0.3), random.uniform(0, 3.1))
                      for _ in range(count)]
            positions, indices, uv = quads(leaves)
            colors = np.repeat(np.clip(base + random.normal(0, 0.12, (count, 3)), 0.01, 0.95), 4, 0)
            material = out.material((1, 1, 1), cutout, self.is_lit and self.chance(0.5), is_cut_out)
            at = np.array(place) + np.array([*random.normal(0, 0.3, 2), 0.05 * cloud])
            node = out.node(at, mesh=out.mesh(positions, indices, material, uv, colors))
            if not self.rests:
                self.sway(node, at, size * random.uniform(0.5, 1.5), frequency)

    def particles(self):
        random, out = self.random, self.out
        material = out.material(self.color() if self.chance(0.4) else (0.9, 0.92, 0.95))
        size, wind = random.uniform(0.4, 1.2), random.normal(0, 0.2)
        for _ in range(int(random.integers(8, 30))):
            flakes = [rectangle(random.uniform(-1.6, 1.6), random.uniform(-2.5, 2.5),
                                *([random.uniform(0.25, 1.1) * PIXEL * size] * 2))
                      for _ in range(int(random.integers(4, 40)))]
            positions, indices, _ = quads(flakes)
            z = random.uniform(-0.5, 0)
            node = out.node((0, 0, z), mesh=out.mesh(positions, indices, material))
            if not self.rests:
                half = np.array([wind + random.normal(0, 0.1), -1, 0]) * random.uniform(0.3, 5) * PIXEL / FRAME
                half = half * SECONDS / 2
                out.animate([0, SECONDS], [np.array([0, 0, z]) - half, np.array([0, 0, z]) + half], node, "translation")

    def light(self):
        random = self.random
        for _ in range(2):
            self.out.light(random.uniform(0.5, 4), *random.uniform(-0.8, 0.8, 2))
        if not self.rests and self.chance(0.75):
            count = int(random.integers(2, 8))
            intensity = random.uniform(0, 4, count) * (random.random(count) < 0.7)
            self.out.animate(np.linspace(0, SECONDS, count), intensity,
                             pointer="/extensions/KHR_lights_punctual/lights/0/intensity",
                             is_stepped=self.chance(0.65))

    def save(self, path):
        self.camera()
        self.wall()
        for i in range(int(self.random.integers(1, 6))):
            self.thing(-2.5 + 0.4 * i + self.random.uniform(0, 0.1))
        if self.chance(0.25):
            self.particles()
        if self.is_lit:
            self.light()
        self.out.save(path)


def make_scene(seed, path):
    Maker(seed).save(path)
