# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Writes the test scenes and the demo as .blend files.

    .venv/bin/python tools/make_scenes.py OUTDIR [NAME ..]

Without names: sphere, ellipsoid, bumpy and demo. `dense` (a mirror of 130,000 triangles), `torus` and `bowl` (mirrors
that show themselves), `lamps` (point lamp, spot and sun in the dark), `million` (a million vertices) and `hidden` (one
small file per hidden-surface case) are written when asked for, and `anamorphosis`: a cylinder on paper, and a picture
that it could show. So are the papers' animations:
`kitchen`, `city`, `ants`, `hand` and `chairs`.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import bootstrap
import bpy

bootstrap.load_package()
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from curvrefl.curvrefl_addon.demo.anamorphosis import build_anamorphosis, picture  # noqa: E402
from curvrefl.curvrefl_addon.demo.scene import build_demo  # noqa: E402
from curvrefl.curvrefl_addon.design.anamorphosis.png_file import png_bytes  # noqa: E402
from scenes.animations.films import ANIMATIONS  # noqa: E402
from scenes.builders import SCENES, build_case  # noqa: E402
from scenes.hidden_surfaces import CASES  # noqa: E402

OTHERS = ("demo", "anamorphosis", "hidden", *ANIMATIONS)
USUAL = ("sphere", "ellipsoid", "bumpy", "demo")


def write(name: str, folder: Path) -> list[Path]:
    """Build one scene, or all hidden-surface cases, and save it in `folder`. Returns the files."""
    if name == "hidden":
        files = []
        for case in CASES.values():
            build_case(case())
            files.append(_save(folder / f"hidden_{case.__name__}.blend"))
        return files
    path = folder / f"{name}.blend"
    if name == "demo":
        build_demo(path)
        return [path]
    if name == "anamorphosis":
        build_anamorphosis()
        shown = folder / f"{name}.png"
        shown.write_bytes(png_bytes(picture()))
        return [_save(path), shown]
    if name in ANIMATIONS:
        ANIMATIONS[name].build()
    else:
        SCENES[name]()
    return [_save(path)]


def _save(path: Path) -> Path:
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True)
    return path


def main() -> None:
    parser = argparse.ArgumentParser(description="Writes the test scenes and the demo as .blend files.")
    parser.add_argument("folder", type=Path, metavar="OUTDIR")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join([*SCENES, *OTHERS]))
    arguments = parser.parse_args()
    unknown = [name for name in arguments.names if name not in {*SCENES, *OTHERS}]
    if unknown:
        parser.error(f"there is no scene {unknown[0]!r}")
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for name in arguments.names or USUAL:
        for path in write(name, arguments.folder.resolve()):
            print(path)


if __name__ == "__main__":
    main()
