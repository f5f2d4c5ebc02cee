# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures as the file shows them: on its film, through Blender's own color management."""

from __future__ import annotations

from pathlib import Path

import bpy

from ..scene.arrays import Float32Array
from ..scene.opened.temporary_settings import temporary_settings
from ..streams import STDERR, dropped
from ..written_files import error_in, require_whole
from .images import to_image_datablock


def save_as_shown(path: Path, pixels: Float32Array, scene: bpy.types.Scene) -> None:
    """Write a scene-linear, premultiplied picture (h, w, 4).

    .exr in 32 bits, in the working space, which the file names; .png in 8 bits through the scene's display, view
    transform, look, exposure, gamma, curves and white balance, with alpha where the scene's film is transparent.
    Raises OSError when the file cannot be written, or not whole.
    """
    is_exr = path.suffix.lower() == ".exr"
    image = to_image_datablock("curvrefl picture", pixels)
    try:
        with temporary_settings() as changes:
            output = scene.render.image_settings
            changes.set(
                output,
                media_type="IMAGE",
                file_format="OPEN_EXR" if is_exr else "PNG",
                color_management="FOLLOW_SCENE",
                color_mode="RGBA" if is_exr or scene.render.film_transparent else "RGB",
                color_depth="32" if is_exr else "8",
                **({"exr_codec": "NONE"} if is_exr else {}),
            )
            # (it says more on stderr than the error does)
            with dropped(STDERR):
                image.save_render(str(path.absolute()), scene=scene)
    except RuntimeError as error:
        raise error_in(str(error), path) from error
    finally:
        bpy.data.images.remove(image)
    require_whole(path)
