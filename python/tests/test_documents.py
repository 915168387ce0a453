# SPDX-License-Identifier: Apache-2.0
"""The notebook and the programs of docs/python.md and README.md run; stubs, docstrings and the wheel are complete."""

import ast
import base64
import hashlib
import importlib
import inspect
import io
import json
import os
import pathlib
import re
import shutil
import struct
import tempfile
import unittest
import warnings
import zipfile
from contextlib import redirect_stdout

import zoneplate
from zoneplate import _native

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WHEEL = pathlib.Path(os.environ["ZONEPLATE_WHEEL"])


def write_glb(path, gltf):
    """A GLB of a glTF file whose buffer is a data URI."""
    document = json.loads(gltf.read_text())
    binary = base64.b64decode(document["buffers"][0].pop("uri").split(",", 1)[1])
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def run_cell(source, names):
    """Runs a cell; returns the value of its last line, if that is an expression."""
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    return eval(compile(ast.Expression(last.value), "cell", "eval"), names) if last else None


class Documents(unittest.TestCase):
    def test_the_notebook_runs(self):
        notebook = json.loads((ROOT / "python/antialiasing.ipynb").read_text())
        self.assertEqual(notebook["nbformat"], 4)
        names, pictures = {}, 0
        for cell in notebook["cells"]:
            if cell["cell_type"] == "code":
                self.assertEqual(cell["outputs"], [])
                value = run_cell("".join(cell["source"]), names)
                if hasattr(value, "_repr_png_"):
                    self.assertTrue(value._repr_png_().startswith(b"\x89PNG"))
                    pictures += 1
        self.assertEqual(pictures, 5)

    def test_the_programs_of_the_document_run(self):
        text = (ROOT / "docs/python.md").read_text() + (ROOT / "README.md").read_text()
        programs = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        self.assertGreater(len(programs), 7)
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                write_glb(pathlib.Path("chair.glb"), ROOT / "examples/triangle.gltf")
                shutil.copy(ROOT / "tests/options/sky.hdr", "sky.hdr")
                names = {}
                with redirect_stdout(io.StringIO()):
                    for program in programs:
                        exec(compile(program, "docs/python.md", "exec"), names)
                self.assertTrue(pathlib.Path("chair-270.webp").exists())
            finally:
                os.chdir(before)

    def test_public_names_have_docstrings(self):
        for name in zoneplate.__all__:
            value = getattr(zoneplate, name)
            self.assertTrue(inspect.getdoc(value), name)
            if inspect.isclass(value) and value.__module__.startswith("zoneplate._"):
                for member, function in vars(value).items():
                    if not member.startswith("_") and (callable(function) or isinstance(function, property)):
                        self.assertTrue(inspect.getdoc(function), f"{name}.{member}")

    def test_stubs_are_complete(self):
        stub = ast.parse((ROOT / "python/zoneplate/_native.pyi").read_text())
        members = {"": set()}
        for node in stub.body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                members[""].add(node.name)
            elif isinstance(node, ast.AnnAssign):
                members[""].add(node.target.id)
            if isinstance(node, ast.ClassDef):
                members[node.name] = {m.name for m in node.body if isinstance(m, ast.FunctionDef)}
        public = lambda names: {n for n in names if not n.startswith("__") or "dlpack" in n}
        self.assertEqual(public(members[""]), public(vars(_native)))
        for name in ("Array", "Image", "Scene"):
            self.assertEqual(public(members[name]), public(vars(getattr(_native, name))))
        for function in (zoneplate.load, zoneplate.measure, zoneplate.compare):
            unannotated = [p for p in inspect.signature(function).parameters.values() if p.annotation is p.empty]
            self.assertEqual(unannotated, [])
        # Those whose keywords are the rows of a table have a stub.
        jobs = ast.parse((ROOT / "python/zoneplate/_jobs.pyi").read_text())
        functions = {node.name: node.args for node in jobs.body if isinstance(node, ast.FunctionDef)}
        self.assertLessEqual({"render", "render_frames", "render_file"}, set(functions))
        for name, args in functions.items():
            unannotated = [a.arg for a in args.posonlyargs + args.args + args.kwonlyargs if a.annotation is None]
            self.assertEqual(unannotated, [], name)

    def test_the_wheel(self):
        print(f"\n{WHEEL.name}: {WHEEL.stat().st_size / 1e6:.2f} MB")
        self.assertLessEqual(WHEEL.stat().st_size, 8 << 20)
        self.assertRegex(WHEEL.name, r"^zoneplate-[\d.]+-cp311-abi3-manylinux_2_\d+_\w+\.whl$")
        with zipfile.ZipFile(WHEEL) as wheel:
            names = wheel.namelist()
            record = [n for n in names if n.endswith("RECORD")][0]
            rows = [line.split(",") for line in wheel.read(record).decode().splitlines()]
            self.assertEqual(sorted(row[0] for row in rows), sorted(names))
            for name, digest, size in rows:
                if name != record:
                    data = wheel.read(name)
                    expected = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
                    self.assertEqual((digest, size), (f"sha256={expected}", str(len(data))))
            self.assertIn("zoneplate/py.typed", names)
            self.assertTrue(any(name.endswith("licenses/THIRD_PARTY.md") for name in names))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            importlib.reload(zoneplate)


if __name__ == "__main__":
    unittest.main()
