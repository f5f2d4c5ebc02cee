# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene with all features of paths, and programs that fill all buffers, renders on both graphics backends, and to
the same picture."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from window import SECONDS, home
from window_blender import WindowBlender

BACKENDS = ("opengl", "vulkan")
MARKED = (
    "import bpy; bpy.context.scene.curvrefl.render_samples = 16; "
    "bpy.data.objects['Mirror Ball'].curvrefl.is_mirror = True"
)


def all_that_paths_do(ball: Any) -> None:
    """A brushed ball under a coat with a film, absorbing glass, a leaf with soft alpha and roughness by an image, and
    rust by noise: bumps, light, coat."""
    import bpy

    def material(name: str, **inputs: float) -> Any:
        made = bpy.data.materials.new(name)
        shader: Any = made.node_tree.nodes["Principled BSDF"]
        for socket, value in inputs.items():
            shader.inputs[socket.replace("_", " ")].default_value = value
        return made

    metal = {"Metallic": 1.0, "Roughness": 0.3, "Anisotropic": 0.5, "Coat_Weight": 0.5, "Thin_Film_Thickness": 400.0}
    ball.data.materials[0] = material("brushed", **metal)
    glass = material("glass", Transmission_Weight=1.0, Roughness=0.1, IOR=1.4)
    absorb = glass.node_tree.nodes.new("ShaderNodeVolumeAbsorption")
    output: Any = next(node for node in glass.node_tree.nodes if node.type == "OUTPUT_MATERIAL")
    glass.node_tree.links.new(absorb.outputs[0], output.inputs["Volume"])
    bpy.data.objects["Block"].data.materials.append(glass)
    leaf = material("leaf")
    image = bpy.data.images.new("alpha", 4, 4, alpha=True)
    image.pixels.foreach_set(np.tile(np.linspace(0.0, 1.0, 16, dtype=np.float32)[:, None], (1, 4)).ravel())
    image.pack()
    texture: Any = leaf.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    for socket in ("Alpha", "Roughness"):
        leaf.node_tree.links.new(texture.outputs["Color"], leaf.node_tree.nodes["Principled BSDF"].inputs[socket])
    bpy.ops.mesh.primitive_plane_add(size=1.5, location=(-1.6, -1.5, 0.0), rotation=(1.4, 0.0, 0.3))
    plane: Any = bpy.context.object
    plane.data.materials.append(leaf)
    rust = material("rust", Coat_Weight=0.5)
    tree: Any = rust.node_tree
    noise, bump, place = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexNoise", "Bump", "ObjectInfo"))
    shader: Any = tree.nodes["Principled BSDF"]
    noise.inputs["Scale"].default_value = 3.0
    for socket in ("Base Color", "Emission Color"):
        tree.links.new(noise.outputs["Color"], shader.inputs[socket])
    shader.inputs["Emission Strength"].default_value = 0.3
    for socket in ("Coat Weight", "Roughness", "Metallic"):
        tree.links.new(noise.outputs[0], shader.inputs[socket])
    tree.links.new(noise.outputs[0], bump.inputs["Height"])
    tree.links.new(bump.outputs["Normal"], shader.inputs["Normal"])
    tree.links.new(place.outputs["Random"], shader.inputs["Sheen Weight"])
    bpy.ops.mesh.primitive_cube_add(size=0.8, location=(1.5, -1.6, -0.5), rotation=(0.2, 0.3, 0.4))
    cube: Any = bpy.context.object
    cube.data.materials.append(rust)
    bpy.ops.object.light_add(type="AREA", location=(2.0, -3.0, 4.0))
    lamp: Any = bpy.context.object
    lamp.data.energy = 300.0


@pytest.fixture(scope="module")
def pictures(
    tmp_path_factory: pytest.TempPathFactory, window_blender: WindowBlender, archive: Path
) -> dict[str, np.ndarray]:
    """(h, w, 3) by backend."""
    from rendered import channels
    from small_scene import saved

    file, installed = saved(tmp_path_factory.mktemp("scene"), all_that_paths_do), tmp_path_factory.mktemp("installed")
    folder = tmp_path_factory.mktemp("paths")
    commands: list[tuple[str, ...]] = [
        ("--command", "extension", "install-file", "-r", "user_default", "--enable", str(archive))
    ]
    for name in BACKENDS:
        opened = ("--background", "--gpu-backend", name, str(file), "-E", "CURVREFL", "--python-expr", MARKED)
        commands.append((*opened, "-F", "OPEN_EXR", "-o", f"{folder}/{name}_", "-f", "1"))
    for arguments in commands:
        command = [*window_blender.headless, *arguments]
        result = subprocess.run(command, env=home(installed), capture_output=True, text=True, timeout=SECONDS)
        said = result.stdout + result.stderr
        assert result.returncode == 0 and "Traceback" not in said, said[-3000:]
    found = {}
    for name in BACKENDS:
        parts = channels(folder / f"{name}_0001.exr")
        found[name] = np.stack([parts[channel] for channel in "RGB"], axis=-1)
    return found


def test_all_features_of_paths_are_drawn_alike(pictures: dict[str, np.ndarray]) -> None:
    first, second = (pictures[name] for name in BACKENDS)
    assert np.isfinite(first).all() and np.isfinite(second).all()
    assert first.std() > 0.05
    # (Rounding may send single paths another way.)
    assert np.mean(np.abs(first - second) > 0.02) < 0.02
    assert abs(first.mean() - second.mean()) < 2e-3 * first.mean()
