# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How the file shows its pictures: view transforms, looks, exposure, film."""

from __future__ import annotations

from pathlib import Path

from ..registry import awkward
from ..stage import add_box, bpy, emitter, stage


def _shown(transform: str, look: str = "None", exposure: float = 0.0, gamma: float = 1.0) -> bpy.types.Scene:
    scene = stage()
    # (What it lights is another matter.)
    add_box("Glow", (-2.2, 1.5, 2.2), 1.4, emitter("Glow", (4.0, 0.9, 0.05))).visible_diffuse = False
    view = scene.view_settings
    view.view_transform = transform
    view.look = look
    view.exposure, view.gamma = exposure, gamma
    return scene


@awkward("Blender's default view transform")
def view_agx(folder: Path) -> None:
    _shown("AgX")


@awkward("AgX with a look")
def view_agx_punchy(folder: Path) -> None:
    _shown("AgX", "AgX - Punchy")


@awkward("AgX with very low contrast")
def view_agx_low_contrast(folder: Path) -> None:
    _shown("AgX", "AgX - Very Low Contrast")


@awkward("the view transform of Blender 2.8 to 3.6")
def view_filmic(folder: Path) -> None:
    _shown("Filmic")


@awkward("Filmic with a look")
def view_filmic_contrast(folder: Path) -> None:
    _shown("Filmic", "Very High Contrast")


@awkward("no view transform at all")
def view_raw(folder: Path) -> None:
    _shown("Raw")


@awkward("Khronos' neutral view transform")
def view_khronos(folder: Path) -> None:
    _shown("Khronos PBR Neutral")


@awkward("logarithmic view")
def view_log(folder: Path) -> None:
    _shown("Filmic Log")


@awkward("two stops up in the view")
def view_exposure(folder: Path) -> None:
    _shown("Standard", exposure=2.0)


@awkward("gamma of the view")
def view_gamma(folder: Path) -> None:
    _shown("Standard", gamma=1.8)


@awkward("curves of the view")
def view_curves(folder: Path) -> None:
    view = _shown("Standard").view_settings
    view.use_curve_mapping = True
    curve = view.curve_mapping.curves[3]
    curve.points[0].location = (0.0, 0.4)
    curve.points[1].location = (1.0, 0.7)
    view.curve_mapping.update()


@awkward("white balance of the view")
def view_white_balance(folder: Path) -> None:
    view = _shown("Standard").view_settings
    view.use_white_balance = True
    view.white_balance_temperature = 3200.0


@awkward("a display other than sRGB")
def display_p3(folder: Path) -> None:
    scene = stage()
    scene.display_settings.display_device = "Display P3"


@awkward("the film's own exposure")
def film_exposure(folder: Path) -> None:
    stage().cycles.film_exposure = 2.5


@awkward("transparent film: alpha where the world would be")
def film_transparent(folder: Path) -> None:
    stage().render.film_transparent = True


@awkward("transparent film and a glow in front of nothing")
def film_transparent_emitter(folder: Path) -> None:
    scene = stage()
    scene.render.film_transparent = True
    add_box("Glow", (-2.2, 1.5, 2.8), 0.7, emitter("Glow", (0.2, 0.5, 0.9))).visible_diffuse = False


@awkward("a sequencer color space and a compositor that is off", words=("compositor",))
def compositor_inverts(folder: Path) -> None:
    scene = stage()
    tree = bpy.data.node_groups.new("Compositing", "CompositorNodeTree")
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    layers = tree.nodes.new("CompositorNodeRLayers")
    invert = tree.nodes.new("CompositorNodeInvert")
    output = tree.nodes.new("NodeGroupOutput")
    tree.links.new(layers.outputs["Image"], invert.inputs["Color"])
    tree.links.new(invert.outputs["Color"], output.inputs[0])
    scene.compositing_node_group = tree
    scene.render.use_compositing = True


@awkward("a working space of wide colors")
def working_space_rec2020(folder: Path) -> None:
    stage()
    bpy.ops.wm.set_working_color_space(working_space="Linear Rec.2020", convert_colors=True)


@awkward("a working space of wide colors, into which nothing was converted")
def working_space_acescg(folder: Path) -> None:
    stage()
    bpy.ops.wm.set_working_color_space(working_space="ACEScg", convert_colors=False)


@awkward("half the resolution by percentage")
def resolution_percentage(folder: Path) -> None:
    render = stage().render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 320, 240, 50


@awkward("pixels that are not square")
def pixel_aspect(folder: Path) -> None:
    render = stage().render
    render.pixel_aspect_x, render.pixel_aspect_y = 2.0, 1.0


@awkward("a border, black around it", words=("border",))
def border(folder: Path) -> None:
    render = stage().render
    render.use_border, render.use_crop_to_border = True, False
    render.border_min_x, render.border_max_x = 0.2, 0.7
    render.border_min_y, render.border_max_y = 0.3, 0.9


@awkward("a border, cropped to it", words=("border",))
def border_cropped(folder: Path) -> None:
    border(folder)
    bpy.context.scene.render.use_crop_to_border = True


@awkward("a wide pixel filter", words=("pixel filter",))
def pixel_filter(folder: Path) -> None:
    cycles = stage().cycles
    cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", 6.0


@awkward("a picture of one pixel's height")
def one_row(folder: Path) -> None:
    render = stage().render
    render.resolution_x, render.resolution_y = 160, 4


@awkward("the material of a view layer in place of all others")
def view_layer_material(folder: Path) -> None:
    from ..stage import matte

    stage()
    bpy.context.view_layer.material_override = matte("Clay", (0.12, 0.09, 0.06))


@awkward("the world of a view layer in place of the scene's")
def view_layer_world(folder: Path) -> None:
    stage()
    world = bpy.data.worlds.new("Other")
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.9, 0.3, 0.1, 1.0)
    bpy.context.view_layer.world_override = world


@awkward("a view layer that leaves out the sky")
def view_layer_no_sky(folder: Path) -> None:
    stage()
    bpy.context.view_layer.use_sky = False


@awkward("a view layer that leaves out solid things", words=("solid",))
def view_layer_no_solid(folder: Path) -> None:
    stage()
    bpy.context.view_layer.use_solid = False


@awkward("a collection that a view layer leaves out")
def view_layer_excludes(folder: Path) -> None:
    scene = stage()
    collection = bpy.data.collections.new("Left out")
    scene.collection.children.link(collection)
    thing = bpy.data.objects["Red"]
    scene.collection.objects.unlink(thing)
    collection.objects.link(thing)
    bpy.context.view_layer.layer_collection.children["Left out"].exclude = True


@awkward("two view layers, of which F12 lays one over the other", words=("view layer",))
def two_view_layers(folder: Path) -> None:
    scene = stage()
    collection = bpy.data.collections.new("Front")
    scene.collection.children.link(collection)
    for name in ("Red", "Green"):
        thing = bpy.data.objects[name]
        scene.collection.objects.unlink(thing)
        collection.objects.link(thing)
    second = scene.view_layers.new("Second")
    second.layer_collection.children["Front"].exclude = True
