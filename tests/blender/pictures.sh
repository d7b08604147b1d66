#!/bin/bash
# The add-on's Take Picture, and --picture: their pictures equal dof-gather's to the bit, nothing is rendered twice, the
# scene is unchanged, and failures are reported. Pictures of 96x54; two minutes.
#   bash pictures.sh BIN_DIR
. "$(dirname "$0")/by_hand.sh"
PATH=$bin:$PATH
in_blender -P "$scene" -- CYCLES 96x54 save "$PWD/small.blend"

# The panel reports what is in the files. A changed lens uses the same views and the same LDI.
press small.blend still refuse 'center.exr is not there: press Render Views' render take
by_hand still ""
same still/picture.exr "Take Picture"
touch -d yesterday still/*.exr still/ldi.exr
stat -c '%n %Y' still/center.exr still/view_?.exr still/ldi.exr >before
press small.blend still focus 2.5 fstop 0.8 blades 5 take
by_hand still "" --focus-distance 2.5 --fstop "$(python3 -c 'import struct; print(struct.unpack("f", struct.pack("f", 0.8))[0])')" --blades 5 \
    --blade-rotation "$(python3 -c 'import math, struct; print(math.degrees(struct.unpack("f", struct.pack("f", 0.3))[0]))')" --squeeze 1.5
same still/picture.exr "another lens"
stat -c '%n %Y' still/center.exr still/view_?.exr still/ldi.exr | cmp - before || fail "another lens rendered or warped again"
touch still/view_0.exr
press small.blend still take
[ still/ldi.exr -nt before ] || fail "the LDI of views that are newer was not made again"
press small.blend still set looks="'--cat-eye 0.7'" focus 3 take
by_hand still "" --focus-distance 3 --cat-eye 0.7
same still/picture.exr "another look"
# The looks of the panel are dof-gather's; the text adds further options. A lens file has its own blades and squeeze,
# unless the camera has some; an aperture's picture has no blades.
press small.blend still set lens_looks.cat_eye=0.7 set lens_looks.tilt="(10,-5)" set lens_looks.highlight_gain=3 set looks="'--quality final'" focus 3 take
by_hand still "" --focus-distance 3 --cat-eye 0.7 --tilt 10,-5 --highlight-gain 3 --quality final
same still/picture.exr "looks of the panel"
press small.blend still set lens_looks.lens="'$source_dir/share/lenses/anamorphic-2x.json'" focus 3 take
by_hand still "" --focus-distance 3 --lens "$source_dir/share/lenses/anamorphic-2x.json"
same still/picture.exr "a lens file"
press small.blend still set lens_looks.aperture="'$source_dir/share/lenses/mirror.exr'" focus 3 take
by_hand still "" --focus-distance 3 --aperture "$source_dir/share/lenses/mirror.exr"
same still/picture.exr "a picture of the aperture"
press small.blend still set lens_looks.spherical=0.5 save "$PWD/looks.blend" refuse-finish "finishing: Blender's lens has no \"Soap bubbles\": remove"
quietly blender --python-exit-code 1 -b looks.blend -P "$views" -- --picture --samples 4 --views 2 -o "$PWD/looked/a.exr"
by_hand looked/views "" --spherical 0.5
same looked/a.exr "the panel's looks on the command line"
quietly blender --python-exit-code 1 -b looks.blend -P "$views" -- --picture --samples 4 --views 2 -o "$PWD/looked/a.exr" --looks '--cat-eye 1'
by_hand looked/views "" --cat-eye 1
same looked/a.exr "--looks in the place of the panel's"
press small.blend still set lens_looks.cat_eye=0@1 set lens_looks.cat_eye=2@3 save "$PWD/looks.blend"
quietly blender --python-exit-code 1 -b looks.blend -P "$views" -- --picture --frames 1,3 --samples 4 --views 2 -o "$PWD/looked/#.exr"
by_hand looked/views .0001 --cat-eye 0
same looked/0001.exr "a look that is keyed, frame 1"
by_hand looked/views .0003 --cat-eye 2
same looked/0003.exr "a look that is keyed, frame 3"
press small.blend still take reload "$PWD/saved.blend" focus 3.5 take
by_hand still "" --focus-distance 3.5
same still/picture.exr "after saving and opening"
# Names may change, and each camera and each scene has its own picture.
press small.blend still focus 3 take rename focus 2.5 take
by_hand still "" --focus-distance 2.5
same still/picture.exr "renamed"
press small.blend still camera Other refuse "camera 'Other' has been moved or changed.*: press Render Views" camera Camera focus 3 take
by_hand still "" --focus-distance 3
same still/picture.exr "one of two cameras"
press small.blend still scene Other refuse 'still-Other/center.exr is not there' render focus 2.5 take scene Scene focus 3.5 take scene Other focus 4.5 take
by_hand still "" --focus-distance 3.5
same still/picture.exr "the first of two scenes"
by_hand still-Other "" --focus-distance 4.5
same still-Other/picture.exr "the second of two scenes"
another="still/center.exr is a view of scene 'Scene': choose another folder for the views of scene 'Other'"
stat -c '%n %y' still/*.exr >before
press small.blend still scene Other set folder="'$PWD/still'" refuse "$another" refuse-render "$another" refuse-finish "$another"
stat -c '%n %y' still/*.exr | cmp - before || fail "another scene changed the views in its folder"
if picture same still/center.exr still-Other/center.exr >found 2>&1; then fail "two scenes have one camera"; fi
# Views of another .blend file that is beside this one are not overwritten by the panel; Take Picture warns. If it is not
# there any more, it has another name now.
cp small.blend other.blend
mkdir -p moved && cp small.blend moved/other.blend
press other.blend still refuse-render "still/center.exr is a view of small.blend: choose another folder for the views of other.blend, or delete those that are there" \
    focus 3 take
grep -q "Warning: $PWD/still/center.exr is a view of small.blend" said || fail "another file: $(tail -n 3 said)"
press moved/other.blend still focus 3 take
if grep -q "a view of small" said; then fail "a file that has moved: $(grep 'a view of' said)"; fi
# A copy has views of its own in a folder with the name of the file.
press small.blend still set folder="''" refuse-render 'no folder is chosen for the views'
press other.blend still set folder="'//by/{blend_name}/'" render
[ -e by/other/center.exr ] || fail "{blend_name}: $(find by)"
press small.blend still follow 2 96
by_hand still "" --focus-distance 2
same still/picture.exr "followed"
press small.blend still stop
echo "Take Picture: dof-gather's bits, the scene unchanged"

# Finish gives the same as dof-finish by hand with the two renders and the current lens, and reports what it cannot do.
press small.blend still focus 3 set finish=8 finish
finished_by_hand still "" still --focus-distance 3
same still/picture.exr "Finish"
if picture same still/gathered.exr still/picture.exr >found 2>&1; then fail "Finish changes nothing"; fi
for half in 1 2; do exrheader still/rays_$half.exr | grep -Eq '^cycles\..*samples \(type string\): "4"' || fail "Finish: not 4 samples"; done
# Rays Where Needed: half of the rays first, then rectangles with the rest.
press small.blend still focus 3 set finish=32 set finish_where_needed=True finish
mv still/picture.exr asked.exr
for half in 1 2; do exrheader still/rays_$half.exr | grep -Eq '^cycles\..*samples \(type string\): "8"' || fail "Rays Where Needed: not 8 samples first"; done
by_hand still "" --focus-distance 3
mv hand.exr gathered.exr
dof-finish gathered.exr still/rays_{1,2}.exr -o hand.exr --ask mask.exr --rays 32 >asked 2>log || fail "$(cat log)"
number=0 parts=()
while IFS=', ' read -r x y width height samples; do
    number=$((number + 1))
    for half in 1 2; do
        part=still/rays_${half}_$number.exr
        parts+=("$part")
        exrheader "$part" | grep -q "^dataWindow (type box2i): ($x $y) - ($((x + width - 1)) $((y + height - 1)))" || fail "Rays Where Needed: $part is not $x,$y,$width,$height"
        exrheader "$part" | grep -Eq "^cycles\..*samples \(type string\): \"$((samples / 2))\"" || fail "Rays Where Needed: $part has not $samples / 2 samples"
    done
done <asked
[ $number -gt 0 ] || fail "Rays Where Needed: none asked for"
dof-finish gathered.exr still/rays_{1,2}.exr "${parts[@]}" -o hand.exr 2>log || fail "$(cat log)"
if grep warning log; then fail "Rays Where Needed: warns of good parts"; fi
same asked.exr "Rays Where Needed"
# The part of most samples shows what the whole render shows there.
read -r number samples window < <(awk '{ print NR, $2, $1 }' asked | sort -k 2nr | head -n 1)
[ "$samples" -ge 16 ] || fail "Rays Where Needed: the rays are spread evenly: $(cat asked)"
oiiotool still/rays_1.exr --crop "$(sed -E 's/(.*),(.*),(.*),(.*)/\3x\4+\1+\2/' <<<"$window")" -o there.exr
dof-compare "still/rays_1_$number.exr" there.exr >log || fail "$(cat log)"
awk '$1 == "psnr_tonemapped" && $2 > 23 { found = 1 } END { exit !found }' log || fail "Rays Where Needed: a part lies elsewhere: $(cat log)"
press small.blend still set looks="'--cat-eye 0.7'" refuse-finish "finishing: Blender's lens has no --cat-eye in \"Other Options\": remove"
press small.blend still set looks="'--quality final'" finish
echo "Finish: dof-finish's bits, the scene unchanged"

# One line says why a picture is impossible, in the tool's words if a tool failed.
press small.blend still move refuse "camera 'Camera' has been moved or changed.*: press Render Views"
press small.blend still frame 2 refuse "center.exr shows frame 1, not 2: press Render Views"
press small.blend still set views=3 refuse "view_2.exr is not there"
press small.blend still set supersample=2 refuse "or the picture's size"
press small.blend still set looks="'--spherical 7'" refuse "dof-gather: --spherical in \"Other Options\": .*"
missing='ldi-warp and dof-gather are not found, neither beside the add-on'
PATH=${PATH#"$bin":} press small.blend still refuse "$missing" refuse-finish "$missing" refuse-animate "$missing"
if [ "$(id -u)" -eq 0 ] && mkdir full && mount -t tmpfs -o size=24k tmpfs full 2>log; then
    press small.blend full refuse-render '/full/center.exr: No space left on device' \
        refuse-animate '/full/center.0001.exr: No space left on device'
    left=$(ls -A full)
    umount full
    [ -z "$left" ] || fail "a full disk: left are $left"
    mount -t tmpfs -o size=$(($(cat still/center.exr still/view_?.exr | wc -c) / 1024 + 40))k tmpfs full
    cp still/center.exr still/view_?.exr full
    press small.blend full refuse 'ldi-warp: .*No space left on device' refuse-finish '/full/rays_1.exr: No space left on device'
    left=$(ls -A full)
    umount full
    [ "$left" = "$(cd still && echo center.exr view_?.exr | tr ' ' '\n')" ] || fail "a full disk, Take Picture: left are $left"
else
    echo "skipped: the full disk: no tmpfs can be mounted"
fi
cp still/view_1.exr whole.exr
head -c 9000 whole.exr >still/view_1.exr
press small.blend still refuse 'ldi-warp: .*view_1.exr'
cp whole.exr still/view_1.exr
echo "mistakes: said"

# The tools are searched beside the add-on, then where pip put them, then on the PATH; a chosen folder is the only one
# searched.
mkdir -p beside/share/sparselens beside/bin site/sparselens-9.dist-info site/bin chosen
cp -r "$(dirname "$views")" beside/share/sparselens/blender
printf '../site/bin/dof-gather,,\n' >site/sparselens-9.dist-info/RECORD
printf 'Name: sparselens\nVersion: 9\n' >site/sparselens-9.dist-info/METADATA
for folder in beside site chosen; do
    mkdir -p $folder/bin
    for name in ldi-warp dof-gather; do printf '#!/bin/sh\necho "%s of %s"\n' $name $folder >$folder/bin/$name; done
    chmod +x $folder/bin/*
done
find_in() { # EXPECTED FOLDER [CHOSEN]
    in_blender small.blend --python-expr "import sys; sys.path[:0] = ['$2', '$PWD/site'] if 'site' in '$1' else ['$2']
from sparselens_blender import tools
folder, where = tools.find('${3:-}')
print('found:', tools.version(folder), where)"
    grep -q "^found: $1" said || fail "$1: $(grep found: said || tail -n 3 said)"
}
find_in 'dof-gather of beside beside the add-on' "$PWD/beside/share/sparselens/blender"
find_in 'dof-gather of site in pip' "$(dirname "$views")"
find_in 'dof-gather (sparselens) .* on the PATH' "$(dirname "$views")"
find_in 'dof-gather of chosen the chosen folder' "$PWD/beside/share/sparselens/blender" "$PWD/chosen/bin"
if (find_in x "$(dirname "$views")" /nowhere) 2>log; then fail "a chosen folder without tools"; fi
grep -q "the folder '/nowhere' does not have" said || fail "a chosen folder without tools: $(tail -n 3 said)"
echo "tools: found"

# A tool that takes long tells how far it is, and one that crashes is said to.
in_blender --python-expr "import sys; sys.path.insert(0, '$(dirname "$views")')
from sparselens_blender.chain import Chain, ToolError
Chain([['sh', '-c', 'echo dof-gather: 41% >&2; echo dof-gather: 42% >&2; sleep 3']]).wait()
try:
    Chain([['sh', '-c', 'echo dof-gather: 1% >&2; echo corrupted size >&2; kill -6 \$\$']]).wait()
except ToolError as error:
    print(error)"
grep -q '^sparselens: dof-gather: 42%$' said || fail "no progress: $(tail -n 3 said)"
grep -q '^sh crashed, which is a fault of sparselens: corrupted size$' said || fail "a crash: $(tail -n 3 said)"

# One line for frames: keys of focus and camera. A second run after a kill renders the remaining views, and its pictures
# are the same.
variant small keys
variant keys lens
one_line=(blender --python-exit-code 1 -b lens.blend -P "$views" -- --picture --frames 1-3 --samples 4 --views 2)
quietly "${one_line[@]}" -o "$PWD/whole/shot.####.exr"
for frame in 1 2 3; do grep -q "^sparselens: frame $frame: making the picture of 3 views of 4 samples a pixel$" said || fail "not announced: frame $frame"; done
grep -q "^sparselens: 3 pictures in $PWD/whole, of 9 views rendered and 0 kept in" said || fail "--picture: $(tail -n 5 said)"
for frame in 1 2 3; do
    by_hand whole/views .000$frame
    same whole/shot.000$frame.exr "--picture, frame $frame"
done
"${one_line[@]}" -o "$PWD/torn/shot.####.exr" >said 2>&1 &
until [ -s torn/views/view_0.0002.exr ]; do
    kill -0 $! 2>log || fail "--picture ended: $(tail -n 5 said)"
    sleep 0.02
done
kill -9 $!
wait $! 2>log || true
rm -f torn/views/*.partial*
stat -c '%n %y' torn/views/{center,view}*.exr >before
quietly "${one_line[@]}" -o "$PWD/torn/shot.####.exr"
while read -r name time; do [ "$(stat -c '%y' "$name")" = "$time" ] || fail "$name was rendered twice"; done <before
grep -Eq "of $((9 - $(wc -l <before))) views? rendered and $(wc -l <before) kept" said || fail "after a kill: $(tail -n 3 said)"
for frame in 1 2 3; do
    picture same whole/shot.000$frame.exr torn/shot.000$frame.exr >found || fail "after a kill frame $frame is another ($(cat found))"
done

# The templates for farms run the same line for a frame.
farm=$source_dir/tests/farm/openjd_template.py template=$source_dir/share/openjd/blender/template.yaml
mkdir session
python3 "$farm" check "$source_dir/tests/farm/jobtemplate-2023-09.json" "$template" 2>log || fail "$(cat log)"
python3 "$farm" run "$template" session Scene="$PWD/lens.blend" Output='//farm/shot.####.exr' Frames=2-3 Script="$views" \
    Options='--samples 4 --views 2' >log 2>&1 || fail "the template: $(tail -n 5 log)"
SLURM_ARRAY_TASK_ID=1 SPARSELENS_VIEWS=$views quietly bash "$source_dir/share/slurm/blender.sh" lens.blend '//farm/shot.####.exr' --samples 4 --views 2
for frame in 1 2 3; do
    picture same whole/shot.000$frame.exr farm/shot.000$frame.exr >found || fail "on a farm frame $frame is another ($(cat found))"
done
[ -z "$(find farm -name '.*')" ] || fail "left are $(find farm -name '.*')"
# Keys of the lens that change afterwards keep the views; a wider lens, a moved camera, other samples and --again do
# not.
again() { # RENDERED EXPRESSION OPTION...
    local rendered=$1 expression=$2
    shift 2
    quietly blender --python-exit-code 1 -b lens.blend --python-expr "import bpy; scene = bpy.context.scene; camera = scene.camera; dof = camera.data.dof
$expression" -P "$views" -- --picture --frames 1 --samples 4 --views 2 "${plain[@]}" -o "$PWD/kept/#.exr" "$@"
    grep -Eq "of $rendered views? rendered and $((3 - rendered)) kept" said || fail "$expression $*: $(tail -n 3 said)"
}
again 3 ""
again 0 ""
by_hand kept/views .0001
same kept/0001.exr "kept views"
again 0 "camera.data.animation_data_clear(); dof.aperture_fstop = 0.9; dof.focus_object = None; dof.focus_distance = 3"
by_hand kept/views .0001 --fstop "$(python3 -c 'import struct; print(struct.unpack("f", struct.pack("f", 0.9))[0])')" --focus-distance 3
same kept/0001.exr "kept views of another lens"
again 3 "camera.data.animation_data_clear(); dof.aperture_fstop = 0.4"
again 0 ""
again 3 "" --samples 2
again 3 "camera.animation_data_clear(); camera.location.x = 0.1" --samples 2
again 3 "camera.animation_data_clear(); camera.location.x = 0.1" --samples 2 --again
rm kept/views/view_1.0001.exr
again 1 "camera.animation_data_clear(); camera.location.x = 0.1" --samples 2
echo "--picture: dof-gather's bits, and no view twice"

# Pictures of one line are finished with renders through the lens, which are kept like the views while the lens is the
# same.
finish_line() { quietly blender --python-exit-code 1 -b lens.blend -P "$views" -- --picture --frames 1-2 --samples 4 --views 2 --finish 8 -o "$PWD/exact/shot.####.exr" "$@"; }
finish_line
for frame in 1 2; do
    finished_by_hand exact/views .000$frame exact/views
    same exact/shot.000$frame.exr "--picture --finish, frame $frame"
done
stat -c '%n %y' exact/views/rays_*.exr >before
finish_line
stat -c '%n %y' exact/views/rays_*.exr | cmp - before || fail "--finish rendered the same rays twice"
finish_line --again
if stat -c '%n %y' exact/views/rays_*.exr | cmp -s - before; then fail "--finish --again kept rays"; fi
press lens.blend film2 set finish=8 set finish_frames=True animate "$PWD/film2/shot"
finished_by_hand film2 .0002 film2
same film2/picture.0002.exr "Finish Frames"
echo "--picture --finish: dof-finish's bits, and no rays twice"

# The last line of a views-only run gives their number.
in_blender small.blend -P "$views" -- -o narrow --samples 1 --views 1 "${plain[@]}"
grep -q '^sparselens_views.py: 2 views in narrow$' said || fail "the last line: $(tail -n 3 said)"

# Both eyes of a stereo scene, and the chosen one of several view layers.
variant small toe
in_blender toe.blend -P "$views" -- --picture --samples 4 --views 2 -o "$PWD/eyes/shot.exr"
[ "$(cd eyes && echo *.exr)" = "shot_L.exr shot_R.exr" ] || fail "stereo: $(ls eyes)"
for eye in L R; do
    ldi-warp eyes/views/center_$eye.exr eyes/views/view_?_$eye.exr -o hand.ldi.exr
    dof-gather hand.ldi.exr -o hand.exr --overscan crop
    same eyes/shot_$eye.exr "stereo, $eye"
done
variant small layers
for manner in "" --multilayer; do
    in_blender layers.blend -P "$views" -- --picture --samples 4 --views 2 -o "$PWD/layered/shot.exr" --layer front $manner --views-folder "$PWD/layered/views$manner"
    ldi-warp layered/views$manner/{center,view_0,view_1}.exr -o hand.ldi.exr ${manner:+--layer front} 2>log || fail "$(cat log)"
    dof-gather hand.ldi.exr -o hand.exr --overscan crop 2>log || fail "$(cat log)"
    same layered/shot.exr "a view layer, $manner"
done
exits 1 blender -b layers.blend -P "$views" -- --picture -o "$PWD/layered/shot.exr" --multilayer
grep -q 'error: --multilayer: a picture is of one of the view layers back, front: choose it by --layer' stderr || fail "two layers: $(cat stderr)"
echo "eyes and layers: each its picture"

# Automatic overscan considers all layers: the posts, in a layer of their own, are nearer than everything in the first
# layer.
in_blender layers.blend -P "$views" -- -o overscan --samples 1 --views 0 --multilayer
both=$(sed -n 's/.*overscan of \([0-9]*\) pixels.*/\1/p' said)
most=0
for layer in back front; do
    in_blender layers.blend -P "$views" -- -o overscan --samples 1 --views 0 --layer $layer
    of_layer=$(sed -n 's/.*overscan of \([0-9]*\) pixels.*/\1/p' said)
    [ "$of_layer" -le "$most" ] || most=$of_layer
    echo "overscan of $layer: $of_layer"
done
[ "$both" -eq "$most" ] || fail "overscan of both layers: $both, not $most"

# Render Animation makes the pictures that the output settings name, and keeps usable files.
press lens.blend film animate "$PWD/film/shot"
grep -q "Info: 2 pictures in $PWD/film, of 6 views rendered and 0 kept in $PWD/film" said || fail "Render Animation: $(tail -n 5 said)"
[ "$(cd film && echo shot*)" = "shot0001.png shot0002.png" ] || fail "Render Animation wrote $(ls film)"
by_hand film .0002
same film/picture.0002.exr "Render Animation"
press lens.blend film set keep=True animate "$PWD/film/shot"
grep -q "of 0 views rendered and 6 kept" said || fail "Keep Views: $(tail -n 5 said)"
if grep -q Warning said; then fail "Keep Views: $(grep Warning said)"; fi
# The node group of the compositor gives these pictures, and a still.
composed() { # FILE PICTURE: linear, within the rounding to half
    oiiotool "$1" --ch R,G,B -o a.exr "$2" --ch R,G,B -o b.exr
    oiiotool a.exr b.exr --fail 0.001 --hardfail 0.002 --diff >log 2>&1 || fail "composed is $1, not $2: $(cat log)"
}
press lens.blend film frame 2 compose "$PWD/composed.exr"
composed composed.exr film/picture.0002.exr
press lens.blend film frame 1 compose "$PWD/composed.exr" frame 2 compose "$PWD/composed.exr"
composed composed.exr film/picture.0002.exr
press small.blend still compose "$PWD/composed.exr"
composed composed.exr still/picture.exr
echo "the node group: the pictures"
touch lens.blend
press lens.blend film set keep=True animate "$PWD/film/shot"
grep -q "Warning: lens.blend was saved after views that are kept were rendered: .*switch Keep Views off" said || fail "a newer file: $(tail -n 5 said)"
press lens.blend film animate "$PWD/film/shot"
grep -q "of 6 views rendered and 0 kept" said || fail "without Keep Views: $(tail -n 5 said)"
echo "Render Animation: the scene's output, and no view twice"

# Other formats use Blender: its output settings and its colours. Its Standard view gives dof-gather's own pictures,
# rounded.
quietly blender --python-exit-code 1 -b small.blend --python-expr "import bpy; scene = bpy.context.scene
scene.render.image_settings.file_format = 'PNG'; scene.view_settings.view_transform = 'Standard'" \
    -P "$views" -- --picture --samples 4 --views 2 -o "$PWD/formats/shot"
[ -s formats/shot.png ] || fail "the scene's format: $(ls formats)"
by_hand formats/views ""
dof-gather hand.ldi.exr --overscan crop -o hand.png
[ "$(oiiotool hand.png formats/shot.png --diff 2>&1 | sed -n 's/.*Max error *= *\([0-9.e-]*\).*/\1/p' | awk '{ print $1 > 1.5 / 255 }')" != 1 ] ||
    fail "the PNG has other colours: $(oiiotool hand.png formats/shot.png --diff 2>&1)"
quietly blender --python-exit-code 1 -b small.blend --python-expr "import bpy; bpy.context.scene.view_settings.view_transform = 'Filmic'" \
    -P "$views" -- --picture --samples 4 --views 2 -o "$PWD/formats/filmic.png"
grep -q "0 views rendered and 3 kept\|3 kept" said || fail "another format renders again: $(tail -n 3 said)"
if oiiotool formats/shot.png formats/filmic.png --diff >log 2>&1; then fail "Filmic looks as Standard does"; fi
says() { # CODE PATTERN OPTION...
    local code=$1 pattern=$2
    shift 2
    exits "$code" blender -b small.blend -P "$views" -- --picture --samples 4 --views 2 "$@"
    grep -Eq "^sparselens_views.py: error: .*$pattern" stderr || fail "'$pattern' is not in: $(cat stderr)"
}
says 1 '2 frames need a #' -o "$PWD/x/a.png" --frames 1-2
says 1 'pictures end in one of' -o "$PWD/x/a.psd"
says 2 'not allowed with argument --picture' -o "$PWD/x/a.png" --plan plan.json
says 1 'dof-gather: .*--spherical' -o "$PWD/formats/shot.exr" --looks '--spherical 7'
exits 2 blender -b small.blend -P "$views" -- -o x --again
grep -q 'error: argument --again: needs --picture' stderr || fail "--again: $(cat stderr)"
exits 1 blender -b --factory-startup -P "$views" -- -o //views/
grep -q "'//views/' is a folder beside the .blend file, which is not saved yet" stderr || fail "//: $(cat stderr)"
[ ! -e x ] || fail "an error left files: $(ls x)"
echo "--picture: the scene's format and colours"
