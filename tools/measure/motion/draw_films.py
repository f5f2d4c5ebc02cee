# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of the papers' animations: stills of each, in full light.

python tools/measure/motion/draw_films.py OUT.jpg
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests")]

import bootstrap  # noqa: E402

bootstrap.load_package()

import bpy  # noqa: E402, F401  (before the scenes)
from PIL import Image  # noqa: E402
from scenes.animations.films import ANIMATIONS  # noqa: E402

STILLS = (("kitchen", 60), ("kitchen", 92), ("city", 100), ("ants", 60), ("hand", 70), ("chairs", 90))
COLUMNS = 3
SIZE, DRAWN = (400, 300), (320, 240)
"""Of each as it is rendered, and as it is shown"""
SAMPLES = 8
QUALITY = 85


def main(picture: Path) -> None:
    sheet = Image.new("RGB", (COLUMNS * DRAWN[0], -(-len(STILLS) // COLUMNS) * DRAWN[1]))
    with tempfile.TemporaryDirectory() as work:
        _run("make_scenes.py", work, *dict(STILLS))
        for number, (name, frame) in enumerate(STILLS):
            row, column = divmod(number, COLUMNS)
            still = _still(Path(work), name, frame)
            sheet.paste(still, (column * DRAWN[0], row * DRAWN[1]))
    sheet.save(picture, quality=QUALITY)


def _still(folder: Path, name: str, frame: int) -> Image.Image:
    out = folder / f"{name}_{frame}.png"
    given = ("--reflector", ",".join(ANIMATIONS[name].mirrors), "--frame", str(frame))
    size = ("--resolution", f"{SIZE[0]}x{SIZE[1]}", "--samples", str(SAMPLES))
    _run("run_verb.py", "--", "render", str(folder / f"{name}.blend"), *given, *size, "--output", str(out))
    with Image.open(out) as opened:
        return opened.convert("RGB").resize(DRAWN, Image.Resampling.LANCZOS)


def _run(tool: str, *arguments: str) -> None:
    subprocess.run([sys.executable, str(ROOT / "tools" / tool), *arguments], check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
