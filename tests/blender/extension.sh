#!/bin/bash
# share/blender as users install it, into its own settings: as an extension where Blender has them (4.2 and later),
# built and checked by Blender itself; else as an add-on from a zip of its folder. Its operator then renders the same as
# the script. A minute.
#   bash extension.sh BIN_DIR
. "$(dirname "$0")/common.sh"
export HOME=$PWD/home XDG_CONFIG_HOME=$PWD/home/.config
mkdir home
in_blender -P "$scene" -- CYCLES 96x54 save "$PWD/small.blend"

if blender --command extension --help 2>/dev/null | grep -q server-generate; then
    quietly blender --command extension validate "$source_dir/share/blender/sparselens_blender"
    quietly blender --command extension build --source-dir "$source_dir/share/blender/sparselens_blender" --output-dir "$PWD"
    zip=$(echo sparselens_blender-*.zip)
    quietly blender --command extension validate "$zip"
    grep -q Success said || fail "validate: $(cat said)"
    quietly blender --command extension install-file -r user_default -e "$zip"
    enable= command=yes
    echo "extension: $zip is valid and was installed"
elif blender -b --python-expr 'import bpy, sys; sys.exit(bpy.app.version < (4, 2))' >said 2>&1; then # the module bpy
    (cd "$source_dir/share/blender" && python3 -m zipfile -c "$scratch/sparselens_blender.zip" sparselens_blender)
    in_blender --python-expr "import bpy
assert bpy.ops.extensions.package_install_files(filepath='$PWD/sparselens_blender.zip', repo='user_default') == {'FINISHED'}"
    enable="import addon_utils
addon_utils.enable('bl_ext.user_default.sparselens_blender', default_set=True)" command=yes
    echo "extension: installed"
else
    python3 -m zipfile -c sparselens_blender.zip "$source_dir/share/blender/sparselens_blender"
    enable="import bpy
bpy.ops.preferences.addon_install(filepath='$PWD/sparselens_blender.zip')
bpy.ops.preferences.addon_enable(module='sparselens_blender')" command=
    echo "add-on: installed; this Blender has no extensions"
fi
for version in 9.0 9.1 9.2 outside broken; do
    folder=sparselens-$version
    [ $version != outside ] || folder=elsewhere
    mkdir -p $folder/bin
    for name in ldi-warp dof-gather; do printf '#!/bin/sh\necho "%s of %s"; exit %s\n' $name $version "$([ $version != broken ] || echo 3)" >$folder/bin/$name; done
    chmod +x $folder/bin/*
    tar -cJf "$folder.tar.xz" $folder
done
mv elsewhere.tar.xz outside.tar.xz
mv sparselens-broken.tar.xz broken.tar.xz
echo text >not-packed.tar.xz
head -c 100 sparselens-9.1.tar.xz >part.tar.xz
# Zips, as for Windows. Python does not keep that a file can be run, so the programs of this one do not run here.
python3 -m zipfile -c not-run.zip sparselens-9.1/
python3 -m zipfile -c outside.zip elsewhere/
head -c 100 not-run.zip >part.zip
cat >operate.py <<EOF
$enable
import os
import bpy
scene = bpy.context.scene
assert bpy.types.SPARSELENS_PT_panel.is_registered
scene.cycles.samples = 2
scene.sparselens.folder, scene.sparselens.views = "$PWD/installed", 1
assert bpy.ops.sparselens.render_views() == {"FINISHED"}
addons = bpy.context.preferences.addons
preferences = next(addons[name].preferences for name in addons.keys() if name.endswith("sparselens_blender"))
preferences.folder = "$bin"
assert bpy.ops.sparselens.find_tools() == {"FINISHED"}
assert bpy.ops.sparselens.take_picture() == {"FINISHED"}
# Install Tools takes an archive: here one of small scripts. Files that are none are refused, and change nothing.
preferences.folder = ""
# The zip of a release has the archive in it: here one of version 9.0, which a newer one replaces.
import sys
beside = os.path.dirname(sys.modules[type(preferences).__module__].__file__)
packed = os.path.join(beside, "sparselens-9.0-linux-%s.tar.xz" % os.uname().machine)
others = [os.path.join(beside, "sparselens-9.3-" + name) for name in ("linux-other.tar.xz", "windows-x86_64.zip")]
for other in others:
    open(other, "w").close()
os.link("$PWD/sparselens-9.0.tar.xz", packed)
assert bpy.ops.sparselens.find_tools() == {"FINISHED"}
for wrong in ("not-packed.tar.xz", "part.tar.xz", "outside.tar.xz", "broken.tar.xz",
              "part.zip", "outside.zip", "not-run.zip"):
    try:
        bpy.ops.sparselens.install_tools(filepath=os.path.join("$PWD", wrong))
        raise SystemExit("took " + wrong)
    except RuntimeError as error:
        assert wrong in str(error) or "cannot be run" in str(error), error
        assert str(error).strip().count("\n") == 0, error
        if wrong.startswith(("not-packed", "part")):
            assert "choose sparselens-VERSION-linux-%s.tar.xz" % os.uname().machine in str(error), error
for version in "9.1", "9.2":
    assert bpy.ops.sparselens.install_tools(filepath="$PWD/sparselens-%s.tar.xz" % version) == {"FINISHED"}
    assert bpy.ops.sparselens.find_tools() == {"FINISHED"}
for file in packed, *others:
    os.remove(file)
preferences.folder = "/nowhere"
for operator in bpy.ops.sparselens.find_tools, bpy.ops.sparselens.take_picture:
    try:
        operator()
        raise SystemExit("tools in /nowhere")
    except RuntimeError as error:
        assert "the folder '/nowhere' does not have ldi-warp and dof-gather" in str(error), error
EOF
in_blender small.blend -P operate.py
cp said operated
in_blender small.blend -P "$views" -- -o script --views 1 --samples 2
for view in center view_0; do picture same installed/$view.exr script/$view.exr >found || fail "$view of the operator is not the script's ($(cat found))"; done
grep -q "dof-gather (sparselens) [0-9.]*, the chosen folder: $bin" operated || fail "the button Test: $(tail -n 5 operated)"
grep -q "dof-gather of 9.0, installed: " operated || fail "the archive in the zip: $(tail -n 5 operated)"
grep -q "dof-gather of 9.2, installed: " operated || fail "Install Tools: $(tail -n 5 operated)"
[ "$(find home -name 'sparselens-9*' -o -name '.new-*' | xargs -n 1 basename)" = sparselens-9.2 ] || fail "Install Tools left $(find home -name 'sparselens-9*')"
find home -name sparselens-9.2 | xargs rm -r
PATH=$bin:$PATH in_blender small.blend -P "$views" -- --picture -o "$PWD/expected.exr" --samples 2 --views 1 --views-folder "$PWD/again"
picture same installed/picture.exr expected.exr >found || fail "Take Picture makes another picture than the script ($(cat found))"
if [ -n "$command" ]; then
    PATH=$bin:$PATH quietly blender -b small.blend --command sparselens -o "$PWD/line.exr" --samples 2 --views 1
    picture same line.exr expected.exr >found || fail "--command sparselens makes another picture ($(cat found))"
    echo "one line: the script's picture"
else
    echo "skipped: --command, which this Blender does not have"
fi
echo "installed: the operators make what the script does, to the bit"
