#!/bin/bash
# The node of share/nuke, with a stand-in for the module nuke that has only what the node calls: the buttons give the
# pictures of dof-gather, errors are shown, and cancelling ends the tool. This shows that the node does what is intended,
# not that Nuke accepts it.
. "$(dirname "$0")/check.sh"
command -v python3 >/dev/null || skip "needs python3"
export PYTHONPATH=$scratch:$source_dir/share/nuke PYTHONDONTWRITEBYTECODE=1

picture make flat.exr 32x24 R=noise:1 G=noise:2 B=noise:3 A=1 Z=2 fill=9x24+0+0 Z=6
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.2 --focus-distance 6)
for frame in 1 2 3; do exits 0 "$bin/ldi-warp" flat.exr "${lens[@]}" -o shot.000$frame.ldi.exr; done

cat >nuke.py <<'END'
import re, threading
messages, menus, progress = [], [], []
cancelled = threading.Event()

class Knob:
    def __init__(self, value): self.held, self.keys, self.executed = value, None, 0
    def value(self): return self.held
    def isAnimated(self): return self.keys is not None
    def valueAt(self, frame): return self.keys[frame]
    def execute(self): self.executed += 1

class Node:
    def __init__(self, name, knobs): self.called, self.knobs = name, knobs
    def name(self): return self.called
    def __getitem__(self, name): return self.knobs[name]
    def node(self, name): return self.inside[name]

class ProgressTask:
    def __init__(self, title): pass
    def setProgress(self, percent): progress.append(percent)
    def isCancelled(self): return cancelled.is_set()

def createNode(kind):
    """A node with the knobs of the gizmo's text, at their defaults."""
    text = open(kind, encoding="utf-8").read()
    knobs = {}
    for number, name, rest in re.findall(r"^ addUserKnob \{(\d+) (\w+) ?(.*)\}$", text, re.M):
        default = re.search(rf"^ {name} (\S+)$", text, re.M)
        kinds = {"1": str, "2": str, "4": str, "3": int, "6": lambda v: bool(int(v)), "7": float}
        if number in kinds: knobs[name] = Knob(kinds[number](default[1] if default else "" if number in "124" else 0))
        if number == "22": knobs[name] = Knob(re.search(r'T "(.*?)"', rest)[1])
    node = Node("Gather1", knobs)
    node.inside = {name: Node(name, {"reload": Knob("")}) for name in re.findall(r"^  name (\w+)$", text, re.M)}
    return node

class Menu:
    def addMenu(self, name): return self
    def addCommand(self, name, command): menus.append((name, command))

def toolbar(name): return Menu()
def frame(): return 2
def message(text): messages.append(text)
def executeInMainThread(call, args=()): call(*args)
END
cat >press.py <<'END'
import os, sys, threading
import nuke, sparselens_nuke
gizmo = os.path.join(sys.argv[1], "share/nuke/SparselensGather.gizmo")
import runpy
runpy.run_path(os.path.join(sys.argv[1], "share/nuke/menu.py"))
assert nuke.menus == [("Gather", "nuke.createNode('SparselensGather')")], nuke.menus

def press(node, button):
    nuke.thisNode = lambda: node
    result = {}
    exec(node[button].value().replace("; sparselens_nuke", "; result['is'] = sparselens_nuke"), {"nuke": nuke, "result": result})
    if isinstance(result["is"], threading.Thread): result["is"].join(60)
    return result["is"]

node = nuke.createNode(gizmo)
press(node, "gather")
assert nuke.messages.pop() == "Gather1: ldi is empty"
for name, value in dict(ldi="shot.####.ldi.exr", output="as-rendered.####.exr", last=3, tools=sys.argv[2]).items(): node[name].held = value
press(node, "gather")
assert not nuke.messages and nuke.progress[-1] == 100 and node.node("picture")["reload"].executed == 1, (nuke.messages, nuke.progress)
# Every knob of the lens; the focus is animated.
node["output"].held = "pull.####.exr"
node["own_focus"].held = node["own_fstop"].held = True
node["focus_distance"].keys = {1: 2.0, 2: 3.5, 3: 6.0}
node["fstop"].held = 0.2
for name, value in dict(blades=5, blade_rotation=10.0, squeeze=1.5, cat_eye=0.5, spherical=0.3, quality="draft").items(): node[name].held = value
node["options"].held = "--channels 'R,G,B,A' -d float"
press(node, "gather")
assert not nuke.messages, nuke.messages
assert sparselens_nuke.view_command(node)[1:5] == ["shot.0002.ldi.exr", "--open", "--focus-distance", "3.5"], sparselens_nuke.view_command(node)
node["ldi"].held = "shot.%04d.ldi.exr"
assert sparselens_nuke.view_command(node)[1] == "shot.0002.ldi.exr"
# The tool's own words are shown.
node["ldi"].held = "missing.####.exr"
press(node, "gather")
assert "missing.0001.exr" in nuke.messages.pop() and node.node("picture")["reload"].executed == 2
node["last"].held = 0
press(node, "gather")
assert nuke.messages.pop() == "Gather1: the last frame is before the first"
node["last"].held, node["tools"].held = 3, "/nowhere"
press(node, "gather")
assert nuke.messages.pop().startswith("/nowhere/dof-gather: "), nuke.messages
press(node, "view")
assert "/nowhere/dof-view" in nuke.messages.pop()
# Cancelling ends a tool that says nothing.
nuke.cancelled.set()
sparselens_nuke.run(["sleep", "60"], "", lambda: nuke.messages.append("done"))
assert not nuke.messages
END
exits 0 python3 press.py "$source_dir" "$bin"
exits 0 "$bin/dof-gather" shot.####.ldi.exr -o expected.####.exr --frames 1-3
for frame in 1 2 3; do cmp as-rendered.000$frame.exr expected.000$frame.exr || fail "frame $frame as rendered"; done
exits 0 "$bin/dof-gather" shot.####.ldi.exr -o keyed.####.exr --frames 1-3 --focus-distance 1:2,2:3.5,3:6 --fstop 0.2 --blades 5 \
    --blade-rotation 10 --squeeze 1.5 --cat-eye 0.5 --spherical 0.3 --quality draft --channels R,G,B,A -d float
for frame in 1 2 3; do cmp pull.000$frame.exr keyed.000$frame.exr || fail "frame $frame of the pull"; done

# The text of the gizmo, as a parser from PyPI reads it, which does not know Nuke's end_group.
if python3 -c 'import ensurepip' 2>/dev/null && python3 -m venv peers &&
    peers/bin/pip -q --disable-pip-version-check install --retries 1 nkparser >installed 2>&1; then
    grep -v '^end_group$' "$source_dir/share/nuke/SparselensGather.gizmo" >gizmo.nk
    peers/bin/python - <<'END' || fail "nkparser reads another gizmo"
import nkparser
script = nkparser.Script.from_string(open("gizmo.nk", encoding="utf-8").read())
assert not script.has_errors, script.diagnostics
assert [node.class_name for node in script.all_nodes()] == ["Gizmo", "Read", "Output"]
gizmo = script.nodes[0]
assert len(gizmo.knobs_named("addUserKnob")) == 22 and str(gizmo.get("quality")) == "normal", gizmo.knobs
END
else
    echo "skipped: nkparser: PyPI cannot be reached, or has no wheel for this Python"
fi
