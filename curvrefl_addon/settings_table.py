# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every setting, once: its name, defaults, ranges and text, and where a user meets it.

The renderer's settings, Blender's properties, the preferences, the command line's arguments and docs/settings.md are
made from the classes below, that of passes in `settings_choices` and that of `diagnostics.settings`. A new setting is
one more field of one of them, and what uses it.

Light to import: the extension is enabled, and the command line refuses bad usage, without Blender and the renderer.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from .diagnostics.settings import DiagnosticSettings
from .optics.catalog import Method, entry_of
from .setting import Flag, setting, settings_in
from .settings_choices import (
    ENVIRONMENT_CHOICES,
    FRESNEL_CHOICES,
    METHOD_CHOICES,
    MOTION_CHOICES,
    ViewLayerSettings,
)

STILL_SAMPLES = 16
"""Sub-frames of a saved picture where nothing is chosen"""
LARGEST_SIDE = 8192
"""Of a picture, in pixels"""
MOST_REFERENCE_SAMPLES = 65536
"""Of Cycles, in a comparison"""

_SHADOW_RAYS = "shadow what rays hit by rays, not by depth maps (exact)"


@dataclass(frozen=True, slots=True)
class Settings:
    """What a renderer is asked for (`renderer.settings.check_settings`: whether it can do that). Where settings have a
    panel they are properties of `Scene.curvrefl` too."""

    method: str = setting(
        "secant_star",
        first="auto",
        label="Method",
        text="How reflections are found",
        choices=METHOD_CHOICES,
        panel="Quality",
        preference=True,
        flags=(Flag("render", "--method", "how to reflect", metavar="M"),),
    )
    pixel_tolerance: float = setting(
        0.5,
        label="Tolerance",
        text="Largest error of a reflected edge in pixels; smaller is slower",
        hard=(0.01, 100.0),
        soft=(0.05, 20.0),
        step=0.05,
        unit="pixels",
        panel="Quality",
        preference=True,
        said="A tolerance of {} pixels is",
    )
    """The solver goes to a tenth of it"""
    samples: int = setting(
        2,
        first=8,
        label="Samples",
        text="Pictures that are averaged against jagged edges and noise while the view rests",
        hard=(1, 1024),
        soft=(1, 256),
        panel="Quality",
        preference=True,
        flags=(
            Flag("render", "--samples", "that are averaged: edges, soft light, blur"),
            Flag("compare", "--sub-frames", "of our pictures; at least 16 where the file blurs"),
        ),
        said="{} samples are",
    )
    """Jittered sub-frames; 1: pixel centers only"""
    noise_limit: float = setting(
        0.0,
        label="Noise Limit",
        text="End before all samples are there when the picture's own estimate of its noise is below this, in percent "
        "of the display's range; 0 for never. It is known at 8, 16, 32, ... of more than 32 samples",
        hard=(0.0, 100.0),
        soft=(0.0, 5.0),
        step=0.1,
        unit="percent",
        panel="Quality",
        preference=True,
        flags=(Flag("render", "--noise", "end when the noise is below it, in percent of the display's range"),),
        said="A noise limit of {} percent is",
        least_note="never",
    )
    reuse_frames: int = setting(
        0,
        label="Reuse Frames",
        text="Frames before each that are drawn on in a render, where they have shown the same scene points: so many "
        "times more samples in what was in sight, and noise that does not flicker. 0 for none",
        hard=(0, 15),
        soft=(0, 7),
        unit="frames",
        panel="Quality",
        preference=True,
        flags=(Flag("render", "--reuse-frames", "before each that are drawn on, for films that do not flicker"),),
        said="{} reused frames are",
        least_note="none",
    )
    bounces: int = setting(
        4,
        label="Bounces",
        text="Mirrors seen in mirrors, and in themselves, one after the other; no more than the scene's glossy bounces",
        hard=(1, 64),
        soft=(1, 32),
        panel="Quality",
        preference=True,
        flags=(
            Flag("render", "--bounces", "from mirror to mirror"),
            Flag("compare", "--bounces", "from mirror to mirror, of Cycles' direct light too"),
        ),
        said="{} bounces are",
    )
    """Mirrors on the way of a ray (`exact`); what the last one shows of a mirror is its own light alone"""
    map_resolution: int = setting(
        128,
        label="Map Size",
        text="Texels along an edge of the cube map that a mirror is baked into; more for finer shapes",
        hard=(8, 2048),
        soft=(16, 1024),
        unit="texels",
        panel="Quality",
        preference=True,
        flags=(Flag("bake", "--resolution", "texels along an edge of a map"),),
        said="A map of {} texels is",
    )
    environment_resolution: int = setting(
        512,
        label="Environment Map Size",
        text="Texels along an edge of environment maps: of a cube's faces, of a sphere map's square",
        hard=(8, 4096),
        unit="texels",
        said="An environment map of {} texels is",
    )
    steps: int = setting(
        0,
        label="Search Steps",
        text="Steps of methods that search with a fixed number of them",
        hard=(0, 1000),
        said="{} search steps are",
        least_note="the method's own",
    )
    grid_share: float = setting(
        0.1,
        label="Grid Share",
        text="Points of bounding grids that are solved, as a share of the vertices (bisector_grid)",
        hard=(0.0, 1.0),
        above=True,
        said="A grid share of {} is",
    )
    frustum: float = setting(
        1.25,
        label="Searched Width",
        text="Width of the view that is searched, in widths of the picture (bisector_screen)",
        hard=(1.0, 4.0),
        said="A frustum factor of {} is",
    )
    search_resolution: float = setting(
        1.0,
        label="Search Resolution",
        text="Texels per pixel of the view that is searched (bisector_screen)",
        hard=(0.1, 4.0),
        said="A search resolution of {} texels per pixel is",
    )
    shadow_rays: bool = setting(
        False,
        label="Shadow Rays",
        text="What rays hit is shadowed by rays, not by depth maps (exact): sharp to the last pixel, for about the "
        "time of another walk for each lamp",
        flags=(Flag("render", "--shadow-rays", _SHADOW_RAYS), Flag("compare", "--shadow-rays", _SHADOW_RAYS)),
    )
    caustics: bool = setting(
        False,
        label="Caustics",
        text="Show what lamps throw over mirrors and through glass, whether the file's own renders have it or not",
        panel="Quality",
        preference=True,
        flags=(Flag("render", "--caustics", "show what lamps throw over mirrors and through glass"),),
    )
    caustic_patches: int = setting(
        65536,
        label="Caustic Patches",
        text="Pieces of mirrors and glass whose light is followed to where it lands; more for finer caustics",
        hard=(256, 4194304),
        soft=(4096, 1048576),
        unit="patches",
        panel="Quality",
        preference=True,
        flags=(Flag("render", "--caustic-patches", "of mirrors and glass whose light is followed"),),
        said="{} patches are",
    )
    film_transparent: bool = setting(
        False,
        label="Transparent Film",
        text="The background is left out where the eye sees it itself; mirrors show it",
    )
    """Of renders it is the scene's own"""

    @property
    def entry(self) -> Method:
        """Of the method, in the catalog."""
        return entry_of(self.method)


@dataclass(frozen=True, slots=True)
class SceneSettings:
    """Properties of `Scene.curvrefl` that are not for the renderer to know."""

    motion_resolution: str = setting(
        "AUTO",
        label="While Moving",
        text="Resolution of the reflections while the view or the scene moves",
        choices=MOTION_CHOICES,
        panel="Quality",
        preference=True,
    )
    render_samples: int = setting(
        STILL_SAMPLES,
        label="Render Samples",
        text="Pictures that are averaged against jagged edges and noise in a render (F12)",
        hard=(1, 1024),
        soft=(1, 256),
        panel="Quality",
        preference=True,
        said="{} samples are",
    )
    environment: str = setting(
        "VIEWPORT",
        label="Environment",
        text="What lights the reflected scene and stands behind it",
        choices=ENVIRONMENT_CHOICES,
        panel="Environment",
    )
    environment_image: None = setting(
        None, label="Image", text="Equirectangular image around the scene", panel="Environment"
    )
    environment_strength: float = setting(
        1.0, label="Strength", text="Brightness of the image", hard=(0.0, None), soft=(None, 10.0), panel="Environment"
    )
    environment_rotation: float = setting(
        0.0,
        label="Rotation",
        text="Turn of the image around the vertical axis",
        soft=(-pi, pi),
        unit="radians",
        panel="Environment",
    )


@dataclass(frozen=True, slots=True)
class ObjectSettings:
    """Properties of `Object.curvrefl`."""

    is_mirror: bool = setting(
        False,
        label="Mirror",
        text="Show what this object reflects. It needs a material that reflects, and a shape that is seen whole "
        "from a point inside",
        panel="Curved Reflections",
    )
    override: bool = setting(
        False,
        label="Override Material",
        text="Reflect as set here, whatever the object's materials are",
        panel="Mirror",
    )
    fresnel: str = setting(
        "METAL", label="Fresnel", text="How much is reflected at which angle", choices=FRESNEL_CHOICES, panel="Mirror"
    )
    tint: tuple[float, float, float] = setting(
        (1.0, 1.0, 1.0), label="Tint", text="Color of the reflection", hard=(0.0, 1.0), unit="color", panel="Mirror"
    )
    ior: float = setting(
        1.5, label="IOR", text="Index of refraction: 1.5 is glass or varnish", hard=(1.0, 4.0), panel="Mirror"
    )


@dataclass(frozen=True, slots=True)
class OwnPreferences:
    """What the preferences hold beside what new scenes start with and the colors of diagnostic views."""

    memory_cap: int = setting(
        2048,
        label="Memory Limit",
        text="GPU memory in MB that a scene's meshes may take; larger scenes are not drawn",
        hard=(64, 1 << 20),
        unit="MB",
        preference=True,
    )
    image_memory: int = setting(
        1024,
        label="Image Memory",
        text="GPU memory in MB that a scene's images may take; the largest are drawn with fewer pixels until they do",
        hard=(64, 1 << 20),
        unit="MB",
        preference=True,
    )
    measures_devices: bool = setting(
        True,
        label="Measure New Devices",
        text="Find out what is right and what it costs at a device's or driver's first use, while the view rests",
        preference=True,
    )


RENDERER = settings_in(Settings)
"""Fields of `Settings`"""
OF_SCENES = tuple(
    item for item in (*RENDERER, *settings_in(SceneSettings), *settings_in(DiagnosticSettings)) if item.panel
)
"""Properties of `Scene.curvrefl`"""
OF_OBJECTS = settings_in(ObjectSettings)
"""Properties of `Object.curvrefl`"""
OF_VIEW_LAYERS = settings_in(ViewLayerSettings)
"""Properties of `ViewLayer.curvrefl`"""
OF_NEW_SCENES = tuple(item for item in OF_SCENES if item.preference)
"""Properties of `Scene.curvrefl` whose first values are preferences"""
OF_PREFERENCES = settings_in(OwnPreferences)
NAMED = {item.name: item for item in (*RENDERER, *OF_SCENES, *OF_VIEW_LAYERS, *OF_OBJECTS, *OF_PREFERENCES)}
