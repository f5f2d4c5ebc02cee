# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Images: how they are placed, what they are made of, and which one of several is shown."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ..trees import PLACE, UV, MakeTree, Row, rows, shader_node

EXTENSIONS = ("REPEAT", "EXTEND", "CLIP", "MIRROR")
SPACES = (
    "Non-Color",
    "Linear Rec.709",
    "Linear Rec.2020",
    "ACEScg",
    "ACES2065-1",
    "Display P3",
    "Rec.1886",
    "Rec.2020",
    "Gamma 2.2 Encoded AdobeRGB",
    "Filmic sRGB",
    "AgX Base sRGB",
    "Khronos PBR Neutral sRGB",
    "Linear CIE-XYZ D65",
    "Linear DCI-P3 D65",
    "Linear FilmLight E-Gamut",
    "Rec.2100-PQ",
    "Rec.2100-HLG",
)
type Adjust = Callable[[Any], None]


@cache
def _folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory()


def _colors(seed: int, width: int, height: int) -> np.ndarray:
    """(h, w, 4) from 0 to 1; alpha too, and 0 in a corner."""
    pixels = np.random.default_rng(seed).random((height, width, 4), np.float32)
    pixels[: height // 2, : width // 3, 3] = 0.0
    return pixels


def image_file(name: str, kind: str = "PNG", depth: str = "8", has_alpha: bool = False, seed: int = 3) -> str:
    """Path of an image of 7 x 5 pixels; `name` is a different one's."""
    path = Path(_folder().name, name)
    if path.exists():
        return str(path)
    pixels = _colors(seed, 7, 5)
    if not has_alpha:
        pixels[..., 3] = 1.0
    image: Any = bpy.data.images.new(name, 7, 5, alpha=True, float_buffer=depth != "8")
    if kind == "OPEN_EXR":
        pixels[..., :3] *= 3.0 * pixels[..., 3:]
    image.pixels.foreach_set(pixels.ravel())
    settings = bpy.context.scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = kind, "RGBA" if has_alpha else "RGB", depth
    bpy.context.scene.view_settings.view_transform = "Standard"
    if depth == "8":
        # (As it is, without a conversion.)
        image.file_format = kind
        image.save(filepath=str(path))
    else:
        image.save_render(str(path), scene=bpy.context.scene)
    bpy.data.images.remove(image)
    settings.file_format, settings.color_depth = "OPEN_EXR", "32"
    return str(path)


def shown(path: Callable[[], str], adjust: Adjust | None = None, output: str = "Color", **settings: Any) -> MakeTree:
    """An image node with a file; `adjust` gets the node."""

    def set_up(node: Any) -> None:
        node.image = bpy.data.images.load(path())
        for name, value in settings.items():
            if name == "space":
                node.image.colorspace_settings.name = value
            else:
                setattr(node.image, name, value)
        if adjust is not None:
            adjust(node)

    return shader_node("TexImage", {"Vector": UV}, output, set_up)


def plain() -> str:
    return image_file("plain.png")


def clear() -> str:
    return image_file("clear.png", has_alpha=True)


def fine() -> str:
    return image_file("fine.png", depth="16", has_alpha=True)


def floats() -> str:
    return image_file("floats.exr", "OPEN_EXR", "32", has_alpha=True)


def _with_alpha(color: MakeTree) -> MakeTree:
    """Colors of an image whose alpha is used too, and so divided by it."""

    def make(tree: Any) -> Any:
        node = color(tree).node
        mix = tree.nodes.new("ShaderNodeMix")
        mix.data_type = "RGBA"
        tree.links.new(node.outputs["Alpha"], mix.inputs["Factor"])
        tree.links.new(node.outputs["Color"], [socket for socket in mix.inputs if socket.name == "B"][-2])
        return next(socket for socket in mix.outputs if socket.enabled)

    return make


def _set(**settings: Any) -> Adjust:
    def adjust(node: Any) -> None:
        for name, value in settings.items():
            setattr(node, name, value)

    return adjust


def _mapped(node: Any) -> None:
    node.texture_mapping.translation, node.texture_mapping.scale = (0.2, 0.3, 0.1), (1.5, 0.7, 1.0)
    node.texture_mapping.rotation = (0.3, 0.2, 0.5)


def _packed(node: Any) -> None:
    node.image.pack()


def _painted(node: Any) -> None:
    pixels = _colors(9, *node.image.size)
    node.image.pixels.foreach_set(pixels.ravel())
    node.image.update()


def _generated(is_float: bool, **settings: Any) -> MakeTree:
    def set_up(node: Any) -> None:
        node.image = bpy.data.images.new("generated", 32, 16, alpha=True, float_buffer=is_float)
        for name, value in settings.items():
            setattr(node.image, name, value)

    return shader_node("TexImage", {"Vector": UV}, "Color", set_up)


def _missing(node: Any) -> None:
    node.image.filepath = "//nowhere.png"


def _sequence(frame: int) -> Adjust:
    def adjust(node: Any) -> None:
        for number in range(1, 5):
            image_file(f"frame{number:02d}.png", seed=number)
        node.image.filepath = image_file("frame01.png")
        node.image.source = "SEQUENCE"
        user = node.image_user
        user.frame_duration, user.frame_start, user.frame_offset = 4, 1, frame - 1
        user.use_auto_refresh = True

    return adjust


def _tiled(output: str, **settings: Any) -> MakeTree:
    """Of the tiles 1001, 1002 and 1011, at places from -0.6 to 2."""

    def set_up(node: Any) -> None:
        paths = [image_file(f"tiles.{number}.png", seed=number) for number in (1001, 1002, 1011)]
        node.image = bpy.data.images.load(paths[0])
        node.image.source = "TILED"
        for number in (1002, 1011):
            node.image.tiles.new(number)
        for name, value in settings.items():
            setattr(node, name, value)

    # (Straight from a UV map Cycles leaves out the tiles that no corner of the mesh is on.)
    place = shader_node("VectorMath", {0: UV, "Scale": 1.5}, operation="SCALE")
    return shader_node("TexImage", {"Vector": place}, output, set_up)


def _alphas(path: Callable[[], str]) -> list[MakeTree]:
    trees = []
    for mode in ("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"):
        for space in ("sRGB", "Non-Color", "Linear Rec.709", "ACEScg"):
            color = shown(path, alpha_mode=mode, space=space)
            trees += [color, _with_alpha(color), shown(path, None, "Alpha", alpha_mode=mode, space=space)]
    return trees


def _own(adjust: Adjust) -> list[MakeTree]:
    return [
        _with_alpha(shown(path, adjust, alpha_mode=mode, space=space))
        for path in (clear, floats)
        for mode in ("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE")
        for space in ("sRGB", "Non-Color")
    ]


def _environment(projection: str, **settings: Any) -> MakeTree:
    def set_up(node: Any) -> None:
        node.image = bpy.data.images.load(floats())

    return shader_node("TexEnvironment", {"Vector": PLACE}, "Color", set_up, projection=projection, **settings)


def _load(node: Any) -> None:
    node.image = bpy.data.images.load(plain())


def _projected(projection: str, blend: float = 0.0) -> MakeTree:
    def set_up(node: Any) -> None:
        node.image = bpy.data.images.load(plain())
        node.projection, node.projection_blend = projection, blend

    return shader_node("TexImage", {"Vector": PLACE}, "Color", set_up)


ROWS: list[Row] = [
    *rows(
        "Image Texture",
        *(
            (
                f"{interpolation}, {extension.lower()}",
                shown(plain, _set(interpolation=interpolation, extension=extension)),
            )
            for interpolation in ("Linear", "Closest", "Cubic", "Smart")
            for extension in EXTENSIONS
        ),
        *(
            (projection.capitalize(), [_projected(projection), _projected(projection, 0.4)])
            for projection in ("FLAT", "SPHERE", "TUBE", "BOX")
        ),
        ("Without a link", shader_node("TexImage", {}, "Color", _load)),
        ("Own mapping", shown(plain, _mapped)),
        ("Alpha of bytes", _alphas(clear)),
        ("Alpha of 16 bits", _alphas(fine)),
        ("Alpha of floats", _alphas(floats)),
        *((f"Color space {space}", shown(plain, space=space)) for space in SPACES),
        ("Packed", _own(_packed)),
        ("Painted", _own(_painted)),
        (
            "Generated",
            [
                _generated(is_float, generated_type=kind, alpha_mode=mode, generated_color=(0.3, 0.6, 0.9, 0.5))
                for is_float in (False, True)
                for kind in ("BLANK", "UV_GRID", "COLOR_GRID")
                for mode in ("STRAIGHT", "PREMUL")
            ],
        ),
        ("Sequence", [shown(plain, _sequence(frame)) for frame in (1, 2, 4)]),
        ("Tiles", [_tiled("Color"), _tiled("Color", extension="EXTEND", interpolation="Cubic"), _tiled("Alpha")]),
        ("Missing", [shown(plain, _missing), shown(plain, _missing, "Alpha"), shader_node("TexImage", {})]),
    ),
    *rows(
        "Environment Texture",
        *(
            (
                f"{projection.replace('_', ' ').capitalize()}",
                [_environment(projection, interpolation=kind) for kind in ("Linear", "Closest", "Cubic")],
            )
            for projection in ("EQUIRECTANGULAR", "MIRROR_BALL")
        ),
        ("Missing", shader_node("TexEnvironment", {"Vector": PLACE})),
    ),
]
