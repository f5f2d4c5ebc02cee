# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the GGX microfacet lobe, and of sheen.

The lobe is Walter et al., "Microfacet Models for Refraction through Rough Surfaces" (2007), with the height-correlated
Smith term; its albedo is the mean of G2 / G1 over visible normals (Heitz, "Sampling the GGX Distribution of Visible
Normals", JCGT 2018).
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

from ...optics.scattering.film import FILM_STEPS, LONGEST_PATH, film_sensitivity
from ...optics.scattering.fresnel import fresnel_dielectric
from ...optics.scattering.sheen import sheen_table
from ...scene.arrays import Float32Array, Float64Array

TABLE_SIZE = 32
"""Steps of roughness and of the viewer's cosine, both 0..1"""
IOR_SLICES = 16
"""Steps of sqrt((ior - 1) / (ior + 1)), 0..1"""
GLASS_STEPS = 2 * IOR_SLICES - 1
"""The same of glass, whose albedo is less even"""
GGX_DEFINES = {
    "GGX_TABLE_SIZE": TABLE_SIZE,
    "GGX_IOR_SLICES": IOR_SLICES,
    "GGX_FILM_STEPS": FILM_STEPS,
    "GGX_LONGEST_PATH": LONGEST_PATH,
}
"""What `ggx.glsl` knows of the table"""
TABLE_FILE = Path(__file__).with_name("ggx_table.npy")
"""`integrate_ggx()` in half precision, by tools/make_ggx_table.py: integrating would take seconds of every start"""


@cache
def ggx_table() -> Float32Array:
    """(4 * TABLE_SIZE, TABLE_SIZE * (IOR_SLICES + 1), 4): what is stored of `integrate_ggx`; below it two rows of
    `film_sensitivity`: real parts of red, green and blue, and imaginary ones; and in the last quarter sheen.

    (Sizes are powers of two along y, so that places there are exact.)
    """
    table = np.zeros((4 * TABLE_SIZE, TABLE_SIZE * (IOR_SLICES + 1), 4), np.float32)
    table[: 2 * TABLE_SIZE] = np.load(TABLE_FILE)
    sensitivity = film_sensitivity()
    table[2 * TABLE_SIZE, :FILM_STEPS, :3] = sensitivity.real
    table[2 * TABLE_SIZE + 1, :FILM_STEPS, :3] = sensitivity.imag
    table[3 * TABLE_SIZE :, :TABLE_SIZE, :3] = sheen_table()
    return table


def integrate_ggx(strata: int = 96) -> Float32Array:
    """(2 * TABLE_SIZE, TABLE_SIZE * (IOR_SLICES + 1), 4): `integrate_lobe` above `integrate_glass`."""
    return np.concatenate([integrate_lobe(strata), integrate_glass(strata)])


def integrate_glass(strata: int) -> Float32Array:
    """(TABLE_SIZE, TABLE_SIZE * (IOR_SLICES + 1), 4): as `integrate_lobe`, of an interface that reflects and refracts.

    There are twice as many steps of IOR, two to a slice. x, y: albedo of single scattering, seen from outside an object
    of either IOR; z, w: the same from inside, where what is not refracted is reflected wholly. In the last slice, whose
    columns are the steps of IOR in place of cosines: x, z: the averages over all angles, cosine-weighted, from outside
    and inside.
    """
    cosine = np.maximum(np.linspace(0.0, 1.0, TABLE_SIZE), 1e-3)
    table = np.zeros((TABLE_SIZE, IOR_SLICES + 1, TABLE_SIZE, 4))
    iors = _iors(GLASS_STEPS, 0.9999)
    places = np.linspace(0.0, 1.0, GLASS_STEPS)
    for row, rough in enumerate(np.linspace(0.0, 1.0, TABLE_SIZE)):
        alpha = max(rough * rough, 1e-4)
        weight, cos_difference, light = _sample_lobe(alpha, cosine, strata)
        normal_z = (light[..., 2] + cosine[:, None]) / (2.0 * cos_difference)
        averages = np.zeros((GLASS_STEPS, 2))
        for index, ior in enumerate(iors):
            for side, eta in enumerate((ior, 1.0 / ior)):
                # (Never below that along the normal, as it is shaded.)
                reflected = np.maximum(fresnel_dielectric(cos_difference, eta), ((eta - 1.0) / (eta + 1.0)) ** 2)
                inner = np.sqrt(np.maximum(1.0 - (1.0 - cos_difference**2) / eta**2, 0.0))
                light_z = (cos_difference / eta - inner) * normal_z - cosine[:, None] / eta
                lambda_view = _smith_lambda(alpha, cosine)[:, None]
                lambda_light = _smith_lambda(alpha, np.maximum(-light_z, 1e-9))
                bent = np.where(light_z < 0.0, (1.0 + lambda_view) / (1.0 + lambda_view + lambda_light), 0.0)
                albedo = (reflected * weight + (1.0 - reflected) * bent).mean(axis=1)
                table[row, index // 2, :, 2 * side + index % 2] = albedo
                averages[index, side] = 2.0 * np.trapezoid(albedo * cosine, cosine)
        for side in (0, 1):
            table[row, -1, :, 2 * side] = np.interp(np.linspace(0.0, 1.0, TABLE_SIZE), places, averages[:, side])
    return table.reshape(TABLE_SIZE, -1, 4).astype(np.float32)


def integrate_lobe(strata: int) -> Float32Array:
    """(TABLE_SIZE, TABLE_SIZE * (IOR_SLICES + 1), 4): rows roughness, columns the viewer's cosine, once per slice.

    x: albedo with Fresnel 1; y: mean over the lobe of Schlick's (1 - cos)^5; z: mean over the lobe of
    (F - F0) / (1 - F0), not below 0, of the dielectric of this slice's IOR; w: the same of the next slice; of the last
    one the mean over the lobe of cos (1 - cos)^6, which tints metal at the edge.
    The slice after the last describes the lobe: x: cosine between its mean direction and the normal; y: roughness of
    the lobe about its own normal, seen along it, that is spread as much; z, w: the same of a dielectric's lobe
    (IOR 1.5), whose Fresnel term draws it to the rim.
    `strata` squared is the number of sampled normals per entry.
    """
    roughness = np.linspace(0.0, 1.0, TABLE_SIZE)
    cosine = np.maximum(np.linspace(0.0, 1.0, TABLE_SIZE), 1e-3)
    table = np.zeros((TABLE_SIZE, IOR_SLICES + 1, TABLE_SIZE, 4))
    iors = _iors(IOR_SLICES, 0.99)
    for row, rough in enumerate(roughness):
        weight, cos_difference, light = _sample_lobe(max(rough * rough, 1e-4), cosine, strata)
        albedo = weight.mean(axis=1)
        table[row, :, :, 0] = albedo
        total = np.maximum(weight.sum(axis=1), 1e-9)
        for index, ior in enumerate(iors):
            f0 = ((ior - 1.0) / (ior + 1.0)) ** 2
            share = np.maximum((fresnel_dielectric(cos_difference, ior) - f0) / (1.0 - f0), 0.0)
            table[row, index, :, 2] = (weight * share).sum(axis=1) / total
        table[row, :, :, 1] = (weight * (1.0 - cos_difference) ** 5).sum(axis=1) / total
        table[row, :-2, :, 3] = table[row, 1:-1, :, 2]
        table[row, -2, :, 3] = (weight * cos_difference * (1.0 - cos_difference) ** 6).sum(axis=1) / total
        for channel, part in ((0, weight), (2, weight * fresnel_dielectric(cos_difference, 1.5))):
            mean = (part[..., None] * light).sum(axis=1) / np.maximum(part.sum(axis=1), 1e-9)[:, None]
            lengths = np.linalg.norm(mean, axis=1)
            table[row, -1, :, channel] = mean[:, 2] / lengths
            table[row, -1, :, channel + 1] = lengths
    own_lobes = _own_lobe_lengths(roughness)
    table[:, -1, :, 1::2] = np.interp(-table[:, -1, :, 1::2], -own_lobes, roughness)
    return table.reshape(TABLE_SIZE, -1, 4).astype(np.float32)


def _iors(count: int, last: float) -> list[float]:
    squares = np.minimum(np.linspace(0.0, 1.0, count), last) ** 2
    return [float(max((1.0 + z) / (1.0 - z), 1.0 + 1e-4)) for z in squares]


def own_lobe(cosine: np.ndarray, roughness: float) -> np.ndarray:
    """The lobe about its own normal seen along it, up to a factor, at these cosines to it; float32 stays float32."""
    alpha2 = cosine.dtype.type(max(roughness, 0.02) ** 4)
    above = np.maximum(cosine, 0.0)
    spread = cosine * (0.5 * (alpha2 - 1.0)) + 0.5 * (alpha2 + 1.0)
    return above / ((above + np.sqrt(above * above * (1.0 - alpha2) + alpha2)) * spread * spread)


def _own_lobe_lengths(roughness: Float64Array) -> Float64Array:
    """Length of the mean direction of `own_lobe`, per roughness."""
    cosine = np.cos(0.5 * np.pi * np.linspace(0.0, 1.0, 4097) ** 3)
    lobes = [own_lobe(cosine, float(rough)) for rough in roughness]
    return np.array([np.trapezoid(lobe * cosine, cosine) / np.trapezoid(lobe, cosine) for lobe in lobes])


def _sample_lobe(alpha: float, cosine: Float64Array, strata: int) -> tuple[Float64Array, Float64Array, Float64Array]:
    """Over visible normals, (cosines, strata^2): weights G2 / G1, cosines between viewer and microfacet, and (.., 3)
    the directions to the light in the frame where the viewer is at (sine, 0, cosine)."""
    steps = (np.arange(strata) + 0.5) / strata
    u1, u2 = (a.ravel()[None, :] for a in np.meshgrid(steps, steps, indexing="ij"))
    view = np.stack([np.sqrt(1.0 - cosine**2), np.zeros_like(cosine), cosine], axis=1)
    stretched = view * np.array([alpha, alpha, 1.0])
    stretched /= np.linalg.norm(stretched, axis=1, keepdims=True)
    x, z = stretched[:, 0:1], stretched[:, 2:3]
    radius, phi = np.sqrt(u1), 2.0 * np.pi * u2
    t1 = radius * np.cos(phi)  # the tangent frame of a viewer in the xz plane: y, and the cross product of both
    t2 = radius * np.sin(phi)
    s = 0.5 * (1.0 + z)
    t2 = (1.0 - s) * np.sqrt(np.maximum(1.0 - t1**2, 0.0)) + s * t2
    t3 = np.sqrt(np.maximum(1.0 - t1**2 - t2**2, 0.0))
    normal = np.stack(np.broadcast_arrays(alpha * (-z * t2 + x * t3), alpha * t1, np.maximum(x * t2 + z * t3, 1e-9)))
    normal /= np.linalg.norm(normal, axis=0)
    cos_difference = np.clip(normal[0] * view[:, 0:1] + normal[2] * view[:, 2:3], 0.0, 1.0)
    light = 2.0 * cos_difference[..., None] * np.moveaxis(normal, 0, -1) - view[:, None, :]
    light_z = light[..., 2]
    lambda_view = _smith_lambda(alpha, view[:, 2:3])
    lambda_light = _smith_lambda(alpha, np.maximum(light_z, 1e-9))
    weight = np.where(light_z > 0.0, (1.0 + lambda_view) / (1.0 + lambda_view + lambda_light), 0.0)
    return weight, cos_difference, light


def _smith_lambda(alpha: float, cosine: Float64Array) -> Float64Array:
    tangent2 = 1.0 / cosine**2 - 1.0
    return 0.5 * (np.sqrt(1.0 + alpha * alpha * tangent2) - 1.0)
