# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""open_files.py OUTPUT FILE..: the verb `render` on each file, one after the other, as it is run in Blender.

Prints "START n" before a file and "END n CODE" after it; see fuzz_files.py, which is told so where this process died.
"""

from __future__ import annotations

import os
import resource
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))

import bootstrap
import bpy  # noqa: F401  (before gpu)

bootstrap.load_package()

from curvrefl.curvrefl_addon.command import cli  # noqa: E402

MOST_MEMORY = 12 << 30
"""Bytes of addresses, more than a small picture takes: a damaged count must not take the machine's"""


def main(output: Path, files: list[str]) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    told = os.fdopen(os.dup(1), "w")
    for number, file in enumerate(files):
        print("START", number, file=told, flush=True)
        arguments = ["render", file, "--reflector", "Mirror Ball", "--samples", "1", "--resolution", "16x12"]
        code = cli.main([*arguments, "--output", str(output / "picture.png")])
        print("END", number, code, file=told, flush=True)
    told.flush()
    os._exit(0)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
