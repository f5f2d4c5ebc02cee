# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares frames of the flight through the kitchen, and joins contact sheet and curves to one picture.

.venv/bin/python tools/measure/sequence/draw_sequence.py DIR PICTURE.jpg
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[3]
QUALITY, WIDTH = 72, 900
FRAMES = "70-75"


def main() -> None:
    parser = argparse.ArgumentParser(description="Compares frames of the kitchen and draws sheet and curves.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("picture", type=Path)
    asked = parser.parse_args()
    scene = asked.folder / "kitchen.blend"
    if not scene.is_file():
        # (Saved anew it would be another file, of which no frame is there.)
        _run("make_scenes.py", str(asked.folder), "kitchen")
    given = ("--reflector", "Pot", "--method", "auto,secant_star", "--sub-frames", "32", "--samples", "256")
    size = ("--peers", "cycles16,cycles64", "--resolution", "160x120", "--frames", FRAMES, "--resume")
    output = asked.folder / "compared"
    _run("run_verb.py", "--", "compare", str(scene), *given, *size, "--output", str(output))
    parts = [Image.open(output / f"{name}.png").convert("RGB") for name in ("contact_sheet", "curves")]
    parts = [part.resize((WIDTH, part.height * WIDTH // part.width), Image.Resampling.LANCZOS) for part in parts]
    whole = Image.new("RGB", (WIDTH, sum(part.height for part in parts)))
    for number, part in enumerate(parts):
        whole.paste(part, (0, number * parts[0].height))
    whole.save(asked.picture, quality=QUALITY)


def _run(*arguments: str) -> None:
    tool, *rest = arguments
    subprocess.run([sys.executable, str(ROOT / "tools" / tool), *rest], cwd=ROOT, check=True)


if __name__ == "__main__":
    main()
