# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the launcher runs, in a Python or in a Blender: the command line on the arguments after `--`."""

from __future__ import annotations

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bootstrap  # noqa: E402

bootstrap.load_package()

from curvrefl.curvrefl_addon import cli  # noqa: E402

arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
code = cli.main(arguments)
sys.stdout.flush()
sys.stderr.flush()
# Blender's own tear-down of a headless GPU context can crash or print; everything of ours is closed by now.
os._exit(code)
