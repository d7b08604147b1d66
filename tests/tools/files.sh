# Files by other programs: several parts, one per layer or per view; the sky in each
# renderer's form, and renderers' cameras; the views of stereo files, coloured alpha, and the history of a picture.
#   bash files.sh BIN_DIR
. "$(dirname "$0")/check.sh"
flat=(--lens-radius 0 -d float)
same() { picture same "$1" "$2" >found 2>&1 || fail "$3 ($(cat found))"; }
names() { exrheader "$1" | sed -nE 's/^ +([A-Za-z.]+), (16|32)-bit.*/\1/p' | tr '\n' ' '; }

oiiotool --pattern fill:topleft=0.1,0.5,0.9,1:topright=1,0,0,1:bottomleft=0,1,0,1:bottomright=1,0.25,0.5,1 24x16 4 --chnames R,G,B,A -d float -o rgba.exr
oiiotool --pattern checker:width=4:height=4:color1=2:color2=5 24x16 1 --chnames Z -d float -o depth.exr
picture edit rgba.exr diffuse.exr channels=R,G,B 'R*=0.5' 'G*=0.5' 'B*=0.5'
oiiotool rgba.exr depth.exr --chappend -d float -o one.exr
exits 0 "$bin/dof-gather" one.exr -o expected.exr "${flat[@]}"

# One part per layer: their channels become layers; the beauty comes first wherever it is.
part() { oiiotool "$1" --sattrib oiio:subimagename "$2" "${@:4}" -d float -o "$3"; } # FILE NAME OUT [oiiotool...]
part rgba.exr rgba p_rgba.exr
part depth.exr depth p_depth.exr
part diffuse.exr diffuse p_diffuse.exr
oiiotool p_diffuse.exr p_rgba.exr p_depth.exr --siappendall -o layers.exr
exits 0 "$bin/dof-gather" layers.exr -o out.exr "${flat[@]}" --depth-out z.exr
[ "$(names out.exr)" = "A B G R diffuse.B diffuse.G diffuse.R " ] || fail "layers by parts: $(names out.exr)"
picture edit out.exr cut.exr channels=R,G,B,A
same cut.exr expected.exr "the beauty's part"
picture edit out.exr cut.exr channels=R=diffuse.R,G=diffuse.G,B=diffuse.B
same cut.exr diffuse.exr "a layer's part"
same z.exr depth.exr "depth in a part of its own"

# A picture in another format is reported with its format, also from a pipe.
oiiotool one.exr --ch R,G,B -o view.png
for tool in ldi-warp ldi-plan; do fails_saying 1 "^$tool: view.png: is a PNG picture, and EXR is needed: render to EXR" "$bin/$tool" view.png -o x.exr; done
fails_saying 2 '^dof-gather: view.png: is a picture without depth: give its depth by --depth-file' "$bin/dof-gather" view.png -o x.exr
[ ! -e x.exr ] || fail "reads a PNG without depth"
fails_saying 2 '--holdout: view.png is not an EXR file' "$bin/dof-gather" one.exr -o x.exr "${flat[@]}" --holdout view.png
fails_saying 1 'view.png: is a PNG picture' "$bin/dof-gather" one.exr -o x.exr --focal-length 50 --sensor-width 36 --lens-radius 1 \
    --focus-distance 3 --aperture view.png
fails_saying 1 'standard stream: is a PNG picture' bash -c '"$1" - -o x.exr --lens-radius 0 <view.png' - "$bin/dof-gather"
printf 'P6 2 2 255 abcdefghijkl' >view.ppm
fails_saying 2 'view.ppm: is a picture without depth' "$bin/dof-gather" view.ppm -o x.exr "${flat[@]}"
cp view.ppm view.txt
fails_saying 1 'view.txt: not an EXR file; a photograph' "$bin/dof-gather" view.txt -o x.exr "${flat[@]}"

# The name of a channel says what it holds. --data and --light overrule the name, and the output keeps what they said.
oiiotool --pattern noise:type=uniform:min=-9:max=9 24x16 3 --chnames secret.R,secret.G,secret.B -d float -o secret.exr
oiiotool one.exr secret.exr --chappend -d float -o secrets.exr
exits 0 "$bin/dof-gather" secrets.exr -o out.exr "${flat[@]}" -v
grep -q 'layer secret: light' stderr || fail "a layer of an unknown name: $(cat stderr)"
exits 0 "$bin/dof-gather" secrets.exr -o out.exr "${flat[@]}" -v --data secret
grep -q 'layer secret: data' stderr || fail "--data: $(cat stderr)"
exits 0 "$bin/ldi-warp" secrets.exr -o secrets.ldi.exr --data secret
exits 0 "$bin/dof-gather" secrets.ldi.exr -o out.exr "${flat[@]}" -v
grep -q 'layer secret: data' stderr || fail "--data: $(cat stderr)"
exits 0 "$bin/ldi-cluster" secrets.ldi.exr -o cluster.exr --layers 1 --light secret
exits 0 "$bin/dof-gather" cluster.exr -o out.exr "${flat[@]}" -v
grep -q 'layer secret: light' stderr || fail "ldi-cluster --light: $(cat stderr)"
exits 0 "$bin/ldi-cluster" secrets.exr -o cluster.exr --layers 1 --data secret
exits 0 "$bin/dof-gather" cluster.exr -o out.exr "${flat[@]}" -v
grep -q 'layer secret: data' stderr || fail "ldi-cluster --data: $(cat stderr)"
exits 0 "$bin/ldi-warp" secrets.ldi.exr -o again.exr --merge keep --light secret
exits 0 "$bin/dof-gather" again.exr -o out.exr "${flat[@]}" -v
grep -q 'layer secret: light' stderr || fail "ldi-warp --light: $(cat stderr)"
exits 0 "$bin/dof-gather" secrets.ldi.exr -o out.exr "${flat[@]}" -v --light secret
grep -q 'layer secret: light' stderr || fail "--light: $(cat stderr)"
fails_saying 1 'secrets.exr: has no layer or channel secrets \(--data\)' "$bin/dof-gather" secrets.exr -o x.exr "${flat[@]}" --data secrets

# One part per view: the first view is the picture.
part rgba.exr rgba.left l_rgba.exr --sattrib view left
part depth.exr depth.left l_depth.exr --sattrib view left
part diffuse.exr rgba.right r_rgba.exr --sattrib view right
part depth.exr depth.right r_depth.exr --sattrib view right
oiiotool l_rgba.exr r_rgba.exr l_depth.exr r_depth.exr --siappendall -o stereo.exr
exits 0 "$bin/dof-gather" stereo.exr -o out.exr "${flat[@]}"
[ "$(names out.exr)" = "A B G R " ] || fail "two views: $(names out.exr)"
same out.exr expected.exr "the first view"
exits 0 "$bin/ldi-warp" stereo.exr -o ldi.exr --merge keep
exits 0 "$bin/dof-gather" ldi.exr -o out.exr "${flat[@]}"
picture same out.exr expected.exr 1e-3 || fail "ldi-warp of two views"

# --stereo-view: another view, in every tool that reads pictures.
cp diffuse.exr right.exr
exits 0 "$bin/dof-gather" stereo.exr -o out.exr "${flat[@]}" --stereo-view right
[ "$(names out.exr)" = "B G R " ] || fail "the right view: $(names out.exr)"
same out.exr right.exr "--stereo-view right"
exrheader out.exr | grep -q '^view .*"right"' || fail "the picture of a view does not say which"
exits 0 "$bin/ldi-warp" stereo.exr -o ldi.exr --merge keep --stereo-view right
exits 0 "$bin/ldi-cluster" ldi.exr -o less.exr --layers 1 --stereo-view right
exits 0 "$bin/dof-gather" less.exr -o out.exr "${flat[@]}"
picture same out.exr right.exr R,G,B 1e-3 || fail "ldi-warp and ldi-cluster --stereo-view"
if lab; then
    exits 0 "$bin/dof-accumulate" --view 0,0 stereo.exr -o out.exr -d float --lens-radius 0 --stereo-view right
    picture edit out.exr cut.exr channels=R,G,B
    same cut.exr right.exr "dof-accumulate --stereo-view"
    fails_saying 1 'left, right' "$bin/dof-accumulate" --view 0,0 stereo.exr -o x.exr --lens-radius 0 --stereo-view middle
fi
exits 0 "$bin/dof-compare" stereo.exr stereo.exr --json --stereo-view right
exits 0 "$bin/ldi-plan" stereo.exr -o plan.json --stereo-view right --fstop 2 --focus-distance 3 --focal-length 50 --sensor-width 36
for tool in dof-gather ldi-warp ldi-cluster ldi-plan; do
    fails_saying 1 "stereo.exr: has no stereo view 'middle' .*left, right" "$bin/$tool" stereo.exr -o x.exr --stereo-view middle
done
fails_saying 1 'left, right' "$bin/dof-compare" stereo.exr stereo.exr --stereo-view middle
fails_saying 1 "one.exr: .*names no views" "$bin/dof-gather" one.exr -o x.exr "${flat[@]}" --stereo-view left

# --stereo-view all: one run for each view, the same as naming it; %V is its name.
exits 0 "$bin/dof-gather" stereo.exr -o 'eye.%V.exr' "${flat[@]}" --stereo-view all
for eye in left right; do
    exits 0 "$bin/dof-gather" stereo.exr -o one-eye.exr "${flat[@]}" --stereo-view $eye
    same eye.$eye.exr one-eye.exr "--stereo-view all, $eye"
done
fails_saying 2 'put %V' "$bin/dof-gather" stereo.exr -o x.exr "${flat[@]}" --stereo-view all
fails_saying 1 'one.exr: it names no stereo views' "$bin/dof-gather" one.exr -o 'x.%V.exr' "${flat[@]}" --stereo-view=all
fails_saying 2 'needs the name of the input' "$bin/dof-gather" - -o 'x.%V.exr' "${flat[@]}" --stereo-view all
# --help is answered in any combination; an error in the words is reported once.
"$bin/dof-gather" stereo.exr --stereo-view all --help >help 2>stderr || fail "--stereo-view all --help fails"
grep -qF "dof-gather [OPTIONS] " help && [ ! -s stderr ] || fail "--stereo-view all --help: $(cat stderr)"
[ "$(grep -cF "dof-gather [OPTIONS] " help)" = 1 ] || fail "the help is printed twice"
fails_saying 2 "unknown argument: --nonsense" "$bin/dof-gather" stereo.exr -o "x.%V.exr" "${flat[@]}" --stereo-view all --nonsense

# Several views in one part.
cp one.exr left.exr
oiiotool diffuse.exr depth.exr --chappend -d float -o right_view.exr
exrmultiview left left.exr right right_view.exr multiview.exr
exits 0 "$bin/dof-gather" multiview.exr -o out.exr "${flat[@]}"
same out.exr expected.exr "the default view of a part"
exits 0 "$bin/dof-gather" multiview.exr -o out.exr "${flat[@]}" --stereo-view right
same out.exr right.exr "another view of a part"
fails_saying 1 'left, right' "$bin/dof-gather" multiview.exr -o x.exr "${flat[@]}" --stereo-view middle

# Coloured alpha: each colour is attenuated by its own alpha, as in OpenImageIO (whose AR, AG, AB then add up to more
# than 1, so they are not compared); ldi-cluster makes one sample of both.
pane() { # VALUES DEPTH OUT
    oiiotool --pattern constant:color="$1,$2" 8x4 7 --chnames R,G,B,AR,AG,AB,Z -d float --deepen:z="$2" -o "$3"
}
pane 0.25,0.5,0,0.25,0.75,1 2 glass.exr
pane 1,0.5,0.25,1,1,1 5 wall.exr
oiiotool glass.exr wall.exr --deepmerge -o coloured.exr
oiiotool coloured.exr --flatten --ch R,G,B -d float -o oiio.exr
exits 0 "$bin/dof-gather" coloured.exr -o out.exr "${flat[@]}" -v
grep -q 'each colour has its own coverage' stderr || fail "-v does not say that there is per-channel alpha"
[ "$(names out.exr)" = "A AB AG AR B G R " ] || fail "coloured alpha: $(names out.exr)"
picture edit out.exr cut.exr channels=R,G,B
same cut.exr oiio.exr "coloured alpha, flattened"
picture make covered.exr 8x4 A=1 AR=1 AG=1 AB=1
picture same out.exr covered.exr A,AR,AG,AB >found || fail "all is covered ($(cat found))"
exits 0 "$bin/ldi-cluster" coloured.exr -o less.exr --layers 1
exits 0 "$bin/dof-gather" less.exr -o out.exr "${flat[@]}" --channels R,G
[ "$(names out.exr)" = "G R " ] || fail "--channels R,G: $(names out.exr)"
picture same out.exr oiio.exr R,G 1e-3 || fail "clustered coloured alpha"

# Deep parts: their samples are merged, as by oiiotool --deepmerge.
oiiotool glass.exr --sattrib oiio:subimagename glass -o p_glass.exr
oiiotool wall.exr --sattrib oiio:subimagename wall -o p_wall.exr
oiiotool p_wall.exr p_glass.exr --siappendall -o parts.exr
exits 0 "$bin/dof-gather" parts.exr -o out.exr "${flat[@]}" -v
grep -q '2 deep parts are merged' stderr || fail "-v does not say that parts are merged: $(cat stderr)"
picture edit out.exr cut.exr channels=R,G,B
same cut.exr oiio.exr "two deep parts"

# The history of a picture is in its metadata, one line per command, in oiiotool's form; through pipes too.
history() { exrheader "$1" | awk '/^Exif:ImageHistory/ { on = 1; sub(/^[^"]*"/, "") } on { last = sub(/"$/, ""); print; on = !last }'; }
oiiotool one.exr --sattrib shot "sq01" --nosoftwareattrib --sattrib Exif:ImageHistory "render shot" -o 'centre view.exr'
chain() {
    "$bin/ldi-warp" 'centre view.exr' --threads "$1" -o - | "$bin/ldi-cluster" - --layers 2 --threads "$1" -o - |
        "$bin/dof-gather" - --lens-radius 0 -v -o "$2" 2>stderr
}
unset SPARSELENS_NO_HISTORY
chain 1 out.exr
told="render shot
ldi-warp 'centre view.exr'
ldi-cluster - --layers 2
dof-gather - --lens-radius 0"
[ "$(history out.exr)" = "$told" ] || fail "history: $(history out.exr)"
exrheader out.exr | grep -q '^Software .*sparselens .* : dof-gather - --lens-radius 0"' || fail "Software: $(exrheader out.exr)"
exrheader out.exr | grep -q '^shot .*"sq01"' || fail "the centre view's metadata is lost"
chain 2 again.exr
cmp -s out.exr again.exr || fail "threads and the output's name are in the picture"
if lab; then
    exits 0 "$bin/dof-accumulate" --view 0,0 one.exr -o out.exr --lens-radius 0
    history out.exr | grep -q 'dof-accumulate --view 0,0 one.exr --lens-radius 0$' || fail "dof-accumulate: $(history out.exr)"
    exits 0 "$bin/dof-accumulate" --view 0,0 'centre view.exr' -o again.exr --lens-radius 0 --no-history
    [ "$(history again.exr)" = "render shot" ] || fail "dof-accumulate --no-history: $(history again.exr)"
fi
exits 0 "$bin/dof-gather" 'centre view.exr' -o out.exr --lens-radius 0 --no-history
[ "$(history out.exr)" = "render shot" ] || fail "--no-history: $(history out.exr)"
exits 0 "$bin/ldi-warp" 'centre view.exr' -o ldi.exr --no-history
exits 0 "$bin/ldi-cluster" ldi.exr -o less.exr --layers 1 --no-history
[ "$(history less.exr)" = "render shot" ] || fail "--no-history of an LDI: $(history less.exr)"
export SPARSELENS_NO_HISTORY=1
exits 0 "$bin/dof-gather" 'centre view.exr' -o again.exr --lens-radius 0
cmp -s out.exr again.exr || fail "\$SPARSELENS_NO_HISTORY is not --no-history"

# The sky: any of its usual values gives the picture of infinity. --far: the far clip is sky too.
lens=(--focal-length 50 --sensor-width 36 --fstop 0.5 --focus-distance 4 -d float)
sky() { # DEPTH TYPE OUT: the left half at depth 4, the right half sky
    picture make "$3" 24x16 R=0.5 G=0.25 B=1 A=1 Z=$1 "$2=Z" fill=12x16 Z=4
}
sky inf float sky.exr
exits 0 "$bin/dof-gather" sky.exr -o infinity.exr "${lens[@]}" --depth-out infinity_z.exr
for way in '1e10 float' '1e30 float' '65504 half' '1e10 half'; do
    sky $way sky.exr
    exits 0 "$bin/dof-gather" sky.exr -o out.exr "${lens[@]}" --depth-out z.exr
    same out.exr infinity.exr "sky as $way"
    picture same z.exr infinity_z.exr || fail "the depth of sky as $way"
done
sky 100 float sky.exr
exits 0 "$bin/dof-gather" sky.exr -o out.exr "${lens[@]}" --far 100
same out.exr infinity.exr "--far"
exits 0 "$bin/dof-gather" sky.exr -o out.exr "${lens[@]}" --depth-out z.exr
picture differ z.exr infinity_z.exr || fail "--far changes nothing"
fails_saying 2 '--far' "$bin/dof-gather" sky.exr -o x.exr --far 0
fails_saying 2 '--far' "$bin/ldi-warp" sky.exr -o x.exr --far 0
fails_saying 2 '--far' "$bin/ldi-cluster" sky.exr -o x.exr --layers 1 --far 0
fails_saying 2 '--far' "$bin/ldi-plan" sky.exr -o x.json --far 0
fails_saying 2 '--far' "$bin/dof-compare" sky.exr sky.exr --far 0

# A renderer's camera: found and reported; if it contradicts itself, an error names the option.
picture edit one.exr vray.exr set=cameraFocalLength:50 set=cameraFov:39.6 set=cameraFNumber:0.5
exits 0 "$bin/dof-gather" vray.exr -o out.exr -d float --focus-distance 4 -v
grep -q 'focal length 50 (cameraFocalLength)' stderr || fail "-v does not say what was found: $(cat stderr)"
exits 0 "$bin/dof-gather" one.exr -o options.exr -d float --focus-distance 4 --focal-length 50 --fstop 0.5 --sensor-width 36.0032
picture same out.exr options.exr 1e-4 || fail "V-Ray's lens is not that of the options"
fails_saying 2 'give --focus-distance' "$bin/dof-gather" vray.exr -o x.exr
picture edit vray.exr both.exr set=pinholeFocalLength:35
fails_saying 2 'pinholeFocalLength says 35, cameraFocalLength says 50.*give --focal-length' \
    "$bin/dof-gather" both.exr -o x.exr --focus-distance 4
exits 0 "$bin/dof-gather" both.exr -o out.exr -d float --focus-distance 4 --focal-length 50
picture same out.exr options.exr 1e-4 || fail "--focal-length settles it"
[ ! -e x.exr ] || fail "a failure wrote x.exr"

# No tool of the chain overwrites its input, even under a second name.
cp one.exr kept.exr
ln -s one.exr soft.exr
known=(--lens-radius 0.1 --focal-length 50 --sensor-width 36 --focus-distance 4)
for output in one.exr soft.exr; do
    fails_saying 2 "--output $output would overwrite the input one.exr" "$bin/ldi-warp" one.exr -o $output
    fails_saying 2 "--output $output would overwrite the input one.exr" "$bin/ldi-warp" kept.exr --view 0.1,0 one.exr -o $output "${known[@]}"
    fails_saying 2 "--output $output would overwrite the input one.exr" "$bin/ldi-cluster" one.exr -o $output --layers 1
    fails_saying 2 "--output $output would overwrite the input one.exr" "$bin/ldi-plan" one.exr -o $output "${known[@]}"
    lab || continue
    fails_saying 2 "--output $output would overwrite the input one.exr" "$bin/dof-accumulate" --view 0,0 kept.exr --view 1,0 one.exr -o $output --lens-radius 0
    fails_saying 2 "--output $output would overwrite the input one.exr" "$bin/dof-accumulate" --view 0,0 kept.exr --center one.exr -o $output
done
mkdir masked
ln one.exr masked/view_0.exr
fails_saying 2 '--masks masked/view_0.exr would overwrite the input one.exr' "$bin/ldi-plan" one.exr -o plan.json --masks masked "${known[@]}"
same one.exr kept.exr "an input that is no output"
