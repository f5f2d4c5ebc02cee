# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compiles jobs by a job type as Flamenco's Manager does, with Node in place of its own engine."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from curvrefl.curvrefl_addon.farm.bundle import FLAMENCO_JOB_TYPE

MANAGER = Path(__file__).with_suffix(".js")


class RefusedError(Exception):
    """The job is not compiled; the message is the Manager's."""


def compile_job(settings: dict[str, Any], job_type: Path = FLAMENCO_JOB_TYPE) -> dict[str, Any]:
    """`settings` of the job type, and `tasks` with their commands; skips the test where there is no Node."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("there is no Node to compile job types")
    command = [node, str(MANAGER), str(job_type), json.dumps(settings)]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        raise RefusedError(result.stderr.strip())
    return json.loads(result.stdout)
