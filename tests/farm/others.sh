# The job type for Flamenco, compiled with a stand-in for what its manager offers; and the script for Deadline, with a
# stand-in for deadlinecommand that runs at once what workers would start. The stand-ins were written with the scripts,
# from the programs' documentation: nothing here shows that a manager or a repository accepts the jobs.
. "$(dirname "$0")/../tools/check.sh"

# --- Deadline ---
dof-trace() { "$bin/dof-trace" "$@"; }
mkdir path 'the views'
cat >path/deadlinecommand <<'END'
#!/usr/bin/env python3
import os, subprocess, sys
job, plugin = (dict(line.rstrip("\n").split("=", 1) for line in open(name)) for name in sys.argv[1:])
number = len(open("asked").readlines()) + 1 if os.path.exists("asked") else 1
open("asked", "a").write("%s|%s|%s\n" % (job["Frames"], job.get("JobDependencies"), job.get("IsFrameDependent")))
assert job["Plugin"] == "CommandLine" and plugin["Shell"] == "default" and plugin["SingleFramesOnly"] == "True"
for frame in range(1, 4):
    words = plugin["Arguments"].replace("<STARTFRAME>", str(frame)).replace("<QUOTE>", '"')
    subprocess.run("exec %s %s" % (plugin["Executable"], words), shell=True, check=True)
print("Submitting...\nResult=Success\nJobID=id%d" % number)
END
chmod +x path/deadlinecommand
export PATH=$PWD/path:$bin:$PATH
dof-trace fence --size 48x27 --views 2 --spp 1 -o still
for number in 0001 0002 0003; do
    for file in center view_0 view_1; do cp still/$file.exr "the views/$file.$number.exr"; done
done
ldi-warp still/center.exr still/view_0.exr still/view_1.exr -o - | dof-gather - -o expected.exr --focus-distance 3
submit=$source_dir/share/deadline/submit.sh
exits 0 "$submit" 1-3 'the views' 'the pictures' --focus-distance 3
[ "$(cat stdout)" = 'id1 id2' ] || fail "the ids: $(cat stdout)"
printf '%s\n' '1-3|None|None' '1-3|id1|true' | cmp - asked || fail "the jobs: $(cat asked)"
for number in 0001 0002 0003; do cmp "the pictures/picture.$number.exr" expected.exr || fail "frame $number"; done
fails_saying 1 'there is no such view' "$submit" 7-9 'the views' out
fails_saying 2 'Deadline takes no' "$submit" 1-3 'the views' out --lens 'a "b".json'
printf '%s\n' '#!/bin/sh' 'echo no repository >&2; exit 3' >path/deadlinecommand
exits 3 "$submit" 1-3 'the views' out
echo "Deadline: the frames' pictures, each word apart"

# --- Flamenco ---
command -v node >/dev/null || skip "Flamenco: needs node"
cat >compile.js <<'END'
const vm = require("vm"), fs = require("fs");
const asked = JSON.parse(process.argv[3]), tasks = [];
const context = {
    author: {
        Task: (name, type) => ({ name, type, commands: [], addCommand(command) { this.commands.push(command); } }),
        Command: (name, parameters) => ({ name, parameters }),
    },
    frameChunker: (frames, size) => frames.split(",").flatMap(part => {
        const [first, last] = part.trim().split("-").map(Number);
        return Array.from({ length: (last || first) - first + 1 }, (_, i) => String(first + i));
    }),
};
vm.runInNewContext(fs.readFileSync(process.argv[2], "utf8") + ";this.type = JOB_TYPE; this.compile = compileJob", context);
const settings = {};
for (const of of context.type.settings) {
    if (of.default !== undefined) settings[of.key] = of.default;
    Object.assign(settings, asked);
    if (of.required && settings[of.key] === undefined) throw new Error(of.key + " is missing");
}
context.compile({ settings, addTask: task => tasks.push(task) });
for (const task of tasks)
    for (const { name, parameters } of task.commands)
        console.log([task.name, task.type, name, parameters.exe, parameters.exeArgs, parameters.blendfile, ...parameters.args].join("|"));
END
flamenco() { exits 0 node compile.js "$source_dir/share/flamenco/sparselens.js" "$1"; }
flamenco '{"blendfile": "/my shot.blend", "frames": "1-2, 5", "options": "--samples 4 --lens \"my lens.json\""}'
for frame in 1 2 5; do
    echo "picture-$frame|blender|blender-render|{blender}|{blenderArgs}|/my shot.blend|--command|sparselens|-o|//out/####|--frames=$frame|--samples|4|--lens|my lens.json"
done | cmp - stdout || fail "the tasks: $(cat stdout)"
flamenco '{"blendfile": "/a.blend", "frames": "3", "output": "/o/#", "script": "/s p.py"}'
echo "picture-3|blender|blender-render|{blender}|{blenderArgs}|/a.blend|-P|/s p.py|--|--picture|-o|/o/#|--frames=3" |
    cmp - stdout || fail "with a script: $(cat stdout)"
echo "Flamenco: a task for each frame, each word apart"
