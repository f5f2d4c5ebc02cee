# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirror anamorphoses: what has to stand where so that a mirror shows a picture, seen by one eye.

Lines of sight through a lattice of places in the picture are followed to what they meet (`ways`). Between the places
of a cell the map from the picture to a surface is taken as linear, and turned round: each texel of an image on the
surface whose middle is in the cell's picture there knows its own place in the picture, and the part of it that it
covers. So there are no holes, and what the mirror does not show stays empty.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ...scene.arrays import Float32Array, Float64Array, MeshArrays, SceneArrays
from ...scene.camera.view import View
from ..ways import Ways, WaysByMirrors
from .charts import affine_maps, grown, islands_of, texels_of
from .lattice import Cells, cells_of, joined
from .picture import Picture
from .picture_frame import PictureFrame, ways_of_picture

FINENESS = 512
"""Cells of the lattice along the longer side of a picture"""
BEYOND = 2
"""Cells past each of the picture's edges, at least"""
LARGE, SPLITS = 8.0, 3
"""Texels along a triangle's longest side from which on its middle is looked at; how often it is split"""
BENT = 0.25
"""How far that may be from where it should be, in such sides"""
SAME_PLACE = 3.0
"""Cells within which a texel's place in the picture is the one that is asked for"""
MOST_NAMED = 5
"""Other objects in a landing's sentences"""
SEEN_MARGIN = 3
"""Texels past the end of what the mirror shows that are filled, as that is known to a cell alone"""
MARGIN = 8
"""Texels around a surface's islands that are filled, for lookups between texels"""

type Locate = Callable[[Ways], tuple[Float64Array, NDArray[np.int64]]]
"""Where ways end on an image, in texels (n, 2), and on which piece of a surface (n,)"""


@dataclass(frozen=True, slots=True)
class Chart:
    """A surface and where it is on an image."""

    object_id: int
    mesh: MeshArrays
    places: Float64Array
    """(corners, 2) of the mesh, from 0 to 1 on the image"""


@dataclass(frozen=True, slots=True)
class Landing:
    """What becomes of a picture; shares of it, which add up to 1."""

    shown: float
    """Is on the surfaces' images, and seen in the mirror"""
    off_mirror: float
    """No mirror is seen there: beside it, or behind other things"""
    background: float
    """The mirror shows nothing there"""
    twice: float
    """Is to be where another part of it is: the mirror shows a place of the surface twice, or two have one texel"""
    outside: float
    """Is past the edges of the image"""
    elsewhere: dict[str, float] = field(default_factory=dict)
    """By the names of other objects, which the mirror shows there, the largest first"""

    def sentences(self, names: str) -> list[str]:
        """How much is shown, and what becomes of the rest; `names` of the surfaces."""
        others = list(self.elsewhere.items())
        rest = [
            (self.off_mirror, "is not on the mirror"),
            (self.background, "shows the background"),
            *((share, f'lands on "{name}"') for name, share in others[:MOST_NAMED]),
            (sum(share for _, share in others[MOST_NAMED:]), "lands on other things"),
            (self.twice, "would be where another part of it is seen, too"),
            (self.outside, "lands past the edges of the image"),
        ]
        found = [f"{100.0 * self.shown:.1f} % of the picture is on {names}."]
        return found + [f"{100.0 * share:.1f} % {what}." for share, what in rest if share >= 5e-4]


@dataclass(frozen=True, slots=True)
class Placed:
    """An image for a surface."""

    object_id: int
    pixels: Float32Array
    """(h, w, 4) as the picture's are stored, row 0 at the bottom; 0 where the mirror does not show the surface"""
    on_image: Float64Array
    """(n, 2) where each place of the lattice is on it, from 0 to 1; NaN where it shows something else"""
    rightly: NDArray[np.bool_]
    """(n,) whether the image has the picture's own part there"""
    coarseness: float
    """Pixels of the picture along a texel, in half of the texels"""


class Anamorphosis:
    """One picture's place in one view, and what lines of sight through it meet."""

    def __init__(
        self,
        ways: WaysByMirrors,
        scene: SceneArrays,
        view: View,
        frame: PictureFrame,
        mirrors: set[int],
        fineness: int = FINENESS,
        beyond: float = 0.0,
    ) -> None:
        """`mirrors`: object_id of those that the picture is to be seen in. `beyond`: how far past its edges lines of
        sight are followed, in shares of its size."""
        self.frame = frame
        self.mirrors = mirrors
        shape = abs(float(view.view_to_clip[1, 1] / view.view_to_clip[0, 0])) * frame.width / frame.height
        self._counts = np.maximum(np.rint(np.array([shape, 1.0]) / max(shape, 1.0) * fineness), 8.0).astype(np.int64)
        past = np.maximum(np.ceil(beyond * self._counts), BEYOND).astype(np.int64)
        self._past = past
        x, y = (np.arange(-past[k], self._counts[k] + past[k] + 1) / self._counts[k] for k in range(2))
        self.shape = (len(y), len(x))
        self.places: Float64Array = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        """(n, 2) of the picture, n = rows times columns of `shape`"""
        self._follow: Callable[[Float64Array], Ways] = partial(ways_of_picture, ways, view, frame)
        self.ways = self._follow(self.places)
        self.on_mirror: NDArray[np.bool_] = np.isin(self.ways.mirror, list(mirrors))
        """(n,)"""
        self.within: NDArray[np.bool_] = ((self.places >= 0.0) & (self.places <= 1.0)).all(axis=1)
        self._names = {item.object_id: item.object_name for item in scene.instances}

    @property
    def cell(self) -> Float64Array:
        """(2,) the lattice's steps."""
        return 1.0 / self._counts

    def lines(self, parts: int) -> tuple[list[int], list[int]]:
        """Rows and columns of the lattice that part the picture so many times along each side, its edges included."""
        rows, columns = (
            [int(past + round(k * count / parts)) for k in range(parts + 1)]
            for past, count in zip(self._past[::-1].tolist(), self._counts[::-1].tolist(), strict=True)
        )
        return rows, columns

    def on(self, object_id: int) -> NDArray[np.bool_]:
        """(n,) where the mirror shows this object."""
        return self.on_mirror & (self.ways.object == object_id)

    def image(self, chart: Chart, width: int, height: int, picture: Picture, margin: int = MARGIN) -> Placed:
        """The image to put on a surface."""
        corners = chart.places * [width, height]
        triangles = chart.mesh.triangles
        island = islands_of(chart.mesh.corner_vertex[triangles], chart.places[triangles])
        of_corner = np.zeros(len(corners), np.int64)
        of_corner[triangles] = island[:, None]
        surface = np.full(width * height, -1)
        for triangle, texel in texels_of(corners[triangles], width, height):
            surface[texel] = island[triangle]

        def to_image(ways: Ways) -> Float64Array:
            return np.asarray(np.einsum("nk,nkj->nj", ways.weights, chart.places[ways.corners]), np.float64)

        def island_at(ways: Ways) -> NDArray[np.int64]:
            return of_corner[ways.corners[:, 0]]

        return self.placed(chart.object_id, to_image, width, height, picture, island_at, surface, margin)

    def placed(
        self,
        object_id: int,
        to_image: Callable[[Ways], Float64Array],
        width: int,
        height: int,
        picture: Picture,
        island_at: Callable[[Ways], NDArray[np.int64]] | None = None,
        surface: NDArray[np.int64] | None = None,
        margin: int = MARGIN,
    ) -> Placed:
        """An image by what says where on it, from 0 to 1, ways end that end on the object. `island_at` says on which
        of the image's islands, `surface` (height * width,) which of these has each texel, -1 for none; None where there
        are no islands."""

        def locate(ways: Ways) -> tuple[Float64Array, NDArray[np.int64]]:
            """Where on the image, in texels, and on which piece; NaN and -1 for what does not show the object."""
            here = np.isin(ways.mirror, list(self.mirrors)) & (ways.object == object_id)
            chosen = ways.some(here)
            places, label = np.full((len(here), 2), np.nan), np.full(len(here), -1)
            places[here] = to_image(chosen) * [width, height]
            # (What stands at another place is not the same piece, though its texels are.)
            label[here] = (0 if island_at is None else island_at(chosen) * (1 << 32)) + chosen.instance
            return places, label

        on_texels, piece = locate(self.ways)
        cells = cells_of(on_texels.reshape(*self.shape, 2), piece.reshape(self.shape), self.places)
        cells = self._refined(cells, locate, piece)
        flat = np.full(width * height, -1)
        of_cell = piece[cells.first] >> 32
        for triangle, texel in texels_of(cells.corners, width, height):
            mine = slice(None) if surface is None else surface[texel] == of_cell[triangle]
            flat[texel[mine]] = triangle[mine]
        owner = flat.reshape(height, width)
        for _ in range(SEEN_MARGIN):
            owner = grown(owner, np.ones_like(owner, bool))
        if surface is not None:
            bare = (surface < 0).reshape(height, width)
            for _ in range(margin - SEEN_MARGIN):
                owner = grown(owner, bare)
        matrix, offset = affine_maps(cells.corners, cells.values)
        pixels = np.zeros((height, width, 4), np.float32)
        row, column = np.nonzero(owner >= 0)
        owned = owner[row, column]
        middles = np.column_stack([column + 0.5, row + 0.5])
        places = np.einsum("nij,nj->ni", matrix[owned], middles) + offset[owned]
        pixels[row, column] = picture.stored(picture.over(places, matrix[owned]))
        shown = ((places > 0.0) & (places < 1.0)).all(axis=1)
        steps = np.linalg.norm(matrix[owned[shown]] * [[picture.width], [picture.height]], axis=1).max(axis=1)
        coarseness = float(np.median(steps)) if len(steps) else np.inf
        rightly = self._rightly(on_texels, self.on(object_id), owner, matrix, offset)
        return Placed(object_id, pixels, on_texels / [width, height], rightly, coarseness)

    def _refined(self, cells: Cells, locate: Locate, piece: NDArray[np.int64]) -> Cells:
        """The same with large triangles split whose middles are not where their corners say: about a tip or a fold.
        What is still so after all splits is left out: something is before the surface there."""
        parts = [cells.some(cells.longest <= LARGE)]
        left = cells.some(cells.longest > LARGE)
        for splits in range(SPLITS + 1):
            good = self._bends(left, locate, piece) <= BENT
            parts.append(left.some(good))
            left = left.some(~good & left.is_whole)
            if splits == SPLITS or not len(left.first):
                break
            left = self._split(left, locate, piece)
            parts.append(left.some(left.longest <= LARGE))
            left = left.some(left.longest > LARGE)
        return joined(parts)

    def _bends(self, cells: Cells, locate: Locate, piece: NDArray[np.int64]) -> Float64Array:
        """(t,) how far triangles' middles are from where they should be, in their longest sides."""
        found, label = locate(self._follow(cells.values.mean(axis=1)))
        # (Where a piece has gone on past its end, the middle may well be on another.)
        same = label == piece[cells.first]
        off = np.where(cells.is_whole, np.inf, 0.0)
        off[same] = np.linalg.norm(found - cells.corners.mean(axis=1), axis=1)[same]
        return np.asarray(off / cells.longest, np.float64)

    def _split(self, cells: Cells, locate: Locate, piece: NDArray[np.int64]) -> Cells:
        """Each in four by the middles of its sides, as far as these are on its piece."""
        between = 0.5 * (cells.values + np.roll(cells.values, -1, axis=1))
        found, label = locate(self._follow(between.reshape(-1, 2)))
        corners = np.concatenate([cells.corners, found.reshape(-1, 3, 2)], axis=1)
        values = np.concatenate([cells.values, between], axis=1)
        is_there = np.ones(corners.shape[:2], bool)
        is_there[:, 3:] = label.reshape(-1, 3) == piece[cells.first][:, None]
        chosen = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])
        first = np.repeat(cells.first, len(chosen))
        kept = is_there[:, chosen].all(axis=2).reshape(-1)
        parts = (
            corners[:, chosen].reshape(-1, 3, 2),
            values[:, chosen].reshape(-1, 3, 2),
            first,
            np.ones(len(first), bool),
        )
        return Cells(*parts).some(kept)

    def _rightly(
        self,
        on_image: Float64Array,
        here: NDArray[np.bool_],
        owner: NDArray[np.int64],
        matrix: Float64Array,
        offset: Float64Array,
    ) -> NDArray[np.bool_]:
        height, width = owner.shape
        node = np.flatnonzero(here)
        texel = np.floor(on_image[node]).astype(np.int64)
        inside = ((texel >= 0) & (texel < [width, height])).all(axis=1)
        node, texel = node[inside], texel[inside]
        owned = owner[texel[:, 1], texel[:, 0]]
        node, owned = node[owned >= 0], owned[owned >= 0]
        place = np.einsum("nij,nj->ni", matrix[owned], on_image[node]) + offset[owned]
        off = np.abs(place - self.places[node])
        # (From the middle of its texel, a place of the picture is as far as that covers of it.)
        allowed = SAME_PLACE * self.cell + np.abs(matrix[owned]).sum(axis=2)
        result = np.zeros(len(here), bool)
        result[node[(off <= allowed).all(axis=1)]] = True
        return result

    def landing(self, images: Sequence[Placed]) -> Landing:
        """What becomes of the picture with these images on their surfaces."""
        total = max(int(self.within.sum()), 1)
        seen = self.within & self.on_mirror

        def share(chosen: NDArray[np.bool_]) -> float:
            return float((chosen & self.within).sum()) / total

        shown, outside, twice = np.zeros((3, len(seen)), bool)
        other = seen & (self.ways.object > 0)
        for item in images:
            here = self.on(item.object_id)
            other &= ~here
            shown |= here & item.rightly
            past = np.zeros_like(here)
            past[here] = ((item.on_image[here] < 0.0) | (item.on_image[here] > 1.0)).any(axis=1)
            outside |= past
            twice |= here & ~item.rightly & ~past
        numbers, counts = np.unique(self.ways.object[other], return_counts=True)
        by_count = sorted(zip(counts.tolist(), numbers.tolist(), strict=True), reverse=True)
        return Landing(
            share(shown),
            share(~self.on_mirror),
            share(seen & (self.ways.object == 0)),
            share(twice),
            share(outside),
            {self._names[number]: count / total for count, number in by_count},
        )
