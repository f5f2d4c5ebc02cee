# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tries awkward scenes in a Blender of its own: the picture of Cycles as F12 would make it, and that of the verb.

    attempt.py FOLDER NAME..    one line of JSON each to FOLDER/attempts.jsonl, at a scene's start and at its end

It is a process apart because Blender may crash on such scenes.
"""

from __future__ import annotations

import contextlib
import hashlib
import inspect
import io
import json
import os
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from types import CodeType
from typing import Any

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests")]
import bootstrap  # noqa: E402

bootstrap.load_package()

from curvrefl.curvrefl_addon.command import cli  # noqa: E402
from curvrefl.curvrefl_addon.command.inputs import STDERR, STDOUT, dropped  # noqa: E402
from curvrefl.curvrefl_addon.errors import InputError  # noqa: E402
from curvrefl.curvrefl_addon.gpu_caches import clear_gpu_caches  # noqa: E402
from curvrefl.curvrefl_addon.renderer.frame import Frame  # noqa: E402
from scenes.awkward import SCENES, Awkward  # noqa: E402

REFERENCES = ROOT / "build" / "awkward" / "references"
BLOCK = 4
OFF = 0.08
"""A block of 4 x 4 pixels is off where its mean is off by more than this, of the screen's range, in any channel"""
SEED = 1


def main(folder: Path, names: list[str]) -> None:
    all_finite = watch_frames()
    with (folder / "attempts.jsonl").open("a", encoding="utf-8") as file:
        for name in names:
            print(json.dumps({"name": name}), file=file, flush=True)
            result = attempt(SCENES[name], folder, all_finite)
            print(json.dumps({"name": name} | result), file=file, flush=True)
    clear_gpu_caches()


def attempt(scene: Awkward, folder: Path, all_finite: Callable[[], bool]) -> dict[str, Any]:
    """What comes of a scene: warnings, an error, the share of blocks that are off, whether all is finite."""
    files = folder / "files" / scene.name
    files.mkdir(parents=True, exist_ok=True)
    blend = files / f"{scene.name}.blend"
    start = time.perf_counter()
    with dropped(STDOUT), dropped(STDERR):
        scene.build(files)
        bpy.ops.wm.save_as_mainfile(filepath=str(blend), check_existing=False, compress=False)
        reference = reference_of(scene, blend)
    made = time.perf_counter()
    ours = folder / f"{scene.name}.png"
    ours.unlink(missing_ok=True)
    result: dict[str, Any] = {"reference": str(reference), "picture": str(ours)}
    try:
        result["warnings"] = verb_says(scene, blend, ours)
        result["finite"] = all_finite()
        result["off"] = share_off(shown(ours), shown(reference))
    except InputError as error:
        result["refused"] = str(error)
    except Exception:
        result["crash"] = traceback.format_exc()
    result["seconds"] = (round(made - start, 2), round(time.perf_counter() - made, 2))
    return result


def watch_frames() -> Callable[[], bool]:
    """From now on all pictures are looked at as they leave the renderer: in a file they may have become colors.

    Returns what says whether those since it was asked last are finite.
    """
    original = Frame.color
    seen: list[bool] = []

    def color(frame: Frame) -> np.ndarray:
        pixels = original(frame)
        seen.append(bool(np.isfinite(pixels).all()))
        return pixels

    def all_finite() -> bool:
        if not seen:
            raise RuntimeError("No picture has left the renderer: what is not finite would not be found.")
        answer = all(seen)
        seen.clear()
        return answer

    Frame.color = color  # type: ignore[method-assign, assignment]
    return all_finite


def verb_says(scene: Awkward, blend: Path, output: Path) -> list[str]:
    """Runs the verb `render` as the command line does; returns its warnings."""
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
        code = cli.run(["render", str(blend), "--reflector", ",".join(scene.mirrors), "--output", str(output)])
    if code != 0:
        raise RuntimeError(f"The verb ended with exit code {code}: {said.getvalue()}")
    lines = [line for line in said.getvalue().splitlines() if line.startswith("curvrefl: Warning: ")]
    return [line.removeprefix("curvrefl: Warning: ") for line in lines]


def reference_of(scene: Awkward, blend: Path) -> Path:
    """The picture of Cycles as the screen shows it: kept until the scene's source or Blender changes."""
    said = "\n".join((bpy.app.version_string, source_of(scene.build), str(scene.samples), str(SEED)))
    path = REFERENCES / f"{scene.name}-{hashlib.sha256(said.encode()).hexdigest()[:16]}.png"
    if not path.is_file():
        REFERENCES.mkdir(parents=True, exist_ok=True)
        bpy.ops.wm.open_mainfile(filepath=str(blend), load_ui=False)
        render_cycles(scene.samples, path.with_suffix(f".{os.getpid()}.png"))
        for old in REFERENCES.glob(f"{scene.name}-????????????????.png"):
            old.unlink()
        path.with_suffix(f".{os.getpid()}.png").replace(path)
    return path


def render_cycles(samples: int, path: Path) -> None:
    """F12 of the open file, with so many samples that noise does not count."""
    opened: Any = bpy.context.scene
    opened.render.engine = "CYCLES"
    cycles = opened.cycles
    cycles.device, cycles.samples, cycles.seed = "CPU", samples, SEED
    cycles.use_animated_seed = cycles.use_adaptive_sampling = cycles.use_denoising = False
    settings = opened.render.image_settings
    settings.media_type, settings.file_format = "IMAGE", "PNG"
    settings.color_management, settings.color_mode, settings.color_depth = "FOLLOW_SCENE", "RGBA", "8"
    opened.render.use_file_extension = False
    opened.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    if not path.is_file():
        raise RuntimeError(f"Cycles did not make {path.name}.")


def source_of(function: Callable[..., Any]) -> str:
    """Source of a function and of all in the collection that it calls."""
    found: dict[str, str] = {}
    waiting = [function]
    while waiting:
        one = inspect.unwrap(waiting.pop())
        if one.__qualname__ in found:
            continue
        found[one.__qualname__] = inspect.getsource(one)
        for name in names_in(one.__code__):
            other = one.__globals__.get(name)
            if inspect.isfunction(other) and other.__module__.startswith("scenes."):
                waiting.append(other)
            elif isinstance(other, (int, float, str, tuple)):
                found[name] = repr(other)
    return "\n".join(found[name] for name in sorted(found))


def names_in(code: CodeType) -> set[str]:
    inner = [names_in(item) for item in code.co_consts if isinstance(item, CodeType)]
    return set(code.co_names).union(*inner)


def shown(path: Path) -> np.ndarray:
    """(height, width, 4) of a PNG, color times alpha: what is on the screen before black, and how much of it."""
    image: Any = bpy.data.images.load(str(path))
    try:
        image.colorspace_settings.name = "Non-Color"
        pixels = np.empty(image.size[0] * image.size[1] * 4, np.float32)
        image.pixels.foreach_get(pixels)
        pixels = pixels.reshape(image.size[1], image.size[0], 4)
    finally:
        bpy.data.images.remove(image)
    return np.concatenate((pixels[..., :3] * pixels[..., 3:], pixels[..., 3:]), axis=2)


def blocks(pixels: np.ndarray) -> np.ndarray:
    """(rows, columns, 4) means of blocks of 4 x 4 pixels; what is left at the upper and right edge is left out."""
    rows, columns = (max(side // BLOCK, 1) for side in pixels.shape[:2])
    high, wide = min(BLOCK, pixels.shape[0]), min(BLOCK, pixels.shape[1])
    return pixels[: rows * high, : columns * wide].reshape(rows, high, columns, wide, 4).mean((1, 3))


def share_off(ours: np.ndarray, reference: np.ndarray) -> float:
    """Share of blocks that differ; all of them where the sizes do."""
    if ours.shape != reference.shape:
        return 1.0
    return float((np.abs(blocks(ours) - blocks(reference)).max(-1) > OFF).mean())


if __name__ == "__main__":
    given = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    main(Path(given[0]), given[1:])
    sys.stdout.flush()
    # (Blender as a module may crash in Python's teardown.)
    os._exit(0)
