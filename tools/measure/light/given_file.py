# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The file that a measurement is about, its mirrors and the size of its pictures, as the command line names them."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import bpy
from curvrefl.curvrefl_addon.renderer.device.context import require_gpu
from curvrefl.curvrefl_addon.scene.camera.shutter import Moment
from curvrefl.curvrefl_addon.scene.opened.blend_file import open_blend
from curvrefl.curvrefl_addon.scene.opened.render_depsgraph import read_render_moments


def file_parser(doc: str | None) -> argparse.ArgumentParser:
    """For `GivenFile`; the first line of `doc` describes the command."""
    parser = argparse.ArgumentParser(description=(doc or "").splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--reflector", required=True)
    parser.add_argument("--size", default="640x480")
    return parser


class GivenFile:
    """Opened, with a GPU at hand."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        require_gpu()
        open_blend(arguments.file)
        self.names: list[str] = arguments.reflector.split(",")
        self.width, self.height = (int(side) for side in arguments.size.split("x"))

    def read(self) -> Moment:
        """As it is now, through its camera."""
        context: Any = bpy.context
        still, _, _ = read_render_moments(
            context.scene, context.view_layer, self.names, self.width, self.height, 16, None
        )
        return still
