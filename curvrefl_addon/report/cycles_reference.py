# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""Stills of the open scene by Blender's own engines: Cycles as the truth, and the peers that we are measured against.

Everything that is changed for a still is set back after it. All stills are scene-linear float32 arrays
(height, width, 4), row 0 at the BOTTOM, of the scene's camera at its current frame, without denoising,
compositing, sequencer, stereo or crop. Film exposure is 1: pictures get theirs as they are shown.

The geometry is the file's, as F12 renders it.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import bpy

from ..errors import InputError
from ..output import temporary_folder
from ..scene.arrays import Float32Array
from ..scene.opened.render_depsgraph import use_camera
from ..scene.opened.temporary_settings import TemporarySettings, temporary_settings
from ..written_files import require_whole
from .images import load_exr
from .repeats import Timing, repeated

LIGHTS = ("direct", "full")
PEERS = ("eevee", *(f"cycles{2**power}" for power in range(7)))
EEVEE_SAMPLES = 16
MOST_SEEDS = 2**31


class RenderCanceledError(RuntimeError):
    """The user stopped a render."""


@dataclass(frozen=True, slots=True)
class Still:
    """One rendered picture."""

    pixels: Float32Array
    """(height, width, 4) scene-linear"""
    seconds: float
    """Of the render call that made it, scene synchronization included"""


@dataclass(frozen=True, slots=True)
class PeerStill(Still):
    """A picture that was rendered for its time."""

    timing: Timing
    """Of all repeats, milliseconds; `seconds` is their median"""


def render_reference(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    width: int,
    height: int,
    samples: int,
    light: str = "direct",
    bounces: int = 1,
    sharp: bool = False,
) -> Still:
    """The scene in Cycles on the CPU.

    `light` 'direct': surfaces are lit by lamps, emitters and the world only, and mirrors show them lit that way, up to
    `bounces` mirrors one after the other and through as much glass as the file allows; Blender's default pixel
    filter. 'full': the bounces, clamps and pixel filter that the user has set. `sharp` leaves out depth of field and
    motion blur.
    """
    with temporary_settings() as changes:
        use_still_output(changes, scene, width, height)
        if sharp:
            use_pinhole(changes, scene)
        use_cycles(changes, scene, view_layer, samples, light, bounces)
        return render_still(scene, view_layer)


def render_peer(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    peer: str,
    width: int,
    height: int,
    light: str = "direct",
    repeats: int = 1,
    seconds: float = 0.0,
    bounces: int = 1,
    sharp: bool = False,
    is_animated: bool = False,
) -> PeerStill:
    """The scene in one of `PEERS`, lit and sharp as the reference.

    A first render compiles and loads; then come up to `repeats` timed ones, as long as `seconds` have not passed.

    'eevee' has ray tracing on and 16 samples; with `light` 'direct' its fast global illumination only occludes.
    Cycles has another seed than the reference: with the same its samples would be among those of the reference; if
    `is_animated`, another one in each frame.
    """
    with temporary_settings() as changes:
        use_still_output(changes, scene, width, height)
        if sharp:
            use_pinhole(changes, scene)
        # One sample compiles and loads as much as all do, and each can take a second on a software renderer.
        if peer == "eevee":
            _use_eevee(changes, scene, light)
            changes.set(scene.eevee, taa_render_samples=1)
            render_still(scene, view_layer)
            changes.set(scene.eevee, taa_render_samples=EEVEE_SAMPLES)
        elif peer in PEERS:
            use_cycles(changes, scene, view_layer, 1, light, bounces)
            cycles = cycles_settings(scene)
            changes.set(cycles, seed=(cycles.seed + 1) % MOST_SEEDS)
            changes.set(cycles, use_animated_seed=is_animated or cycles.use_animated_seed)
            render_still(scene, view_layer)
            changes.set(cycles, samples=int(peer.removeprefix("cycles")))
        else:
            raise InputError(f"Unknown peer '{peer}': choose from {', '.join(PEERS)}, or none.")
        stills = repeated(lambda: render_still(scene, view_layer), repeats, seconds)
    timing = Timing(tuple(1e3 * still.seconds for still in stills))
    return PeerStill(stills[-1].pixels, 1e-3 * timing.median, timing)


def use_still_output(changes: TemporarySettings, scene: bpy.types.Scene, width: int, height: int) -> None:
    """One whole plain picture of `scene` into a 32-bit EXR file."""
    render = scene.render
    changes.set(
        render,
        resolution_x=width,
        resolution_y=height,
        resolution_percentage=100,
        use_border=False,
        use_crop_to_border=False,
        use_multiview=False,
        use_compositing=False,
        use_sequencer=False,
        use_stamp=False,
        use_freestyle=False,
        use_file_extension=True,
        use_overwrite=True,
        use_placeholder=False,
        save_output=True,
        filepath=render.filepath,
    )
    changes.set(
        render.image_settings,
        media_type="IMAGE",
        file_format="OPEN_EXR",
        color_management="FOLLOW_SCENE",
        color_mode="RGBA",
        color_depth="32",
        exr_codec="NONE",
    )
    use_camera(changes, scene, scene.camera)


def use_pinhole(changes: TemporarySettings, scene: bpy.types.Scene) -> None:
    """The moment of the frame through a point, on an opaque film."""
    changes.set(scene.render, use_motion_blur=False, film_transparent=False)
    camera = scene.camera.data if scene.camera is not None else None
    if isinstance(camera, bpy.types.Camera):
        changes.set(camera.dof, use_dof=False)


def use_cycles(
    changes: TemporarySettings,
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    samples: int,
    light: str,
    bounces: int = 1,
) -> None:
    """Cycles on the CPU with exactly `samples` samples in every pixel. See `render_reference` for the light."""
    cycles = cycles_settings(scene)
    changes.set(scene.render, engine="CYCLES")
    changes.set(
        cycles,
        device="CPU",
        samples=samples,
        use_adaptive_sampling=False,
        time_limit=0.0,
        use_denoising=False,
        film_exposure=1.0,
    )
    changes.set(view_layer, samples=0, use_pass_combined=True)
    if light == "direct":
        # From mirror to mirror; what the last one shows is lit, then the path ends. Cycles still follows that bounce
        # to lamps, emitters and the world (the other half of its direct light), but shades nothing there.
        through_glass = min(cycles.max_bounces, cycles.transmission_bounces)
        changes.set(
            cycles,
            max_bounces=bounces + through_glass,
            diffuse_bounces=0,
            glossy_bounces=bounces,
            transmission_bounces=through_glass,
            volume_bounces=0,
            sample_clamp_direct=0.0,
            sample_clamp_indirect=0.0,
            blur_glossy=0.0,
            light_sampling_threshold=0.0,
            use_fast_gi=False,
            use_guiding=False,
            # Blender's default, which the renderer's anti-aliasing follows.
            pixel_filter_type="BLACKMAN_HARRIS",
            filter_width=1.5,
        )


def cycles_settings(scene: bpy.types.Scene) -> Any:
    """`scene.cycles`. Raises InputError when Cycles, an add-on, is not enabled."""
    settings = getattr(scene, "cycles", None)
    if settings is None:
        raise InputError("Cycles is not available: enable the add-on 'Cycles Render Engine' in the preferences.")
    return settings


def _use_eevee(changes: TemporarySettings, scene: bpy.types.Scene, light: str) -> None:
    changes.set(scene.render, engine="BLENDER_EEVEE")
    changes.set(scene.eevee, use_raytracing=True)
    if light == "direct":
        changes.set(scene.render, filter_size=1.5)
        changes.set(scene.eevee, fast_gi_method="AMBIENT_OCCLUSION_ONLY")


def render_still(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> Still:
    """Render with the settings as they are (see `use_still_output`), through a file in a temporary folder."""
    filepath = scene.render.filepath
    with temporary_folder() as folder:
        path = folder / "still.exr"
        scene.render.filepath = str(path)
        try:
            start = time.perf_counter()
            result = bpy.ops.render.render(write_still=True, scene=scene.name, layer=view_layer.name)
            seconds = time.perf_counter() - start
        finally:
            scene.render.filepath = filepath
        if "CANCELLED" in result:
            raise RenderCanceledError(f"{scene.render.engine} was stopped at the picture of scene '{scene.name}'")
        if "FINISHED" not in result:
            raise RuntimeError(f"{scene.render.engine} did not finish the picture of scene '{scene.name}'")
        # On a full disk, too, the render has finished.
        require_whole(path)
        return Still(load_exr(path), seconds)
