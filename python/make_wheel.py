#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the wheel of the package python/zoneplate with its module. Equal inputs give equal bytes.

A wheel is a zip archive (PEP 427); no package of Python is needed to write one.
"""

import argparse
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import time
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SUMMARY = "Software renderer and antialiasing laboratory"


def platform_of(module):
    """The platform tag: manylinux by the newest version of glibc that the module requires (PEP 600)."""
    report = subprocess.run(["objdump", "-T", "-p", module], check=True, capture_output=True, text=True).stdout
    needed = set(re.findall(r"NEEDED +(\S+)", report))
    allowed = {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1", "libpthread.so.0", "libdl.so.2"}
    machine = os.uname().machine
    if not needed <= allowed:
        raise SystemExit(f"make_wheel: {module} needs {', '.join(sorted(needed - allowed))}, which a wheel may not")
    minor = max(int(found) for found in re.findall(r"GLIBC_2\.(\d+)", report))
    return f"manylinux_2_{minor}_{machine}"


def metadata(version):
    # The document without its image and without links to other documents, which a package does not have.
    readme = re.sub(r"^!\[.*\n\n", "", (ROOT / "docs/python.md").read_text(), flags=re.MULTILINE)
    readme = re.sub(r"\[([^\]]*)\]\((?!\w+:)[^)]*\)", r"\1", readme)
    return (
        f"Metadata-Version: 2.1\nName: zoneplate\nVersion: {version}\nSummary: {SUMMARY}\nLicense: Apache-2.0\n"
        "Requires-Python: >=3.11\nRequires-Dist: numpy\nDescription-Content-Type: text/markdown\n"
        "Classifier: License :: OSI Approved :: Apache Software License\n"
        "Classifier: Topic :: Multimedia :: Graphics :: 3D Rendering\n\n" + readme
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--version", required=True)
    parser.add_argument("--module", required=True, type=pathlib.Path)
    parser.add_argument("--output", required=True, type=pathlib.Path, help="a folder")
    arguments = parser.parse_args()

    tag = f"cp311-abi3-{platform_of(arguments.module)}"
    info = f"zoneplate-{arguments.version}.dist-info"
    files = {f"zoneplate/{arguments.module.name}": arguments.module.read_bytes()}
    for path in (ROOT / "python/zoneplate").iterdir():
        if path.suffix in (".py", ".pyi", ".typed") or path.name == "py.typed":
            files[f"zoneplate/{path.name}"] = path.read_bytes()
    files[f"{info}/METADATA"] = metadata(arguments.version).encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: zoneplate\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    for name in ("LICENSE", "THIRD_PARTY.md"):
        files[f"{info}/licenses/{name}"] = (ROOT / name).read_bytes()
    record = ""
    for name in sorted(files):
        digest = base64.urlsafe_b64encode(hashlib.sha256(files[name]).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(files[name])}\n"
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()

    # The time of all files; zip archives begin in 1980.
    seconds = max(int(os.environ.get("SOURCE_DATE_EPOCH", "315532800")), 315532800)
    arguments.output.mkdir(parents=True, exist_ok=True)
    for old in arguments.output.glob("*.whl"):
        old.unlink()
    path = arguments.output / f"zoneplate-{arguments.version}-{tag}.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as wheel:
        for name in sorted(files, key=lambda name: (name.startswith(info), name)):  # the metadata last, as PEP 427 advises
            entry = zipfile.ZipInfo(name, time.gmtime(seconds)[:6])
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            wheel.writestr(entry, files[name])
    print(path)


if __name__ == "__main__":
    main()
