# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the picture of docs/anamorphosis.md: a picture, the sheet for a cylinder, and four mirrors that show it.

.venv/bin/python tools/measure/design/draw_anamorphosis.py FILE.jpg
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools"))

import bootstrap  # noqa: E402

bootstrap.load_package()

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from curvrefl.curvrefl_addon.demo.anamorphosis import (  # noqa: E402
    EYES,
    MIRROR,
    PAPER,
    build_anamorphosis,
    picture,
)
from curvrefl.curvrefl_addon.demo.data_blocks import looking  # noqa: E402
from curvrefl.curvrefl_addon.design.anamorphosis.png_file import png_bytes  # noqa: E402
from curvrefl.curvrefl_addon.design.anamorphosis.results import (  # noqa: E402
    picture_material,
    put_on,
)
from mathutils import Matrix  # noqa: E402

SIZE = (400, 300)
SHOWN = {"cylinder": (-0.09, 62.0), "cone": (0.0, 62.0), "sphere": (0.0, 85.0), "free_form": (-0.08, 62.0)}
"""How far before the mirror the camera is turned to, and its focal length, so that the sheet is seen beside the mirror
from the same place"""
SCALES = {"sphere": 0.45}
QUALITY = 88
WHITE = (255, 255, 255)


def verb(*arguments: str) -> None:
    subprocess.run([sys.executable, str(ROOT / "tools" / "run_verb.py"), "--", *arguments], cwd=ROOT, check=True)


def shown(shape: str, folder: Path) -> Path:
    """A rendering of a mirror and of its sheet, both made by verbs."""
    build_anamorphosis(shape, *SIZE)
    file, own = folder / f"{shape}.blend", folder / shape
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    scale = str(SCALES.get(shape, 0.7))
    given = ("--picture", str(folder / "picture.png"), "--size", "2048", "--scale", scale, "--output", str(own))
    verb("anamorphosis", str(file), "--mirror", MIRROR, "--surface", PAPER, *given)
    image = bpy.data.images.load(str(own / f"{PAPER}.png"))
    paper = bpy.data.objects[PAPER]
    put_on(paper, picture_material("Print", image, "", "PRINCIPLED", (0.8, 0.8, 0.8), is_clipped=False))
    camera: Any = bpy.context.scene.camera.data
    ahead, camera.lens = SHOWN[shape]
    eye, target, _ = EYES[shape]
    turned = looking(eye, np.add(target, (0.0, ahead, 0.0)))
    bpy.context.scene.camera.matrix_world = Matrix(turned.tolist())
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    rendered = folder / f"{shape}.png"
    verb("render", str(file), "--reflector", MIRROR, "--samples", "16", "--output", str(rendered))
    return rendered


def main() -> None:
    from PIL import Image

    with tempfile.TemporaryDirectory() as work:
        folder = Path(work)
        (folder / "picture.png").write_bytes(png_bytes(picture(512)))
        renderings = [shown(shape, folder) for shape in SHOWN]
        width, height = SIZE
        canvas = Image.new("RGB", (3 * width, 2 * height), WHITE)
        square = height - 20
        for column, path in enumerate((folder / "picture.png", folder / "cylinder" / f"{PAPER}.png")):
            with Image.open(path) as opened:
                part = opened.convert("RGBA")
            part = part.crop(part.getbbox()) if column else part
            part.thumbnail((width - 20, square), Image.Resampling.LANCZOS)
            place = (column * width + (width - part.width) // 2, (height - part.height) // 2)
            canvas.paste(part, place, part)
        for number, path in enumerate(renderings, 2):
            with Image.open(path) as opened:
                canvas.paste(opened.convert("RGB"), (number % 3 * width, number // 3 * height))
        canvas.save(sys.argv[1], quality=QUALITY)


if __name__ == "__main__":
    main()
