# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plays the papers' animations in a Blender window, with the mirrors on, and says what a redraw takes.

    python tools/measure/motion/play_in_window.py OUTDIR [NAME ..] [--every 17]

Blender is found as for the tests in a window (`tools/window_blender.py`). OUTDIR/NAME gets pictures of the window and
`seen.json`: milliseconds of each frame (the scene brought to it, the whole view drawn), by which methods, how many
pixels of mirrors, and how many of these are no color.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests" / "gui")]

import bootstrap  # noqa: E402

bootstrap.load_package()

import build_extension  # noqa: E402
from window import run_session  # noqa: E402
from window_blender import NoWindowBlenderError, find_or_make  # noqa: E402

NAMES = ("kitchen", "city", "ants", "hand", "chairs")
SIZE = (640, 480)
"""Of the window"""


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path, metavar="OUTDIR")
    parser.add_argument("names", nargs="*", metavar="NAME", default=NAMES)
    parser.add_argument("--every", type=int, default=17, help="frames between two pictures of the window")
    given = parser.parse_args()
    try:
        blender = find_or_make()
    except NoWindowBlenderError as error:
        raise SystemExit(f"There is no Blender that opens a window: {error}.") from error
    session = Path(__file__).resolve().parent / "film_session.py"
    for name in given.names:
        folder = (given.folder / name).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        make = [sys.executable, str(ROOT / "tools" / "make_scenes.py"), str(folder), name]
        subprocess.run(make, check=True, stdout=subprocess.DEVNULL)
        archive = build_extension.build(folder)
        found = run_session(blender, session, folder, archive, folder / f"{name}.blend", folder, given.every, size=SIZE)
        if found.seen["error"]:
            raise SystemExit(f"{name}: {found.seen['error']}")
        milliseconds = np.array(found.seen["ms"])
        middle = float(np.median(milliseconds))
        methods = sorted({method for of in found.seen["methods"] for method in of})
        print(
            f"{name}: {len(milliseconds)} frames, median {middle:.0f} ms, worst {milliseconds.max():.0f} ms "
            f"({milliseconds.max() / middle:.1f} times, frame {found.seen['frames'][int(milliseconds.argmax())]}), "
            f"{found.seen['broken']} broken pixels, {', '.join(methods)}",
            flush=True,
        )


if __name__ == "__main__":
    main()
