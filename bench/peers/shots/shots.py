# SPDX-License-Identifier: Apache-2.0
"""Draws product shots by Zoneplate and by Blender's Cycles, and compares times at equal error.

Each renderer is judged against its own converged image: the root mean square difference of 8-bit sRGB codes, without
rounding, over all pixels, and over those of the model alone. Zoneplate's time is that of the process; Cycles' that of
the render alone, without Blender's start and import. See run-shots.
"""
import argparse
import json
import os
import pathlib
import resource
import statistics
import struct
import subprocess
import time
import zlib

import numpy

here = pathlib.Path(__file__).resolve().parent
background = numpy.array([0xE8, 0xE6, 0xE0]) / 255
shaded_samples = 4  # per pixel and axis of Zoneplate's converged image: its error contains that of antialiasing
rays_far = 100  # occlusion rays reach this many diagonals of the model, as those of Cycles reach everything


def decode_srgb(codes):
    return numpy.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


def encode_srgb(linear):
    linear = numpy.clip(linear, 0, 1)
    return numpy.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)


def run(command):
    """The processor and wall time of a process with its children."""
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(list(map(str, command)), check=True, stdout=subprocess.DEVNULL)
    wall, after = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    return {"cpu": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, "wall": wall}


def median(times):
    return {key: statistics.median(t[key] for t in times) for key in ("cpu", "wall")}


def exr_matrix(path, name):
    """A 4 x 4 matrix of the header of an EXR file, for row vectors."""
    data = path.read_bytes()
    at = data.index(name.encode() + b"\0m44f\0") + len(name) + 10
    return numpy.array(struct.unpack("<16f", data[at : at + 64])).reshape(4, 4)


def read_pfm(path):
    with open(path, "rb") as file:
        kind, size, scale = (file.readline().decode().strip() for _ in range(3))
        width, height = map(int, size.split())
        values = numpy.frombuffer(file.read(), "<f4" if float(scale) < 0 else ">f4")
    return values.reshape(height, width, -1)[::-1]


def directions(width, height):
    """Those of the pixels of an equirectangular image, whose middle is +x and whose top is +y."""
    across = 2 * numpy.pi * (numpy.arange(width) + 0.5) / width
    down = numpy.pi * (numpy.arange(height)[:, None] + 0.5) / height
    level = numpy.ones(width)
    return -numpy.cos(across) * numpy.sin(down), numpy.cos(down) * level, -numpy.sin(across) * numpy.sin(down)


def studio(width, height, turn):
    """Soft boxes, walls and a floor, like those of Zoneplate's default light.

    Its front is turned about +y by `turn`, to the side of the camera.
    """
    x, y, z = directions(width, height)
    d = numpy.stack((x * numpy.cos(turn) - z * numpy.sin(turn), y, x * numpy.sin(turn) + z * numpy.cos(turn)), 2)

    def smooth(begin, end, at):
        t = numpy.clip((at - begin) / (end - begin), 0, 1)
        return t * t * (3 - 2 * t)

    light = 0.12 + 0.06 * smooth(-0.1, 1, d[..., 1]) + 0.40 * smooth(0.25, 1, d[..., 2])
    light += 0.20 * smooth(0.02, -0.75, d[..., 1]) * (0.8 + 0.2 * d[..., 2])
    for towards, half_width, half_height, radiance, softness in (
        ((-0.58, 0.62, 0.53), 0.42, 0.36, 3.2, 0.12),
        ((0.10, 1.00, -0.20), 0.80, 0.26, 1.4, 0.20),
        ((1.00, 0.12, 0.42), 0.36, 0.80, 1.0, 0.25),
        ((-0.64, 0.22, -0.94), 0.13, 0.90, 3.0, 0.20),
        ((0.62, 0.30, -0.96), 0.13, 0.90, 3.0, 0.20),
    ):
        axis = numpy.array(towards) / numpy.linalg.norm(towards)
        right = numpy.cross((0, 1, 0), axis)
        right /= numpy.linalg.norm(right)
        ahead = numpy.maximum(d @ axis, 1e-9)
        u, v = abs(d @ right) / (ahead * half_width), abs(d @ numpy.cross(axis, right)) / (ahead * half_height)
        edges = [1 - smooth(1 - softness, 1 + softness, t) for t in (u, v)]
        falloff = 1 - 0.2 * numpy.minimum(u * u + v * v, 2)
        light += numpy.where(ahead > 0.05, radiance * edges[0] * edges[1] * falloff, 0)
    return numpy.repeat(light[..., None], 3, 2)


def write_radiance(path, image):
    """An .hdr file (RGBE), and the image as its codes are."""
    exponent = numpy.ceil(numpy.log2(image.max(2) * 1.01))
    codes = numpy.floor(image * numpy.exp2(8 - exponent)[..., None]).astype(numpy.uint8)
    rgbe = numpy.concatenate((codes, (exponent + 128).astype(numpy.uint8)[..., None]), 2)
    head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n".format(*image.shape[:2])
    path.write_bytes(head.encode() + rgbe.tobytes())
    return codes * numpy.exp2(exponent - 8)[..., None]


def light_of_ground(image):
    """The radiance of a white diffuse ground under the upper half of an equirectangular image."""
    height, width = image.shape[:2]
    edges = numpy.arange(height + 1) * numpy.pi / height
    cosine = numpy.clip(numpy.cos(edges), 0, None) ** 2
    weight = (cosine[:-1] - cosine[1:]) / width  # 1 / pi times the integral of the cosine over a pixel
    return (image * weight[:, None, None]).sum((0, 1))


class Shots:
    def __init__(self, arguments):
        self.arguments = arguments
        self.work = pathlib.Path(arguments.work).resolve()
        self.work.mkdir(parents=True, exist_ok=True)
        self.environment = self.work / "studio.hdr"
        self.light = light_of_ground(write_radiance(self.environment, studio(512, 256, numpy.radians(30))))

    def zoneplate(self, model, output, size, *options):
        return run([self.arguments.zoneplate, model, "--size", size, "--quiet", "-o", output, *options])

    def blender(self, job):
        path = self.work / "job.json"
        path.write_text(json.dumps({"threads": self.arguments.threads, **job}), encoding="utf-8")
        script = ["--python-exit-code", "1", "--python", here / "scene.py", "--", path]
        return run(["blender", "--background", "--factory-startup", *script])

    def as_glb(self, model):
        if model != "monkey" and not model.endswith(".obj"):
            return pathlib.Path(model).resolve()
        output = self.work / (pathlib.Path(model).stem + ".glb")
        if not output.exists():
            source = model if model == "monkey" else str(pathlib.Path(model).resolve())
            self.blender({"convert": True, "model": source, "output": str(output)})
        return output

    def view(self, model):
        """The camera that Zoneplate chooses, its ground, and the pixels of the model in images of the error."""
        exr = self.work / "view.exr"
        self.zoneplate(model, exr, self.arguments.error_size, "--aa", "none")
        world = exr_matrix(exr, "worldToCamera")
        position = -world[:3, :3] @ world[3, :3]
        right, up, ahead = world[:3, 0], world[:3, 1], world[:3, 2]
        info = json.loads(subprocess.check_output([self.arguments.zoneplate, "info", str(model), "--json"]))
        low, high = (numpy.array(info["bounds"][side]) for side in ("min", "max"))
        diagonal = float(numpy.linalg.norm(high - low))
        centre = (low + high) / 2
        centre[1] = low[1] - diagonal * 2**-13
        camera = {
            "position": position.tolist(), "right": right.tolist(), "up": up.tolist(), "back": (-ahead).tolist(),
            "focal_point": (position + ahead * diagonal).tolist(), "view_angle": float(numpy.radians(30)),
            "near": diagonal / 100, "far": diagonal * 100,
        }
        albedo = decode_srgb(background) / self.light
        ground = {"centre": centre.tolist(), "half_side": 6 * diagonal, "albedo": albedo.tolist()}
        return camera, ground, diagonal

    def mask(self, model, size, camera):
        """The pixels of the model."""
        pfm = self.work / "mask.pfm"
        light = ["--environment", "#fff", "--background-color", "#000"]
        self.zoneplate(model, pfm, size, "--aa", "none", *light, *camera_options(camera))
        return read_pfm(pfm).max(2) > 0

    def draw_zoneplate(self, model, camera, diagonal):
        """Times and error of an image of best quality, its codes, and those of a small converged image."""
        size = self.arguments.size
        far = f"distance={rays_far * diagonal:.6g}"
        common = ["--quality", "best", "--hdri-file", self.environment, "--background-color", "#e8e6e0",
                  "--threads", self.arguments.threads, *camera_options(camera)]
        best = [*common, "--ambient-occlusion", f"rays:samples=64,spacing=8,{far}"]
        rays = f"rays:samples={self.arguments.rays // shaded_samples**2},{far}"
        many = [*common, "--aa", f"ssaa:n={shaded_samples}", "--ambient-occlusion", rays]
        picture, linear = self.work / "zoneplate.png", self.work / "zoneplate.pfm"
        self.zoneplate(model, picture, size, *best)  # filters and caches the environment
        times = [self.zoneplate(model, picture, size, *best) for _ in range(self.arguments.rounds)]
        images = []
        for of_size, options in ((size, best), (size, many), (self.arguments.error_size, many)):
            self.zoneplate(model, linear, of_size, *options)
            images.append(encode(read_pfm(linear)))
        image, converged, small = images
        return {**median(times), **errors(image, converged, self.mask(model, size, camera))}, image, small

    def draw_cycles(self, model, camera, ground):
        """Small images of each number of samples and of the reference, with seeds of their own, and times of a sample.

        The noise of a pixel does not depend on the size of the image, the time does.
        """
        job = {"model": str(model), "camera": camera, "ground": ground, "environment": str(self.environment),
               "times": str(self.work / "times.json")}

        def draw(size, numbers):
            shots = [{"samples": n, "seed": i, "output": str(self.work / f"cycles-{i}.npy")}
                     for i, n in enumerate(numbers)]
            whole = self.blender({**job, "size": [int(n) for n in size.split("x")], "shots": shots})
            return json.loads((self.work / "times.json").read_text()), whole

        small, _ = draw(self.arguments.error_size, [*self.arguments.samples, self.arguments.reference])
        for shot in small:
            shot["image"] = encode_over(numpy.load(shot["output"]))
        timed, whole = draw(self.arguments.size, self.arguments.timed)
        begin = {key: whole[key] - sum(shot[key] for shot in timed) for key in ("cpu", "wall")}
        return small, timed, begin

    def compare(self, name):
        model = self.as_glb(name)
        camera, ground, diagonal = self.view(model)
        ours, image, converged = self.draw_zoneplate(model, camera, diagonal)
        mask = self.mask(model, self.arguments.error_size, camera)
        shots, timed, begin = self.draw_cycles(model, camera, ground)
        *shots, reference = shots
        result = {"model": pathlib.Path(name).stem, "zoneplate": ours, "cycles": [], "cycles_begin": begin}
        for shot in shots:
            # Both are noisy, and independent: the reference's part of the mean square is that of its samples.
            noise = numpy.sqrt(1 / (1 + shot["samples"] / reference["samples"]))
            error = {key: value * noise for key, value in errors(shot["image"], reference["image"], mask).items()}
            result["cycles"].append({"samples": shot["samples"], **time_of(shot["samples"], timed), **error})
        result["timed"] = [{key: shot[key] for key in ("samples", "cpu", "wall")} for shot in timed]
        result["converged"] = errors(converged, reference["image"], mask)
        for area in ("all", "model"):
            samples = samples_of_error(result["cycles"], ours[area], area)
            result["equal_" + area] = {"samples": samples, **time_of(samples, timed)}
        self.save(result["model"], {"zoneplate": image, "zoneplate-converged": converged,
                                    "cycles-converged": reference["image"],
                                    **{f"cycles-{s['samples']}": s["image"] for s in shots}})
        return result

    def save(self, model, images):
        if not self.arguments.pictures:
            return
        folder = pathlib.Path(self.arguments.pictures)
        folder.mkdir(parents=True, exist_ok=True)
        for name, codes in images.items():
            write_png(folder / f"{model}-{name}.png", codes)


def write_png(path, codes):
    rows = numpy.clip(numpy.round(codes), 0, 255).astype(numpy.uint8)
    height, width = rows.shape[:2]
    packed = zlib.compress(b"".join(b"\0" + row.tobytes() for row in rows))
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, data in ((b"IHDR", head), (b"IDAT", packed), (b"IEND", b"")):
            file.write(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)))


def camera_options(camera):
    point = lambda name: ",".join(f"{x:.9g}" for x in camera[name])
    return ["--camera-position=" + point("position"), "--camera-focal-point=" + point("focal_point"),
            "--camera-view-angle", 30]


def encode(linear):
    return encode_srgb(linear) * 255


def encode_over(rgba):
    """The codes of premultiplied linear RGBA over the background."""
    return encode(rgba[..., :3] + (1 - rgba[..., 3:]) * decode_srgb(background))


def errors(image, reference, mask):
    squares = ((image - reference) ** 2).mean(2)
    return {"all": float(numpy.sqrt(squares.mean())), "model": float(numpy.sqrt(squares[mask].mean()))}


def samples_of_error(shots, error, area):
    """The number of samples with which Cycles has this error: the logarithms of two neighbours are on a line."""
    count, wrong = (numpy.log([shot[key] for shot in shots]) for key in ("samples", area))
    i = int(numpy.clip(numpy.searchsorted(-wrong, -numpy.log(error)), 1, len(shots) - 1))
    slope = (count[i] - count[i - 1]) / (wrong[i] - wrong[i - 1])
    return float(numpy.exp(count[i] + slope * (numpy.log(error) - wrong[i])))


def time_of(samples, timed):
    """A render's time: a constant, and a part for each sample."""
    few, many = timed[0], timed[-1]
    along = (samples - few["samples"]) / (many["samples"] - few["samples"])
    return {key: few[key] + along * (many[key] - few[key]) for key in ("cpu", "wall")}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("zoneplate")
    parser.add_argument("work")
    parser.add_argument("--size", default="1024x768")
    parser.add_argument("--error-size", default="160x120", help="of Cycles' images whose error is measured")
    numbers = lambda text: [int(n) for n in text.split(",")]
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--rays", type=int, default=512, help="of each pixel of Zoneplate's converged image")
    parser.add_argument("--samples", type=numbers, default=[16, 64, 256])
    parser.add_argument("--timed", type=numbers, default=[2, 6], help="samples of images whose time is measured")
    parser.add_argument("--reference", type=int, default=512, help="samples of Cycles' converged image")
    parser.add_argument("--pictures", help="folder for the images")
    parser.add_argument("models", nargs="+", help=".gltf, .glb, .obj, or monkey: Blender's, of a million triangles")
    arguments = parser.parse_args()
    shots = Shots(arguments)
    for model in arguments.models:
        print(json.dumps(shots.compare(model)), flush=True)


if __name__ == "__main__":
    main()
