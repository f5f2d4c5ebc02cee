# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes docs/nodes.md: has Cycles judge every node in every mode, in two minutes.

    .venv/bin/python tools/nodes/write_nodes.py

Ends with 1 where a node is wrong and does not say so.
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests"), str(ROOT / "tests" / "blender")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402, F401  (before gpu)

bootstrap.load_package()

from curvrefl.curvrefl_addon.command.inputs import STDOUT, dropped  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from nodes.page import PAGE, mode_of, page  # noqa: E402
from nodes.shaders import judged_shaders  # noqa: E402
from nodes.table import BATCHES, judged_rows  # noqa: E402


def main() -> int:
    """Judges, writes, says what is silently wrong."""
    require_gpu()
    judged = []
    for name, rows in BATCHES.items():
        with dropped(STDOUT):
            found = judged_rows(rows)
        print(f"{name}: {sum(item.is_drawn for item in found)} of {len(found)} are drawn", flush=True)
        judged += found
    with dropped(STDOUT):
        shaders = judged_shaders()
    print(f"shaders: {sum(item.is_right for item in shaders)} of {len(shaders)} are drawn", flush=True)
    PAGE.write_text(page(judged, shaders), encoding="utf-8")
    wrong = [item for item in judged if item.is_silently_wrong]
    for item in wrong:
        print(f"{item.row.node}, {mode_of(item)}: silently wrong, {'; '.join(map(str, item.verdicts))}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
