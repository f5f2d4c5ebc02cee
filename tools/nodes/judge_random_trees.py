# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Has Cycles judge random node trees: which are wrong and do not say so.

    .venv/bin/python tools/nodes/judge_random_trees.py [COUNT] [--first SEED]

500 trees, which take some three minutes, or COUNT; a tree is made by its seed alone.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests"), str(ROOT / "tests" / "blender")]

import bootstrap  # noqa: E402
import bpy  # noqa: E402, F401  (before gpu)

bootstrap.load_package()

from curvrefl.curvrefl_addon.command.inputs import STDOUT, dropped  # noqa: E402
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu  # noqa: E402
from nodes.judge import judge_all  # noqa: E402
from nodes.random_trees import random_trees  # noqa: E402


def main() -> int:
    """Judges; 1 where one is silently wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", nargs="?", type=int, default=500)
    parser.add_argument("--first", type=int, default=0, help="seed of the first tree")
    options = parser.parse_args()
    require_gpu()
    with dropped(STDOUT):
        verdicts = judge_all(random_trees(options.first, options.count))
    wrong = {name: verdict for name, verdict in verdicts.items() if verdict.is_silently_wrong}
    for name, verdict in wrong.items():
        print(f"{name}: {verdict}")
    noted = sum(bool(verdict.notes) for verdict in verdicts.values())
    print(f"{options.count} trees from seed {options.first}: {len(wrong)} silently wrong, {noted} with notes")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
