// A job type for Flamenco 3.3 and later: one task for each frame of a .blend file renders its views and makes its
// picture. Put the file into the folder scripts/ beside flamenco-manager, and start the manager again. docs/farm.md says
// more.
const JOB_TYPE = {
    label: "Sparselens",
    description: "Pictures with depth of field from a few views of the camera",
    settings: [
        { key: "frames", type: "string", required: true, eval: "f'{C.scene.frame_start}-{C.scene.frame_end}'",
          description: "Frames, e.g. 1-24 or 1, 3, 5-9" },
        { key: "output", type: "string", subtype: "file_path", required: true, default: "//out/####",
          description: "Name of the pictures, with a # for the frame; // is the folder of the .blend file" },
        { key: "options", type: "string", default: "",
          description: "Further options, e.g. --samples 64 --finish 80; a name with blanks is quoted" },
        { key: "script", type: "string", subtype: "file_path", default: "",
          description: "Path of sparselens_views.py on the workers; without it, they must have the add-on" },
        { key: "blendfile", type: "string", required: true, visible: "web", description: "Path of the .blend file" },
    ],
};

// The words of a text, as in a shell: quotes, single or double, hold blanks together.
function wordsOf(text) {
    const words = text.match(/(?:"[^"]*"|'[^']*'|[^\s"'])+/g) || [];
    return words.map(word => word.replace(/"([^"]*)"|'([^']*)'/g, (all, a, b) => a === undefined ? b : a));
}

function compileJob(job) {
    const settings = job.settings;
    const command = settings.script ? ["-P", settings.script, "--", "--picture"] : ["--command", "sparselens"];
    for (const frame of frameChunker(settings.frames, 1)) {
        const task = author.Task(`picture-${frame}`, "blender");
        task.addCommand(author.Command("blender-render", {
            exe: "{blender}",
            exeArgs: "{blenderArgs}",
            argsBefore: [],
            blendfile: settings.blendfile,
            args: command.concat(["-o", settings.output, `--frames=${frame}`], wordsOf(settings.options)),
        }));
        job.addTask(task);
    }
}
