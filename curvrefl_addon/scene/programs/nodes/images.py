# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Image and Environment Texture."""

from __future__ import annotations

from collections.abc import Mapping

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
    if is_alpha and extension != "IMAGE_CLIP" and node.image.source != "TILED" and b.is_opaque_image(source):
        return b.parameter(1.0)
    key = ("image", node.as_pointer(), tuple(group.as_pointer() for group in source.groups))
    value = b.shared(key, lambda: _looked_up(b, source, extension))
    if is_alpha:
        return Expression(f"{value.text}.w", "float", None, 0.0, 1.0)
    # (Of the colors of floats only Cycles' black border is known; negative ones are rare and right too.)
    return Expression(f"{value.text}.xyz", "color")


def _looked_up(b: Builder, source: Source, extension: str) -> Expression:
    node = source.node
    interpolation = _INTERPOLATIONS[node.interpolation]
    # (Cycles looks at alpha by itself where anything uses it.)
    alpha = node.outputs.get("Alpha")
    divides = alpha is not None and uses_alpha(node.image) and any(not link.is_muted for link in alpha.links)
    more = (extension, bool(divides))
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
