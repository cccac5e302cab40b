// SPDX-License-Identifier: GPL-3.0-or-later
// Job type of Flamenco (3.5 and later): frames x light rigs of a scene whose skins glow. Put this file into the folder
// `scripts` beside flamenco-manager; Blender lists it after Render Properties > Flamenco > Refresh.

const JOB_TYPE = {
    label: "Skinglow Batch",
    description: "Frames x light rigs of a scene whose skins glow, with a manifest; complete pictures are kept",
    settings: [
        { key: "frames", type: "string", required: true, eval: "f'{C.scene.frame_start}-{C.scene.frame_end}'",
          evalInfo: { showLinkButton: true, description: "Scene frame range" },
          description: "Frame range, such as 1-10,15" },
        { key: "chunk_size", type: "int32", default: 10, propargs: { min: 1 }, visible: "submission",
          description: "Frames of one task; each task starts Blender once" },
        { key: "rigs", type: "string", default: "",
          description: "Light rigs, separated by spaces: lights, collections, NAME=LIGHT,LIGHT or rig files. " +
                       "Empty: the lights of the scene" },
        { key: "folder", type: "string", subtype: "dir_path", required: true,
          description: "Folder of the pictures and the manifest, on the shared storage" },
        { key: "light", type: "string", choices: ["live", "frozen"], default: "live",
          description: "live: each worker needs Skinglow. frozen: workers need Blender alone; freeze the light first" },
        { key: "blendfile", type: "string", required: true, visible: "web", description: "The scene's file" },
        { key: "scene", type: "string", eval: "C.scene.name", visible: "web", description: "Scene in the file" },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    const rigs = shellSplit(settings.rigs || "");
    const isFrozen = settings.light === "frozen";
    if (isFrozen && rigs.length) {
        throw "Frozen skins do not follow light rigs: leave the rigs empty, or choose live";
    }
    for (const chunk of frameChunker(settings.frames, settings.chunk_size)) {
        const task = author.Task(`pictures-${chunk}`, "blender");
        const args = isFrozen ? frozenArguments(settings, chunk) : liveArguments(settings, rigs, chunk);
        // Steps are pictures: the worker counts lines that Blender or Skinglow print for each.
        const pictures = frameCount(chunk) * Math.max(rigs.length, 1);
        task.addCommand(author.Command("blender-render", {
            exe: "{blender}", exeArgs: "{blenderArgs}", argsBefore: [], blendfile: settings.blendfile, args: args,
        }, pictures));
        job.addTask(task);
    }
}

function liveArguments(settings, rigs, chunk) {
    const start = "import skinglow_blender as sb; sb.batch_main()";
    let args = ["--python-exit-code", "2", "--python-expr", start, "--", "--progress", "flamenco"];
    // With =, as names may begin with a dash.
    args = args.concat([`--frames=${chunk}`, `--out=${settings.folder}`]);
    if (settings.scene) args.push(`--scene=${settings.scene}`);
    return rigs.length ? args.concat(["--rigs"], rigs) : args;
}

// Pictures get the names that they have in a batch.
function frozenArguments(settings, chunk) {
    const scene = settings.scene ? ["--scene", settings.scene] : [];
    const output = path.join(settings.folder, "scene", "####");
    return scene.concat(["--render-output", output, "--render-frame", chunk.replace(/-/g, "..")]);
}
