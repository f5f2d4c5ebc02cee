# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""What the renderer knows of a Blender scene: frozen numpy arrays, no bpy.

Everything is right-handed Blender world space in meters unless a field says "object space".
`scene.extract` fills these; `renderer` only reads them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from .programs.emitting import Emitter
from .programs.program import Attribute, Program

type Float32Array = NDArray[np.float32]
type Float64Array = NDArray[np.float64]
type Int32Array = NDArray[np.int32]

UNLIMITED_BOUNCES = 1 << 30
"""More than any ray is followed"""
LARGEST_COORDINATE = 1e18
"""Squares of larger ones overflow in single precision"""
MOST_SETS = 20
"""Sets of objects that light linking tells apart; so many for lamps' light, and as many for their shadows"""
EVERY_SET = (1 << MOST_SETS) - 1
"""A bit for each"""


@dataclass(frozen=True, slots=True)
class MeshArrays:
    """One evaluated mesh in object space.

    A *corner* carries what may differ between the faces that meet in a vertex (normal, UV, attributes).
    Where nothing differs, corners are the vertices themselves and `corner_vertex` is 0..N-1.
    """

    name: str
    positions: Float32Array
    """(vertices, 3)"""
    corner_vertex: Int32Array
    """(corners,) index into `positions`"""
    corner_normals: Float32Array
    """(corners, 3) unit shading normals"""
    corner_uv: Float32Array | None
    """(corners, 2) of the UV map that methods search in; None where none does"""
    triangles: Int32Array
    """(triangles, 3) index into corners"""
    triangle_slot: Int32Array
    """(triangles,) material slot"""
    attributes: tuple[Attribute, ...] = ()
    """What programs of its materials read of it"""
    corner_attributes: Float32Array | None = None
    """(corners, attributes, 4); None where there are none"""
    signature: int = 0
    """Changes when any array above changes"""


@dataclass(frozen=True, slots=True, eq=False)
class ImageSource:
    """An image that programs look up. Its pixels are made when they are asked for, and kept by nobody else."""

    name: str
    width: int
    """0: the image is missing"""
    height: int
    is_bytes: bool
    is_srgb: bool
    """Pixels are encoded: they are interpolated first, then made linear, as Cycles does"""
    is_opaque: bool
    """Alpha is 1 everywhere"""
    range: tuple[float, float]
    """No pixel has less or more, as they are kept"""
    read: Callable[[], NDArray[np.uint8] | NDArray[np.float16] | Float32Array]
    """(height, width, 4), row 0 at the bottom; colors times alpha where Cycles keeps them so. OSError: they are gone"""


class Glass(IntEnum):
    """What tints light at an interface that lets light through."""

    PRINCIPLED = 0
    """What is reflected by the specular tint, what goes in by the square root of the base color"""
    GLASS = 1
    """Both by the base color"""
    REFRACTION = 2
    """Nothing is reflected; what goes in by the base color"""


@dataclass(frozen=True, slots=True)
class MaterialArrays:
    """The part of the Principled BSDF that the renderer shades (also made from the other BSDF nodes)."""

    name: str
    base_color: tuple[float, float, float] = (0.8, 0.8, 0.8)
    metallic: float = 0.0
    roughness: float = 0.5
    ior: float = 1.5
    specular_level: float = 0.5
    """Principled "IOR Level": scales the dielectric reflectance, 0.5 leaves it at the IOR's own"""
    emission: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Emitted radiance, strength included"""
    glossy_only: bool = False
    """A Glossy BSDF: reflectance is the base color at every angle, without diffuse part"""
    specular_tint: tuple[float, float, float] = (1.0, 1.0, 1.0)
    anisotropy: float = 0.0
    """Principled "Anisotropic", 0..1; -1..1 of a Glossy or Metallic BSDF"""
    anisotropic_rotation: float = 0.0
    """Turns, of the tangent about the object's Z axis about the normal"""
    coat_weight: float = 0.0
    coat_roughness: float = 0.03
    coat_ior: float = 1.5
    coat_tint: tuple[float, float, float] = (1.0, 1.0, 1.0)
    film_thickness: float = 0.0
    """Nanometers"""
    film_ior: float = 1.33
    transmission: float = 0.0
    """Share that goes through an interface, of what is no metal"""
    glass: Glass = Glass.PRINCIPLED
    thin_wall: bool = False
    """One surface stands for both sides of a pane"""
    absorption: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Inside, per meter: of a volume that absorbs and does not scatter"""
    alpha: float = 1.0
    """Share that is there at all; what is not lets light straight on"""
    transparent_tint: tuple[float, float, float] = (1.0, 1.0, 1.0)
    """Of light that goes straight on"""
    sheen_weight: float = 0.0
    sheen_roughness: float = 0.5
    sheen_tint: tuple[float, float, float] = (1.0, 1.0, 1.0)
    diffuse_roughness: float = 0.0
    subsurface: float = 0.0
    """Share of the diffuse part that goes below the surface"""
    translucency: float = 0.0
    """Share of the diffuse part that comes out on the other side"""
    program: Program | None = None
    """What differs from place to place: it sets channels in place of the constants here"""
    ranges: tuple[tuple[str, float, float], ...] = ()
    """(channel, lowest, highest) of what the program sets, as far as they are known"""
    light_set: int = 0
    """Of the objects that have it; those of other sets have copies of it"""
    shines_on: int = EVERY_SET
    """Bits of the light sets of the objects that its emission gets to"""
    blocked_by: int = EVERY_SET
    """And of the shadow sets of the objects that cast shadows in that"""

    @property
    def kind(self) -> float:
        """The channel "kind" of what is the same everywhere: bits of `programs/material.glsl`."""
        glass = {Glass.PRINCIPLED: 0, Glass.GLASS: 4, Glass.REFRACTION: 8}[self.glass]
        return float(self.glossy_only + 2 * self.thin_wall + glass)

    def range_of(self, channel: str) -> tuple[float, float]:
        """Lowest and highest value of a channel, of any part of a color; endless where a program's is not known."""
        if self.program is None or channel not in self.program.shape.channels:
            values = np.atleast_1d(getattr(self, channel))
            return float(values.min()), float(values.max())
        return next(((low, high) for name, low, high in self.ranges if name == channel), (-math.inf, math.inf))

    def may_be(self, channel: str) -> bool:
        """Whether a channel is above 0 anywhere, as far as that is known."""
        return self.range_of(channel)[1] > 0.0

    def varies(self, *channels: str) -> bool:
        """Whether any of these differs from place to place."""
        return self.program is not None and not set(channels).isdisjoint(self.program.shape.channels)

    @property
    def is_seen_through(self) -> bool:
        """Light goes on behind it, at least at some places."""
        return self.may_be("transmission") or self.range_of("alpha")[0] < 1.0


@dataclass(frozen=True, slots=True)
class LightArrays:
    """A lamp.

    `color` is scene-linear with exposure, temperature and texture-free strength applied; below 0 it takes light away:
    POINT, SPOT: radiant power in W; SUN: irradiance in W/m2; AREA: radiant power in W.
    """

    name: str
    kind: str
    """'POINT', 'SUN', 'SPOT' or 'AREA'"""
    color: tuple[float, float, float]
    matrix: Float64Array
    """(4, 4) world matrix, columns normalized; the lamp shines along its -Z"""
    radius: float = 0.0
    """POINT, SPOT: radius of the ball"""
    angle: float = 0.0
    """SUN: angular diameter in radians"""
    spot_angle: float = 0.0
    """SPOT: full cone angle in radians"""
    spot_blend: float = 0.0
    size: tuple[float, float] = (0.0, 0.0)
    """AREA: full width and height in meters, world scale applied"""
    ellipse: bool = False
    """AREA: disk or ellipse instead of a rectangle"""
    spread: float = math.pi
    """AREA: full angle in radians of the cone into which it shines from each of its points"""
    is_ball: bool = False
    """POINT, SPOT: a ball without soft falloff, else a disk that faces whatever it lights"""
    casts_shadow: bool = True
    visible_camera: bool = True
    """The lamp itself is seen by the camera"""
    visible_glossy: bool = True
    """The lamp itself is seen in mirrors"""
    lights_diffuse: bool = True
    """Diffuse parts of surfaces"""
    lights_glossy: bool = True
    """Highlights of surfaces"""
    emitter: Emitter | None = None
    """By its nodes: `color` is multiplied with what it says"""
    lights_on: int = EVERY_SET
    """Bits of the light sets of the objects that it lights"""
    blocked_by: int = EVERY_SET
    """Bits of the shadow sets of the objects that cast shadows in its light"""


@dataclass(frozen=True, slots=True)
class WorldArrays:
    """Background radiance: `color` times, where there is one, an equirectangular image or what a program says."""

    color: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Scene-linear radiance (strength included), or the factor on `image`"""
    image: Float32Array | None = None
    """(height, width, 3) scene-linear, row 0 at the bottom, Blender's equirectangular mapping"""
    rotation: Float64Array = field(default_factory=lambda: np.eye(3))
    """(3, 3): image direction = rotation @ world direction"""
    visible_camera: bool = True
    """Behind all that the camera sees, else black"""
    visible_diffuse: bool = True
    """Lights diffuse parts of surfaces"""
    visible_glossy: bool = True
    """Seen in mirrors, and lights glossy parts of surfaces"""
    emitter: Emitter | None = None
    """What shines in place of an image"""


@dataclass(frozen=True, slots=True)
class InstanceArrays:
    """One placed mesh."""

    object_name: str
    object_id: int
    """1, 2, ...: the same for all instances that show one object; 0 is the background"""
    mesh: int
    """Index into `SceneArrays.meshes`"""
    matrix: Float64Array
    """(4, 4) object to world"""
    materials: tuple[int, ...]
    """Per slot, index into `SceneArrays.materials`; never empty"""
    visible_camera: bool = True
    visible_diffuse: bool = True
    visible_glossy: bool = True
    visible_shadow: bool = True
    visible_transmission: bool = True
    holdout: bool = False
    shadow_set: int = 0
    """Of shadow linking"""
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Object space of its object less that of `matrix`: not 0 where the mesh has been moved to its middle"""
    color: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    """Of the object, for its materials' programs as all that follows"""
    random: float = 0.0
    """Its own number from 0 to 1"""
    pass_index: int = 0
    generated: tuple[tuple[float, float, float], tuple[float, float, float]] = ((0.5, 0.5, 0.5), (0.5, 0.5, 0.5))
    """Scale and offset from object space to generated coordinates"""
    instancer_generated: tuple[float, float, float] = (0.0, 0.0, 0.0)
    instancer_uv: tuple[float, float] = (0.0, 0.0)
    values: tuple[tuple[str, tuple[float, float, float, float]], ...] = ()
    """By name, what programs ask of instances and objects"""


@dataclass(frozen=True, slots=True)
class SceneArrays:
    """A whole scene at one frame."""

    meshes: tuple[MeshArrays, ...]
    instances: tuple[InstanceArrays, ...]
    materials: tuple[MaterialArrays, ...]
    """Index 0 is the default material for empty slots"""
    images: tuple[ImageSource, ...]
    """What programs look up"""
    lights: tuple[LightArrays, ...]
    world: WorldArrays
    reflectors: tuple[int, ...] = ()
    """object_id of the chosen reflectors"""
    warnings: tuple[str, ...] = ()
    """What could not be represented, one sentence each"""
    mirror_bounces: int = UNLIMITED_BOUNCES
    """Mirrors one after the other that the file's own renders follow; the last shows only what shines by itself"""
    most_bounces: int = UNLIMITED_BOUNCES
    """Mirrors and interfaces together"""
    transmission_bounces: int = UNLIMITED_BOUNCES
    """Interfaces that they follow light through"""
    transparent_bounces: int = UNLIMITED_BOUNCES
    """Surfaces that they follow light straight through"""
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Where in the world these coordinates have theirs"""
    diffuse_bounces: int = 0
    """Surfaces one after the other from which they follow scattered light"""
    caustics: bool = True
    """What reflects sends light on to what scatters it"""
    indirect_clamp: float = 0.0
    """The most that light which has bounced adds to a sample there, mean of red, green and blue; 0: any"""

    def light_set_of(self, instance: InstanceArrays) -> int:
        """All materials of an instance have the same."""
        return self.materials[instance.materials[0]].light_set
