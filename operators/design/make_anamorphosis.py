# SPDX-FileCopyrightText: 2026 Curvrefl contributors
# SPDX-License-Identifier: GPL-3.0-or-later

"""A picture into what has to lie around a mirror so that the mirror shows it: image, UV map, mesh, or a print."""

# No `from __future__ import annotations` here: Blender reads the properties from evaluated annotations.

from typing import Any, Literal

import bpy
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, StringProperty

from ...curvrefl_addon.errors import InputError
from ...curvrefl_addon.options import marked_mirrors
from ..paths import ChoosesFile, output_path

type Result = set[Literal["CANCELLED", "FINISHED", "RUNNING_MODAL"]]
BEYOND = 0.5
"""Of the picture's size, past its edges: vertices there keep the picture's edge straight"""


class CURVREFL_OT_make_anamorphosis(ChoosesFile, bpy.types.Operator):
    """Choose a picture, and make what has to lie on the selected surfaces so that the mirror shows it"""

    bl_idname = "curvrefl.make_anamorphosis"
    bl_label = "Make Anamorphosis"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender's own convention)

    filepath: StringProperty(  # type: ignore[valid-type]
        name="Picture",
        description="What the mirror is to show",
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    filter_image: bpy.props.BoolProperty(default=True, options={"HIDDEN"})  # type: ignore[valid-type]
    filter_folder: bpy.props.BoolProperty(default=True, options={"HIDDEN"})  # type: ignore[valid-type]
    result: EnumProperty(  # type: ignore[valid-type]
        name="Make",
        description="What is made of the picture",
        items=(
            ("IMAGE", "Image", "An image for each surface's UV map, and a material that shows it"),
            ("UVS", "UV Map", "A UV map that puts the picture itself on each surface, whose faces are subdivided"),
            ("MESH", "Bent Mesh", "A grid with the picture, or another object, with each vertex where it must stand"),
            ("PRINT", "Print", "A PNG and an SVG of each flat surface at its true size or another"),
        ),
        default="IMAGE",
    )
    mirror: StringProperty(  # type: ignore[valid-type]
        name="Mirror", description="Names of the mirrors, with commas; those that are marked if empty"
    )
    surfaces: StringProperty(  # type: ignore[valid-type]
        name="Surfaces", description="Names of the surfaces, with commas; the selected meshes if empty"
    )
    eye: EnumProperty(  # type: ignore[valid-type]
        name="Seen by",
        description="From where the mirror shows the picture",
        items=(
            ("CAMERA", "Camera", "The scene's camera, and the scene as it renders"),
            ("VIEW", "View", "The 3D viewport as it is now"),
        ),
        default="CAMERA",
    )
    fit: EnumProperty(  # type: ignore[valid-type]
        name="Fit",
        description="How the picture's frame lies on the mirror as it is seen",
        items=(
            ("INSIDE", "Inside", "All of the picture within the box about the mirror"),
            ("COVER", "Cover", "The picture covers the box about the mirror"),
            ("STRETCH", "Stretch", "The picture is stretched to the box about the mirror"),
            ("CHOSEN", "Rectangle", "A rectangle in the view"),
        ),
        default="INSIDE",
    )
    scale: FloatProperty(  # type: ignore[valid-type]
        name="Scale", description="Of the frame that fits", default=0.7, min=0.01, max=10.0, soft_max=1.0
    )
    offset: FloatVectorProperty(  # type: ignore[valid-type]
        name="Offset", description="Of the frame's middle, in shares of the box about the mirror", size=2,
        soft_min=-0.5, soft_max=0.5,
    )  # fmt: skip
    rectangle: FloatVectorProperty(  # type: ignore[valid-type]
        name="Rectangle",
        description="Left, bottom, width and height of the frame in shares of the view",
        size=4,
        default=(0.25, 0.25, 0.5, 0.5),
    )
    uv_map: StringProperty(  # type: ignore[valid-type]
        name="UV Map", description="Of the surfaces, for an image; that which is active for rendering if empty"
    )
    size: IntProperty(  # type: ignore[valid-type]
        name="Image Size", description="Texels along a side of each image", default=2048, min=16, max=16384
    )
    material: EnumProperty(  # type: ignore[valid-type]
        name="Material",
        description="What the surface is given",
        items=(
            ("PRINCIPLED", "Paper", "Matt paper with the picture on it, lit by the scene"),
            ("EMISSION", "Emission", "It shines by itself, so that the mirror shows the picture's own colors"),
            ("NONE", "None", "The image alone is made, no material is changed"),
        ),
        default="PRINCIPLED",
    )
    paper: FloatVectorProperty(  # type: ignore[valid-type]
        name="Paper", description="Color around the picture", subtype="COLOR", size=3, min=0.0, max=1.0,
        default=(0.8, 0.8, 0.8),
    )  # fmt: skip
    cuts: IntProperty(  # type: ignore[valid-type]
        name="Cuts", description="Each edge of the surface is cut so many times before it gets a UV map", default=0,
        min=0, max=200,
    )  # fmt: skip
    source: StringProperty(  # type: ignore[valid-type]
        name="Object", description="Name of the object that is bent back; a grid with the picture if empty"
    )
    stands: EnumProperty(  # type: ignore[valid-type]
        name="Stands",
        description="Where the vertices of a bent mesh are put",
        items=(
            ("SURFACE", "On the Surfaces", "What the mirror shows there"),
            ("DEPTH", "In Depth", "As far before the mirror as the object is seen behind it"),
        ),
        default="SURFACE",
    )
    depth: FloatProperty(  # type: ignore[valid-type]
        name="Depth", description="Of a grid that stands in depth, from the mirror", subtype="DISTANCE", default=0.5,
        min=0.0,
    )  # fmt: skip
    clearance: FloatProperty(  # type: ignore[valid-type]
        name="Clearance", description="Of a mesh from the surfaces that it lies on, on the reflected rays",
        subtype="DISTANCE", default=0.002, min=0.0,
    )  # fmt: skip
    columns: IntProperty(  # type: ignore[valid-type]
        name="Columns", description="Faces of a grid along the picture's longer side", default=64, min=1, max=2048
    )
    folder: StringProperty(  # type: ignore[valid-type]
        name="Folder",
        description="Where prints go",
        subtype="DIR_PATH",
        default="//anamorphosis",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )
    dpi: FloatProperty(  # type: ignore[valid-type]
        name="DPI", description="Dots per inch of a print", default=300.0, min=10.0, max=2400.0
    )
    print_width: FloatProperty(  # type: ignore[valid-type]
        name="Print Width", description="Millimeters of the sheet; 0: as large as in the scene", default=0.0, min=0.0
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.scene is None or context.mode != "OBJECT":
            cls.poll_message_set("Only in Object Mode")
            return False
        return True

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> Any:
        # (What is selected now is meant, also where the properties are those of the last time.)
        self.mirror = self.surfaces = ""
        return super().invoke(context, event)

    def draw(self, _context: bpy.types.Context) -> None:
        layout: Any = self.layout
        layout.use_property_split = True
        shown = ["result", "mirror", "surfaces", "eye", "fit"]
        shown += ["rectangle"] if self.fit == "CHOSEN" else ["scale", "offset"]
        shown += {
            "IMAGE": ["uv_map", "size", "material"],
            "UVS": ["cuts", "material"],
            "MESH": ["source", "stands"],
            "PRINT": ["folder", "dpi", "print_width"],
        }[self.result]
        if self.result == "MESH":
            shown += ["clearance"] if self.stands == "SURFACE" else [] if self.source else ["depth"]
            shown += [] if self.source else ["columns", "material"]
        if self.result != "PRINT" and self.material != "NONE" and "material" in shown:
            shown.append("paper")
        for name in shown:
            layout.prop(self, name)

    def execute(self, context: bpy.types.Context) -> Result:  # type: ignore[override]
        from ...curvrefl_addon.renderer.device.context import GpuUnavailableError

        make = {"IMAGE": self._images, "UVS": self._uvs, "MESH": self._mesh, "PRINT": self._prints}[self.result]
        context.window.cursor_set("WAIT") if context.window is not None else None
        try:
            sentences = make(context)
        except (InputError, GpuUnavailableError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            context.window.cursor_set("DEFAULT") if context.window is not None else None
        for sentence in sentences[1:]:
            self.report({"WARNING"}, sentence)
        self.report({"INFO"}, sentences[0])
        return {"FINISHED"}

    def _images(self, context: bpy.types.Context) -> list[str]:
        from ...curvrefl_addon.design.anamorphosis.applied import put_images

        like, making = self._begin(context, uv_map=self.uv_map)
        shading = None if self.material == "NONE" else self.material
        return put_images(making, like, self.size, self.uv_map, shading, tuple(self.paper))

    def _uvs(self, context: bpy.types.Context) -> list[str]:
        from ...curvrefl_addon.design.anamorphosis.applied import put_uvs

        image, making = self._begin(context, beyond=BEYOND)
        shading: Any = "PRINCIPLED" if self.material == "NONE" else self.material
        return put_uvs(making, image, self.cuts, shading, tuple(self.paper))

    def _mesh(self, context: bpy.types.Context) -> list[str]:
        from ...curvrefl_addon.design.anamorphosis.applied import Bending, add_bent

        image, making = self._begin(context, needs_surfaces=self.stands == "SURFACE")
        shading = None if self.material == "NONE" else self.material
        bending = Bending(self.source, self.stands == "DEPTH", self.depth, self.clearance, self.columns)
        assert context.scene is not None
        depsgraph = context.evaluated_depsgraph_get()
        return add_bent(making, image, bending, shading, tuple(self.paper), context.scene, depsgraph)

    def _prints(self, context: bpy.types.Context) -> list[str]:
        from ...curvrefl_addon.design.anamorphosis.prints import write_prints
        from ...curvrefl_addon.design.anamorphosis.sheet import Paper
        from ...curvrefl_addon.output import checked_folder

        folder = checked_folder(output_path(self.folder, "a folder for the prints"))
        _, making = self._begin(context)
        scene = context.scene
        assert scene is not None
        paper = Paper(self.dpi, self.print_width, scene.unit_settings.scale_length)
        return [*write_prints(making, paper, folder), *making.stage.warnings]

    def _begin(
        self, context: bpy.types.Context, uv_map: str | None = None, beyond: float = 0.0, needs_surfaces: bool = True
    ) -> tuple[bpy.types.Image, Any]:
        from ...curvrefl_addon.design.anamorphosis.making import begin
        from ...curvrefl_addon.design.anamorphosis.picture_frame import FrameChoice
        from ...curvrefl_addon.design.anamorphosis.results import read_picture
        from ...curvrefl_addon.design.stage import read_stage, read_viewed_stage
        from ...curvrefl_addon.scene.camera.film import rendered_size

        scene, view_layer = context.scene, context.view_layer
        assert scene is not None and view_layer is not None
        mirrors = _names(self.mirror) or [item.name for item in marked_mirrors(scene)]
        surfaces = _names(self.surfaces) or [
            item.name for item in context.selected_objects if item.type == "MESH" and item.name not in mirrors
        ]
        surfaces = [name for name in surfaces if name != self.source]
        if needs_surfaces and not surfaces:
            raise InputError("No surface is chosen for the picture: select a mesh beside the mirror.")
        like, picture = read_picture(output_path(self.filepath, "a picture"))
        if self.eye == "VIEW":
            depsgraph = context.evaluated_depsgraph_get()
            stage = read_viewed_stage(depsgraph, scene, mirrors, surfaces, _view_of(context), uv_map)
        else:
            stage = read_stage(scene, view_layer, mirrors, surfaces, None, rendered_size(scene.render), uv_map)
        choice = FrameChoice(self.fit, self.scale, tuple(self.offset), tuple(self.rectangle))
        return like, begin(stage, picture, choice, beyond=beyond)


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


def _view_of(context: bpy.types.Context) -> Any:
    from ...curvrefl_addon.viewport.region import view_of_area

    area = context.area
    if area is None or area.type != "VIEW_3D":
        raise InputError("There is no 3D viewport here: start it in one, or let the camera see the picture.")
    return view_of_area(context, area)


CLASSES = (CURVREFL_OT_make_anamorphosis,)
