# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""pytest with the arguments given, ended without Python's teardown.

Blender as a module may crash while Python collects the last objects at its end, when the tests' result has long been
reported; the exit code would then say that they failed.
"""

from __future__ import annotations

import os
import sys

import pytest

if __name__ == "__main__":
    code = int(pytest.main(sys.argv[1:]))
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
