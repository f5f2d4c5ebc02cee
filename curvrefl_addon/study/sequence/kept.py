# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a frame of a comparison keeps beside its own report, for the report over frames: `kept.exr` and `kept.json`.

Pictures are in 16 bits and Rec.709, scene-linear; geometry is in 32. What is kept is the same whatever frames were
compared before, and by whom.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from ...output import numbered
from ...scene.arrays import Float32Array, Int32Array
from ...written_files import is_whole
from ..dataset.exr_layers import load_layers, save_layers

PICTURES, TOLD, REPORT, PAGE = "kept.exr", "kept.json", "report.json", "report.html"
VERSION = 1
"""Of these files; another one where what they hold differs"""
REFERENCE = "reference"
LARGEST = float(np.finfo(np.float16).max)
"""That 16 bits hold"""
FAILED = -1
"""In place of an object's number: the method shows no mirror there, or no color or place that is a number"""


@dataclass(frozen=True, slots=True, eq=False)
class Shown:
    """What a method shows at pixels' centers."""

    object: Int32Array
    """(h, w) number in `KeptFrame.objects`, 0 the background, FAILED"""
    offset: Float32Array
    """(h, w, 2) as of `motion.offsets`"""


@dataclass(frozen=True, slots=True, eq=False)
class KeptFrame:
    """One frame. Pictures are (h, w, ...), row 0 at the bottom."""

    frame: int
    made: Mapping[str, Any]
    """What all frames of a comparison have in common: see `frames.made_with`"""
    camera: str
    before: Mapping[str, Any]
    """`frame`, `camera`, and as `reason` why that frame could not be read, or nothing"""
    objects: Mapping[int, str]
    """Names by numbers"""
    pictures: Mapping[str, Float32Array]
    """(h, w, 3) of the reference, methods and peers, by name"""
    mask: Int32Array
    """(h, w) number of the mirror, 0 elsewhere, as Cycles sees it"""
    object: Int32Array
    """(h, w) number of what it shows in Cycles, 0 for the background and where nothing is known"""
    distance: Float32Array
    """(h, w) from the mirror to that; infinite: the background; NaN: nothing is known"""
    place: Float32Array
    """(h, w, 2) as of `motion.Motion`"""
    distance_before: Float32Array
    """(h, w) as of `motion.Motion`"""
    shown: Mapping[str, Shown]
    """By method"""


def folder_of(output: Path, frame: int) -> Path:
    """Of the comparison of a frame."""
    return numbered(output / "frame", frame)


def save_kept(folder: Path, kept: KeptFrame) -> None:
    """Write both files into a folder that is there."""
    channels: dict[str, Any] = {}
    for name, picture in kept.pictures.items():
        # (What is no number would be black on a screen.)
        finite = np.nan_to_num(picture, nan=0.0, posinf=LARGEST, neginf=0.0)
        stored = np.clip(finite, -LARGEST, LARGEST).astype(np.float16)
        channels |= {f"{name}.{letter}": stored[..., number] for number, letter in enumerate("RGB")}
    planes = {
        "mask.Z": kept.mask,
        "shown.object": kept.object,
        "shown.distance": kept.distance,
        "before.X": kept.place[..., 0],
        "before.Y": kept.place[..., 1],
        "before.distance": kept.distance_before,
    }
    for name, shown in kept.shown.items():
        planes |= {f"{name}.object": shown.object}
        planes |= {f"{name}.{letter}": shown.offset[..., number] for number, letter in enumerate("XY")}
    channels |= {name: np.asarray(plane, np.float32) for name, plane in planes.items()}
    save_layers(folder / PICTURES, channels, {})
    told = {
        "version": VERSION,
        "made": kept.made,
        "frame": kept.frame,
        "camera": kept.camera,
        "before": kept.before,
        "objects": {str(number): name for number, name in kept.objects.items()},
    }
    (folder / TOLD).write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")


def load_kept(folder: Path) -> KeptFrame:
    """What `save_kept` has written. Raises InputError for files that are not so."""
    told = _told(folder)
    try:
        channels = load_layers(folder / PICTURES)
        names = [REFERENCE, *told["made"]["methods"], *told["made"]["peers"]]
        # (A method that cannot show these mirrors has no picture.)
        return KeptFrame(
            frame=int(told["frame"]),
            made=told["made"],
            camera=told["camera"],
            before=told["before"],
            objects={int(number): name for number, name in told["objects"].items()},
            pictures={name: _stack(channels, name, "RGB") for name in names if f"{name}.R" in channels},
            mask=channels["mask.Z"].astype(np.int32),
            object=channels["shown.object"].astype(np.int32),
            distance=channels["shown.distance"],
            place=_stack(channels, "before", "XY"),
            distance_before=channels["before.distance"],
            shown={
                name: Shown(channels[f"{name}.object"].astype(np.int32), _stack(channels, name, "XY"))
                for name in told["made"]["methods"]
                if f"{name}.object" in channels
            },
        )
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise _damaged(folder) from error


def made_of(folder: Path) -> Mapping[str, Any] | None:
    """What the frame in this folder was made with; None where there is no whole one."""
    if not all((folder / name).is_file() for name in (REPORT, PAGE, TOLD)) or not is_whole(folder / PICTURES):
        return None
    try:
        told = _told(folder)
        pictures = [REFERENCE, *json.loads((folder / REPORT).read_text(encoding="utf-8"))["methods"]]
        return told["made"] if all(is_whole(folder / f"{name}.png") for name in pictures) else None
    except (InputError, OSError, KeyError, TypeError, ValueError):
        return None


def frames_in(output: Path) -> list[int]:
    """Numbers of the frames that have folders there, ascending, whole or not."""
    found = []
    for path in output.glob("frame_*"):
        text = path.name.removeprefix("frame_")
        if path.is_dir() and text.removeprefix("-").isdigit() and folder_of(output, int(text)) == path:
            found.append(int(text))
    return sorted(found)


def differences(first: Mapping[str, Any], other: Mapping[str, Any]) -> list[str]:
    """What two frames were made with that is not the same, as `samples (32 and 64)`."""
    found = []
    for name in sorted({*first, *other}):
        one, two = first.get(name), other.get(name)
        if one == two:
            continue
        if isinstance(one, dict) and isinstance(two, dict):
            found += differences(one, two)
        elif name == "sha256":
            found.append("the file's content")
        else:
            found.append(f"{name} ({_said(one)} and {_said(two)})")
    return found


def _said(value: Any) -> str:
    return ", ".join(map(str, value)) if isinstance(value, Sequence) and not isinstance(value, str) else str(value)


def _told(folder: Path) -> dict[str, Any]:
    try:
        told = json.loads((folder / TOLD).read_text(encoding="utf-8"))
        if told["version"] == VERSION:
            return told
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise _damaged(folder) from error
    raise InputError(f'"{folder.name}" was kept by another version of the extension: compare its frame again.')


def _damaged(folder: Path) -> InputError:
    return InputError(f'"{folder.name}" does not hold what a compared frame keeps: compare its frame again.')


def _stack(channels: Mapping[str, Float32Array], name: str, letters: str) -> Float32Array:
    return np.stack([channels[f"{name}.{letter}"] for letter in letters], axis=-1)
