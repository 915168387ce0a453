# SPDX-License-Identifier: Apache-2.0
"""Renders a product shot: product_shot.py MODEL SKY.hdr OUT.webp"""

import sys

import zoneplate

model, sky, out = sys.argv[1:]
look = {"hdri_file": sky, "lights": "both", "shadows": "soft:samples=16", "ground": "shadow"}
zoneplate.render_file(model, out, size=(400, 400), turntable=12, **look)
