# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of what mirrors show at the pixels' centers: normals, distances, texture coordinates and so on.

A mirror that is seen in a mirror counts as the point of it that is hit; the length of the whole path alone goes on.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...scene.arrays import Float32Array, Float64Array, SceneArrays
from ...scene.camera.shutter import Moment
from .images import image_counts
from .motion import places_then
from .shown_points import ShownPoints

FAR_AWAY = 1e10
"""Distance of the background, as in Blender's own pass Depth"""


def _go_on() -> None:
    """Nothing asks for a pause."""


class MirrorTruth:
    """Of one view. Arrays are float32, (h, w) or (h, w, channels), row 0 at the bottom; 0 where no mirror is seen."""

    def __init__(self, scene: SceneArrays, points: ShownPoints) -> None:
        self.scene, self.points = scene, points
        self.beside: tuple[Moment | None, Moment | None] = (None, None)
        """The frames before and after, for `vector`"""
        self.pause: Callable[[], None] = _go_on
        """Called between slices of what takes long; what it raises ends it"""
        self.remarks: list[str] = []
        """What the pictures made so far do not show, one sentence each"""

    def picture(self, values: Float64Array) -> Float32Array:
        """(h, w, ...) of values (n, ...) of the points."""
        view = self.points.view
        whole = np.zeros((view.height * view.width, *values.shape[1:]), np.float32)
        whole[self.points.pixel] = values
        return whole.reshape(view.height, view.width, *values.shape[1:])

    def normal(self) -> Float32Array:
        """(h, w, 3) unit shading normal of the surface that is shown, world space, towards the mirror."""
        return self.picture(self.points.normal)

    def albedo(self) -> Float32Array:
        """(h, w, 3) its base color, scene-linear."""
        return self.picture(self.points.albedo)

    def depth(self) -> Float32Array:
        """(h, w) meters along the path from the eye over the mirror to it."""
        return self.picture(np.where(self.points.is_surface, self._to_mirror() + self._onward(), FAR_AWAY))

    def distance(self) -> Float32Array:
        """(h, w) meters from the mirror to it."""
        return self.picture(np.where(self.points.is_surface, self._onward(), FAR_AWAY))

    def path_length(self) -> Float32Array:
        """(h, w) meters along the whole path, from mirror to mirror as far as they are followed."""
        return self.picture(np.minimum(self._to_mirror() + self.points.way, FAR_AWAY))

    def uv(self) -> Float32Array:
        """(h, w, 3) place on it in the UV map that renders use, and 1 where it has one."""
        points = self.points
        values = np.zeros((len(points.pixel), 3))
        for number in np.unique(points.instance[points.is_surface]).tolist():
            mesh = self.scene.meshes[self.scene.instances[number].mesh]
            if mesh.corner_uv is not None:
                here = points.instance == number
                corners = mesh.corner_uv[mesh.triangles[points.triangle[here]]].astype(np.float64)
                values[here, :2] = np.einsum("nk,nkj->nj", points.weights[here], corners)
                values[here, 2] = 1.0
        return self.picture(values)

    def incidence(self) -> Float32Array:
        """(h, w) angle in radians between the mirror's shading normal and the line of sight."""
        towards, facing = self._towards_eye(), self.points.facing
        across = np.linalg.norm(np.cross(towards, facing), axis=1)
        return self.picture(np.arctan2(across, np.einsum("ij,ij->i", towards, facing)))

    def mirror_id(self) -> Float32Array:
        """(h, w) number of the mirror's object, as the pass Object counts."""
        numbers = np.array([instance.object_id for instance in self.scene.instances], np.float64)
        return self.picture(numbers[self.points.mirror])

    def images(self) -> Float32Array:
        """(h, w) images of the scene point that the mirrors show at once: see `images.image_counts`."""
        self._leave_out_bumps("Images")
        return self.picture(image_counts(self.scene, self.points, self.pause).astype(np.float64))

    def vector(self) -> Float32Array:
        """(h, w, 4) pixels from where the mirror shows the same scene point now to where it did in the frame before,
        and from where it will in the frame after to now, right and up, as Blender's own pass; 0 where it does not.
        """
        self._leave_out_bumps("Vector")
        values = np.zeros((len(self.points.pixel), 4))
        width = self.points.view.width
        here = np.column_stack([self.points.pixel % width, self.points.pixel // width]) + 0.5
        for number, (moment, sign, said) in enumerate(zip(self.beside, (1.0, -1.0), ("before", "after"), strict=True)):
            if moment is None:
                self.remarks.append(f"The frame {said} cannot be read: Vector is 0 towards it.")
                continue
            there, known = places_then(self.scene, self.points, moment.scene, moment.view, self.pause)
            values[known, 2 * number : 2 * number + 2] = sign * (there - here)[known]
            if not known.all():
                self.remarks.append(
                    f"In {np.count_nonzero(~known)} pixels the mirror does not show the same in the frame {said}: "
                    "Vector is 0 there."
                )
        return self.picture(values)

    def _leave_out_bumps(self, name: str) -> None:
        """Say of which mirrors reflection points are those of the smooth surface."""
        for number in np.unique(self.points.mirror).tolist():
            item = self.scene.instances[number]
            if any(self.scene.materials[index].varies("normal") for index in item.materials):
                self.remarks.append(f'{name} leaves out the bumps of mirror "{item.object_name}".')

    def _towards_eye(self) -> Float64Array:
        """(n, 3) unit."""
        eye = self.points.view.eye
        way = eye[:3] - self.points.seen * eye[3]
        return way / np.linalg.norm(way, axis=1, keepdims=True)

    def _to_mirror(self) -> Float64Array:
        """(n,) meters along the line of sight; in an orthographic view from the plane that the camera is in."""
        view, seen = self.points.view, self.points.seen
        if view.is_orthographic:
            return (view.place - seen) @ view.eye[:3]
        return np.linalg.norm(view.place - seen, axis=1)

    def _onward(self) -> Float64Array:
        """(n,) meters from the mirror to what is shown; of surfaces."""
        return np.linalg.norm(self.points.shown[:, :3] - self.points.seen, axis=1)
