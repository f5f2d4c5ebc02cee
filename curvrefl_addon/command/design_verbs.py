# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Verbs that go from what a mirror is to show back to the scene."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

from ..errors import InputError
from ..output import checked_folder, folder_to_publish
from ..streams import readable
from .arguments import between, numbers, positive, resolution
from .inputs import open_scene, read_names, registered, resolution_of, start_gpu, view_layer_of, warn_of

FITS = ("inside", "cover", "stretch")
SIZE = 2048
DOTS = 300.0


def add_anamorphosis(verb: Callable[..., argparse.ArgumentParser], most_frame: int) -> None:
    """Add the verb to the command line's."""
    parser = verb(
        "anamorphosis",
        anamorphosis,
        "Make the distorted picture that has to lie on surfaces for a mirror to show a picture.",
    )
    parser.add_argument("file", metavar="FILE.blend")
    parser.add_argument("--mirror", required=True, metavar="A[,B..]", help="names of the mirrors that show the picture")
    parser.add_argument("--surface", required=True, metavar="A[,B..]", help="names of the meshes that it is put on")
    parser.add_argument("--picture", required=True, metavar="FILE", help="what the mirror is to show")
    parser.add_argument("--camera", type=readable, metavar="C", help="name of the camera that sees it (the scene's)")
    parser.add_argument(
        "--frame", type=between(-most_frame, most_frame), metavar="N", help="frame of the animation (the file's)"
    )
    parser.add_argument("--resolution", type=resolution, metavar="WxH", help="of the camera's picture (the scene's)")
    parser.add_argument(
        "--fit", default="inside", metavar="F", help=f"of the box about the mirror: {', '.join(FITS)} (%(default)s)"
    )
    parser.add_argument("--scale", type=positive, default=0.7, metavar="X", help="of what fits (%(default)s)")
    parser.add_argument(
        "--rectangle",
        type=numbers(4),
        metavar="L,B,W,H",
        help="left, bottom, width and height of the picture in shares of the view, in place of --fit",
    )
    parser.add_argument("--uv-map", default="", metavar="U", help="of the surfaces (the one active for rendering)")
    parser.add_argument(
        "--size", type=between(16, 16384), default=SIZE, metavar="N", help="texels along a side (%(default)s)"
    )
    parser.add_argument("--print", action="store_true", dest="prints", help="of flat surfaces, as PNG and SVG")
    parser.add_argument("--dpi", type=positive, default=DOTS, metavar="N", help="of prints (%(default)s)")
    parser.add_argument("--print-width", type=positive, metavar="MM", help="of sheets (as large as in the scene)")
    parser.add_argument("--output", required=True, metavar="DIR", help="folder to write to")


def anamorphosis(options: argparse.Namespace) -> int:
    """Write an image for each surface, with --print sheets to print, and say how much of the picture is on them."""
    if options.fit not in FITS:
        raise InputError(f'There is no fit "{options.fit}": choose from {", ".join(FITS)}.')
    mirrors, surfaces = read_names(options.mirror, "mirror"), read_names(options.surface, "surface")
    output = checked_folder(options.output)
    start_gpu()
    scene = open_scene(options.file, options.frame)

    from ..design.anamorphosis.making import begin
    from ..design.anamorphosis.picture_frame import FrameChoice
    from ..design.anamorphosis.prints import image_file, write_prints
    from ..design.anamorphosis.results import read_picture
    from ..design.anamorphosis.sheet import Paper
    from ..design.stage import read_stage

    _, picture = read_picture(Path(options.picture))
    choice = FrameChoice(options.fit.upper(), options.scale)
    if options.rectangle is not None:
        choice = FrameChoice("CHOSEN", rectangle=tuple(options.rectangle))
    with registered():
        size = resolution_of(options, scene)
        stage = read_stage(scene, view_layer_of(scene), mirrors, surfaces, options.camera, size, options.uv_map)
    making = begin(stage, picture, choice)
    placed = [making.image(surface, options.size, options.size) for surface in stage.surfaces]
    _, sentences = making.told(placed)
    with folder_to_publish(output) as folder:
        for surface, item in zip(stage.surfaces, placed, strict=True):
            image_file(folder, surface.name, item.pixels, picture.is_encoded)
        if options.prints:
            paper = Paper(options.dpi, options.print_width or 0.0, scene.unit_settings.scale_length)
            sentences += write_prints(making, paper, folder)
    warn_of(stage.warnings)
    print("\n".join(sentence for sentence in sentences if sentence not in stage.warnings))
    return 0
