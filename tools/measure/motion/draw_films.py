# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the papers' animations: a row for each, three frames by us and the last of these by Cycles.

    python tools/measure/motion/draw_films.py OUT.jpg

In full light, with as many samples of ours as are said here.
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

FRAMES = {
    "kitchen": (1, 60, 92),
    "city": (1, 50, 110),
    "ants": (20, 60, 100),
    "hand": (30, 55, 80),
    "chairs": (1, 60, 110),
}
SIZE = (240, 180)
SAMPLES, REFERENCE = 16, 64
QUALITY = 85


def main(picture: Path) -> None:
    with tempfile.TemporaryDirectory() as work:
        rows = [_row(Path(work), name) for name in FRAMES]
    sheet = Image.new("RGB", (4 * SIZE[0], len(rows) * SIZE[1]))
    for row, pictures in enumerate(rows):
        for column, part in enumerate(pictures):
            sheet.paste(part, (column * SIZE[0], row * SIZE[1]))
    sheet.save(picture, quality=QUALITY)


def _row(folder: Path, name: str) -> list[Image.Image]:
    _run("make_scenes.py", str(folder), name)
    file, mirrors = str(folder / f"{name}.blend"), ",".join(ANIMATIONS[name].mirrors)
    size = f"{SIZE[0]}x{SIZE[1]}"
    *first, last = FRAMES[name]
    found = []
    for frame in first:
        given = ("--reflector", mirrors, "--frame", str(frame), "--resolution", size, "--samples", str(SAMPLES))
        out = folder / f"{name}_{frame}.png"
        _run("run_verb.py", "--", "render", file, *given, "--output", str(out))
        found.append(out)
    given = ("--reflector", mirrors, "--frame", str(last), "--resolution", size, "--method", "auto")
    samples = ("--sub-frames", str(SAMPLES), "--samples", str(REFERENCE), "--peers", "none")
    _run("run_verb.py", "--", "compare", file, *given, *samples, "--output", str(folder / name))
    found += [folder / name / "auto.png", folder / name / "reference.png"]
    return [_opened(path) for path in found]


def _opened(path: Path) -> Image.Image:
    with Image.open(path) as opened:
        return opened.convert("RGB").resize(SIZE)


def _run(tool: str, *arguments: str) -> None:
    subprocess.run([sys.executable, str(ROOT / "tools" / tool), *arguments], check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
