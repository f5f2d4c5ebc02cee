// SPDX-FileCopyrightText: 2026 Curvrefl contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// A Flamenco 3 job type: frames of a .blend file compared with Cycles by Curvrefl, chunk by chunk, and one report.
// Put it into the folder "scripts" beside flamenco-manager, and restart that. The extension Curvrefl has to be
// installed in the workers' Blender. Animations by the render engine Curvrefl need no job type: Flamenco's own will do.

const JOB_TYPE = {
    label: "Curvrefl Comparison",
    description: "Compare frames with Cycles, in chunks, and make one report of them",
    settings: [
        {
            key: "frames",
            type: "string",
            required: true,
            eval: "f'{C.scene.frame_start}-{C.scene.frame_end}'",
            evalInfo: { showLinkButton: true, description: "Scene frame range" },
            description: "Frames to compare, one after the other, such as 1-30",
        },
        {
            key: "chunk_size",
            type: "int32",
            default: 8,
            propargs: { min: 1, max: 1000 },
            description: "Frames that one task compares",
            visible: "submission",
        },
        {
            key: "reflectors",
            type: "string",
            required: true,
            eval: "','.join(o.name for o in C.scene.objects if getattr(getattr(o, 'curvrefl', None), 'is_mirror', False))",
            evalInfo: { showLinkButton: true, description: "Objects marked as mirrors" },
            description: "Names of the mirror objects, with commas between them",
        },
        {
            key: "methods",
            type: "string",
            required: true,
            default: "auto,exact,secant_star,environment_cube",
            description: "Methods to compare with Cycles, with commas between them, or all",
        },
        {
            key: "peers",
            type: "string",
            required: true,
            default: "eevee,cycles1,cycles8",
            description: "What else is compared: eevee, cycles1 to cycles64, or none",
        },
        {
            key: "resolution",
            type: "string",
            required: true,
            eval:
                "f'{C.scene.render.resolution_x * C.scene.render.resolution_percentage // 100}x" +
                "{C.scene.render.resolution_y * C.scene.render.resolution_percentage // 100}'",
            evalInfo: { showLinkButton: true, description: "Resolution of the scene" },
            description: "Width x height in pixels, such as 640x480",
        },
        {
            key: "samples",
            type: "int32",
            required: true,
            default: 256,
            propargs: { min: 1, max: 65536 },
            description: "Samples of Cycles' reference",
        },
        {
            key: "light",
            type: "string",
            required: true,
            default: "full",
            choices: ["full", "direct"],
            description: "full: as the scene renders in Cycles; direct: no indirect diffuse light",
        },
        {
            key: "output",
            type: "string",
            subtype: "dir_path",
            required: true,
            description: "Folder of the report, which all workers see",
        },
        {
            key: "blendfile",
            type: "string",
            required: true,
            description: "The .blend file",
            visible: "web",
        },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    const chunks = frameChunker(settings.frames, settings.chunk_size).map(rangeOf);
    const all = rangeOf(frameChunker(settings.frames, chunks.length * settings.chunk_size)[0]);

    const merge = author.Task("merge", "blender");
    merge.addCommand(verb(["merge", settings.output, "--frames=" + all]));
    for (const chunk of chunks) {
        const task = author.Task("compare-" + chunk, "blender");
        task.addCommand(
            verb([
                "chunk",
                settings.blendfile,
                "--frames=" + chunk,
                "--reflector=" + settings.reflectors,
                "--method=" + settings.methods,
                "--peers=" + settings.peers,
                "--resolution=" + settings.resolution,
                "--samples=" + settings.samples,
                "--light=" + settings.light,
                // (Paths stand alone: workers of other platforms have them otherwise.)
                "--output",
                settings.output,
            ]),
        );
        merge.addDependency(task);
        job.addTask(task);
    }
    job.addTask(merge);
}

// The Manager writes two frames as "1,2", and frames with gaps between them as "1-3,7".
function rangeOf(chunk) {
    const ends = chunk.split(/[,-]/).map(Number);
    const isWhole = ends.length < 3 && (!chunk.includes(",") || ends[0] + 1 === ends[1]);
    if (!isWhole) throw "Frames of a comparison follow each other without gaps, as in 1-30.";
    return ends.join("-");
}

// A command of a task: a verb of the extension, in the Blender that the farm's variable names.
function verb(args) {
    return author.Command("exec", { exe: "{blender}", args: ["--command", "curvrefl"].concat(args) });
}
