# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The methods by name: where each comes from, what it takes for granted, and what trades its speed for accuracy."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Method:
    """One way to the picture of what a mirror reflects."""

    label: str
    source: str
    assumes: str
    """Of the reflector and the scene"""
    sweep: tuple[str, tuple[float, ...]]
    """The field of `renderer.settings.Settings` that trades speed for accuracy, and values of it to chart"""
    maps: tuple[str, ...] = ()
    """What of the reflector its shader `gpu_shaders/solvers/<name>.comp.glsl` reads (see `renderer.vertices.solve`);
    none for a method that looks up an environment (`gpu_shaders/environments/<name>.glsl`)"""
    steps: int = 0
    """Steps of the search where `Settings.steps` is 0; 0 for methods without such a number"""
    grid_search: str = ""
    """Shader that solves the corners of bounding grids, for a method that interpolates between them"""
    follows_rays: bool = False
    """Whether every mirror pixel follows its own reflected ray"""
    chooses: bool = False
    """Whether it chooses one of the others in each view"""
    stragglers: str = ""
    """Shader of a second pass over what the first one has not settled"""
    takes_open: bool = False
    """Whether it works on an open mirror's radial map, whose filled holes make it the closed companion"""
    several_images: bool = False
    """It also looks for the images that a mirror that bends both ways shows beside the first"""
    refracts: bool = False
    """It finds where glass shows vertices through its surface, in place of where a mirror reflects them"""
    curves_edges: bool = False
    """At rest and in stills, edges are split where their solved midpoint leaves the chord"""

    @property
    def solves_vertices(self) -> bool:
        """Whether it finds the reflection points of vertices."""
        return bool(self.maps)

    @property
    def is_environment(self) -> bool:
        """Whether it looks up a map of the surroundings."""
        return not self.maps and not self.follows_rays and not self.chooses

    @property
    def needs_map(self) -> bool:
        """Whether mirrors are baked for it: all but what follows rays knows their star center, at least."""
        return not self.follows_rays and not self.chooses


DEFAULT_COMPARED = ("auto", "exact", "secant_star", "environment_cube")
"""Put beside Cycles where no method is named"""


REFRACTIONS: dict[str, Method] = {
    "newton_refraction": Method(
        "Newton through Glass",
        "Newton on Fermat's principle with Snell's law; proposed by Roger & Holzschuch 2005 and 2006, section 5",
        "every ray from the star center leaves the glass once; one image per vertex; light bends at one surface alone",
        ("pixel_tolerance", (4.0, 1.0, 0.5, 0.25)),
        maps=("radial", "previous"),
        steps=6,
        stragglers="newton_refraction_stragglers",
        refracts=True,
    ),
}
"""Solvers for what glass shows through its surface; no picture is drawn by them"""


def solvers() -> dict[str, Method]:
    """The methods, and what else has a shader in `gpu_shaders/solvers`, by name."""
    return METHODS | REFRACTIONS


def entry_of(name: str) -> Method:
    """Of a method or another solver. Raises KeyError for what is neither."""
    return METHODS[name] if name in METHODS else REFRACTIONS[name]


def label_of(name: str) -> str:
    """What a user reads for a method, or for what stands in its place."""
    found = solvers()
    return found[name].label if name in found else name.capitalize()


METHODS: dict[str, Method] = {
    "auto": Method(
        "Automatic",
        "In each view the cheapest of the others that stays under the error asked for",
        "nothing",
        ("pixel_tolerance", (2.0, 1.0, 0.5, 0.25)),
        chooses=True,
    ),
    "exact": Method(
        "Exact",
        "Each mirror pixel's reflected ray through bounding-volume hierarchies; Whitted 1980, Wald 2007",
        "nothing",
        ("samples", (1, 2, 4)),
        follows_rays=True,
    ),
    "secant_star": Method(
        "Secant Search",
        "Roger & Holzschuch 2006, section 3.3, with a safeguarded end",
        "every ray from the star center leaves the reflector once; one reflection per vertex",
        ("pixel_tolerance", (8.0, 4.0, 2.0, 1.0, 0.5, 0.25)),
        maps=("radial",),
        steps=4,
        curves_edges=True,
    ),
    "newton": Method(
        "Newton",
        "Safeguarded Newton on Fermat's principle, from the last frame's points",
        "every ray from the star center leaves the reflector once; one reflection per vertex and region of curvature",
        ("pixel_tolerance", (4.0, 1.0, 0.5, 0.25)),
        maps=("radial", "previous"),
        steps=6,
        stragglers="newton_stragglers",
        several_images=True,
        curves_edges=True,
    ),
    "secant_uv": Method(
        "Secant Search in UV",
        "Roger & Holzschuch 2005, section 3",
        "a grid-like mesh whose UV map covers the unit square once; one reflection per vertex",
        ("steps", (3, 4, 5, 8, 12)),
        maps=("parametric",),
        steps=5,
    ),
    "bisector_cube": Method(
        "Bisector Field",
        "Estalella et al. 2005, section 4",
        "a star-shaped reflector that is convex or concave all over",
        ("steps", (3, 5, 7, 9, 15, 30)),
        maps=("radial",),
        steps=9,
        takes_open=True,
    ),
    "bisector_grid": Method(
        "Bisector Field on Grids",
        "Estalella et al. 2005, section 5",
        "as Bisector Field, and that reflections are smooth across a cell of each mesh's bounding grid",
        ("grid_share", (0.041, 0.055, 0.096, 0.143, 0.5)),
        maps=("radial",),
        steps=9,
        grid_search="bisector_cube",
        takes_open=True,
    ),
    "bisector_screen": Method(
        "Bisector on Screen",
        "Estalella et al. 2006",
        "the reflection point is in view, and no other part of the reflector is in front of it",
        ("search_resolution", (0.25, 0.5, 1.0, 2.0)),
        maps=("screen", "previous"),
    ),
    "planar": Method(
        "Planar Mirror",
        "McReynolds 1996; Roger & Holzschuch 2006, section 2",
        "the reflector is flat",
        ("pixel_tolerance", (0.5,)),
        maps=("plane",),
    ),
    "environment_cube": Method(
        "Environment Cube",
        "Blinn & Newell 1976; six faces from the reflector's center",
        "everything is infinitely far away",
        ("environment_resolution", (64, 128, 256, 512)),
    ),
    "environment_cube_vertex": Method(
        "Environment at Vertices",
        "COMP 557, lecture 18: colors looked up at the mirror's vertices and interpolated",
        "as Environment Cube, and that what is reflected does not change within a triangle of the mirror",
        ("environment_resolution", (64, 128, 256, 512)),
    ),
    "environment_sphere": Method(
        "Environment Sphere Map",
        "COMP 557, lecture 18; a disk map along the axis to the eye",
        "as Environment Cube, and that nothing of interest lies straight behind the mirror",
        ("environment_resolution", (64, 128, 256, 512, 1024)),
    ),
    "environment_parallax": Method(
        "Environment on a Sphere",
        "Bjorke 2004; Roger & Holzschuch 2006, section 2",
        "everything lies on one sphere about the reflector",
        ("environment_resolution", (64, 128, 256, 512)),
    ),
}
