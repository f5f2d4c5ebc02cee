# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Image and Environment Texture."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

from ...arrays import ImageSource
from ...camera.srgb import srgb_to_linear
from ...materials.node_links import Source
from ..builder import Builder, Handler
from ..expression import Expression
from ..images import FIRST_TILE, uses_alpha
from .coordinates import texture_vector

_FILE = "nodes/images.glsl"
_EXTENSIONS = {"REPEAT": "IMAGE_REPEAT", "EXTEND": "IMAGE_EXTEND", "CLIP": "IMAGE_CLIP", "MIRROR": "IMAGE_MIRROR"}
_INTERPOLATIONS = {"Closest": "closest", "Linear": "linear", "Cubic": "cubic", "Smart": "cubic"}
_PROJECTIONS = {
    "FLAT": "image_flat",
    "SPHERE": "image_sphere",
    "TUBE": "image_tube",
    "EQUIRECTANGULAR": "image_equirectangular",
    "MIRROR_BALL": "image_mirror_ball",
}
_MISSING = (1.0, 0.0, 1.0)


def _image_texture(b: Builder, source: Source) -> Expression | None:
    return _texture(b, source, _EXTENSIONS[source.node.extension])


def _environment_texture(b: Builder, source: Source) -> Expression | None:
    return _texture(b, source, "IMAGE_REPEAT")


def _texture(b: Builder, source: Source, extension: str) -> Expression | None:
    node = source.node
    is_alpha = source.socket.name == "Alpha"
    if node.image is None:
        b.note("Image nodes {of} without an image are drawn magenta, as in Cycles.")
        if is_alpha:
            return b.parameter(1.0)
        missing = b.parameter(*_MISSING)
        return Expression(missing.text, "color", missing.constant, missing.low, missing.high)
    images = _images(b, source)
    is_bordered = extension == "IMAGE_CLIP" or node.image.source == "TILED"
    if is_alpha and not is_bordered and all(image.is_opaque for image in images):
        return b.parameter(1.0)
    divides = _divides(node)
    key = ("image", node.as_pointer(), tuple(group.as_pointer() for group in source.groups))
    value = b.shared(key, lambda: _looked_up(b, source, extension, divides))
    if is_alpha:
        return Expression(f"{value.text}.w", "float", None, 0.0, 1.0)
    low, high = _range(images, divides and node.image.alpha_mode == "PREMUL")
    if is_bordered:
        # (Black beyond the border, magenta where there is no tile.)
        low, high = min(low, 0.0), max(high, 1.0)
    return Expression(f"{value.text}.xyz", "color", None, low, high)


def _images(b: Builder, source: Source) -> list[ImageSource]:
    image = source.node.image
    tiles = [tile.number for tile in image.tiles] if image.source == "TILED" else [0]
    return [found for tile in tiles if (found := b.image_source(source, tile)) is not None]


def _divides(node: Any) -> bool:
    """Colors are divided by alpha: Cycles looks at alpha by itself where anything uses it."""
    alpha = node.outputs.get("Alpha")
    return alpha is not None and uses_alpha(node.image) and any(not link.is_muted for link in alpha.links)


def _range(images: Iterable[ImageSource], exceeds_alpha: bool) -> tuple[float, float]:
    """Of colors in the scene; `exceeds_alpha`: divided by alpha they may be above 1."""
    ranges = [(0.0, 1.0)]
    for image in images:
        low, high = image.range
        if not image.is_opaque and (exceeds_alpha or not image.is_bytes):
            low, high = (0.0 if low >= 0.0 else -math.inf), math.inf
        elif image.is_srgb:
            low, high = (float(srgb_to_linear(max(value, 0.0))) for value in image.range)
        ranges.append((low, high))
    lows, highs = zip(*(ranges[1:] or ranges), strict=True)
    return min(lows), max(highs)


def _looked_up(b: Builder, source: Source, extension: str, divides: bool) -> Expression:
    node = source.node
    interpolation = _INTERPOLATIONS[node.interpolation]
    more = (extension, divides)
    is_environment = node.type == "TEX_ENVIRONMENT"
    if is_environment and not b.is_linked(source, "Vector"):
        b.depend("position")
        vector = Expression("s.position", "vector")
    else:
        vector = texture_vector(b, source, "UV")
    if node.projection == "BOX":
        b.need("PROGRAM_INSTANCE")
        b.include("programs/instances.glsl")
        if node.image.source == "TILED":
            b.note("Tiles {of} in a box projection but the first are left out.")
        blend = b.parameter(node.projection_blend)
        normal = "normalize(to_object_normal(s, s.normal))"
        record = _record(b, source, FIRST_TILE)
        place = b.made("vector", vector.text)
        return b.call("vec4", f"image_box_{interpolation}", "s", record, place, normal, blend, *more, file=_FILE)
    place = b.made("vector", f"vec3({_PROJECTIONS[node.projection]}({vector.text}), 0.0)")
    b.include(_FILE)
    uv = f"{place.text}.xy"
    lookup = f"image_lookup_{interpolation}"
    if node.image.source != "TILED":
        return b.call("vec4", lookup, "s", _record(b, source), uv, *more)
    tile = b.made("float", f"float(image_tile({uv}))")
    number = "-1"
    for present in node.image.tiles:
        number = f"(int({tile.text}) == {present.number} ? {_record(b, source, present.number)} : {number})"
    return b.call("vec4", lookup, "s", number, f"{uv} - image_tile_corner({uv})", *more)


def _record(b: Builder, source: Source, tile: int = 0) -> int:
    record = b.image(source, tile)
    assert record is not None
    return record


NODES: Mapping[str, Handler] = {"TEX_IMAGE": _image_texture, "TEX_ENVIRONMENT": _environment_texture}
