# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user chooses from: values of settings with choices, and passes of renders."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .optics.catalog import METHODS
from .setting import Choice, setting

METHOD_CHOICES = tuple(
    Choice(name, method.label, f"{method.source}. Assumes: {method.assumes}") for name, method in METHODS.items()
)
MOTION_CHOICES = (
    Choice("FULL", "Full", "Every pixel, also while something moves"),
    Choice("HALF", "Half", "A quarter of the pixels while something moves"),
    Choice("QUARTER", "Quarter", "A sixteenth of the pixels while something moves"),
    Choice("AUTO", "Automatic", "As many pixels while something moves as are drawn in a thirtieth of a second"),
)
ENVIRONMENT_CHOICES = (
    Choice(
        "VIEWPORT",
        "As the Viewport",
        "The studio light in Material Preview where it is on, else the scene's world and lights",
    ),
    Choice("SCENE", "Scene", "The scene's world and lights, however the viewport is shaded"),
    Choice("IMAGE", "Image", "An equirectangular image in place of the world, and the scene's lights"),
)
DIAGNOSTIC_CHOICES = (
    Choice("ITERATIONS", "Iterations", "How many steps the search for the reflection point took"),
    Choice("STATUS", "Status", "Which vertices have a reflection, are hidden by the mirror, or were not found"),
    Choice(
        "ANGLE_ERROR",
        "Angle Error",
        "How far what is shown stands from the reflected ray of its pixel, in degrees",
    ),
    Choice("METHOD", "Method", "Which method drew what"),
    Choice(
        "ZEBRA", "Zebra Stripes", "Black and white bands around an axis, infinitely far away, to inspect the surface"
    ),
    Choice("LINES", "Line Lights", "Long thin lamps along an axis, infinitely far away, to inspect the surface"),
    Choice("ISOPHOTES", "Isophotes", "Bands of equal angle between the surface's normal and a direction"),
    Choice("HIGHLIGHTS", "Highlight Lines", "Where the surface's normal points at lamps along an axis, far away"),
    Choice("CURVATURE", "Curvature", "How much the surface bends, as colors"),
)
LOCK_CHOICES = (
    Choice("WORLD", "World", "The pattern stays where it is in the world"),
    Choice("OBJECT", "Object", "The pattern turns with each mirror, whose own axes the direction is in"),
    Choice("VIEW", "View", "The pattern turns with the view: X is right, Y is up, Z is towards the eye"),
)
PLANE_CHOICES = (
    Choice("OBJECT", "Object", "Each mirror's own plane, through its origin and across one of its own axes"),
    Choice("WORLD", "World", "One plane, through the world's origin and across one of its axes"),
    Choice("CURSOR", "3D Cursor", "One plane, through the 3D cursor and across one of its axes"),
)
AXIS_CHOICES = tuple(Choice(name, name, f"The plane is across the {name} axis") for name in "XYZ")
CURVATURE_CHOICES = (
    Choice("GAUSSIAN", "Gaussian", "Product of the principal curvatures: above 0 on domes and bowls, below on saddles"),
    Choice("MEAN", "Mean", "Half of the principal curvatures' sum: above 0 where the surface bends outwards"),
    Choice("STRONGEST", "Absolute Maximum", "The larger absolute value of the principal curvatures"),
    Choice("LARGEST", "Largest", "The larger principal curvature"),
    Choice("SMALLEST", "Smallest", "The smaller principal curvature"),
)
FRESNEL_CHOICES = (
    Choice("METAL", "Metal", "Reflects the tint face on, and white at grazing angles"),
    Choice("DIELECTRIC", "Dielectric", "Reflects little face on and all at grazing angles, by the index of refraction"),
    Choice("CONSTANT", "Constant", "Reflects the tint at every angle"),
)


def _switch(label: str, text: str) -> Any:
    return setting(False, label=label, text=text, panel="Passes")


@dataclass(frozen=True, slots=True)
class ViewLayerSettings:
    """Properties of `ViewLayer.curvrefl`: what renders have beside the picture."""

    use_pass_mirror: bool = _switch(
        "Mirror",
        "What the mirrors show and nothing else, with the mirrors' coverage as alpha; it is drawn on its own",
    )
    use_pass_position: bool = _switch(
        "Position",
        "Where in the world that is what the mirrors show at the pixels' centers (W is 1), or in which direction "
        "its background (W is 0)",
    )
    use_pass_object: bool = _switch(
        "Object", "The number of the object that the mirrors show there, 0 for the background"
    )
    use_pass_iterations: bool = _switch("Iterations", "How many steps the search for the reflection point took there")
    use_pass_normal: bool = _switch(
        "Normal", "World-space shading normal of the surface that the mirrors show, by rays as all that follow"
    )
    use_pass_albedo: bool = _switch("Albedo", "Base color of the surface that the mirrors show")
    use_pass_depth: bool = _switch(
        "Depth", "Meters along the path from the eye over the mirror to what it shows; 1e10 for the background"
    )
    use_pass_distance: bool = _switch("Distance", "Meters from the mirror to what it shows; 1e10 for the background")
    use_pass_path_length: bool = _switch(
        "Path Length", "Meters along the whole path, from mirror to mirror, to the first surface that is none"
    )
    use_pass_uv: bool = _switch(
        "UV", "Place in the UV map that renders use, of what the mirrors show; A is 1 where it has one"
    )
    use_pass_incidence: bool = _switch(
        "Incidence", "Angle in radians between the mirror's normal and the line of sight"
    )
    use_pass_images: bool = _switch(
        "Images",
        "How many images of the same scene point the mirrors show, seen from here; seconds of search on the processor",
    )
    use_pass_vector: bool = _switch(
        "Vector",
        "Motion of what the mirrors show, in pixels: from here to the frame before (X, Y) and from the frame after to "
        "here (Z, W); seconds of search on the processor",
    )
    use_pass_mirror_id: bool = _switch("Mirror ID", "The number of the mirror's object, as the pass Object counts")
