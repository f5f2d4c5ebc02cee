# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: proofs of the device as it would be without what it has, and of a wrong one.

Arguments after `--`: the zip, the folder for what was seen.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import patch

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from scripted import Script, arguments, extension, install, play

ARCHIVE, FOLDER = arguments()[:2]
seen: dict[str, Any] = {}


def proofs_without(*missing: str) -> dict[str, Any]:
    """How all proofs come out on a device that lacks these."""
    features = extension("curvrefl_addon.renderer.device.ways.features")
    proving = extension("curvrefl_addon.renderer.proofs.proving")
    verdict = extension("curvrefl_addon.renderer.proofs.verdict")
    before = verdict.Verdict(failures=tuple(verdict.Failure(f"no {name}", "", name) for name in missing))
    run = proving.Proving(before=before)
    slices = sum(1 for _ in run.work())
    failures = [item.name for item in run.verdict.failures if not item.name.startswith("no ")]
    return {"found": run.found, "failures": failures, "slices": slices, "used": features.features().missing}


def without_atomics() -> dict[str, Any]:
    """What the operator makes of a driver whose image atomics do nothing, and what it copies."""
    shaders = extension("curvrefl_addon.renderer.device.shaders")
    features = extension("curvrefl_addon.renderer.device.ways.features")
    verdict = extension("curvrefl_addon.renderer.proofs.verdict")
    load: Callable[..., Any] = shaders.load

    def wrongly(*parts: Any) -> Any:
        source = load(*parts)
        text = source.text.replace("imageAtomicAdd(straggler_count, ivec2(0), 1u)", "0u")
        return type(source)(text, source.places)

    clear = extension("curvrefl_addon.gpu_caches").clear_gpu_caches
    clear()
    with patch.object(shaders, "load", wrongly):
        bpy.ops.curvrefl.copy_report()
    clear()
    missing = features.features().missing
    copied = bpy.context.window_manager.clipboard
    message = verdict.known_verdict().sentence
    bpy.ops.curvrefl.copy_report()
    return {"missing": missing, "report": copied, "message": message, "after": features.features().missing}


def script() -> Script:
    install(ARCHIVE)
    yield 1.0
    seen["without all"] = proofs_without("compute", "quads", "fits")
    yield 0.1
    seen["without atomics"] = proofs_without("atomics")
    yield 0.1
    seen["operator"] = without_atomics()


def finish(error: str) -> None:
    seen["error"] = error
    (Path(FOLDER) / "seen.json").write_text(json.dumps(seen))
    bpy.ops.wm.quit_blender()


play(script(), finish)
