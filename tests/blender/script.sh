#!/bin/bash
# The renders of share/blender/sparselens_views.py, on pictures of 96x54: cameras animated in every way, frames, eyes,
# framing, overscan, passes, errors, and that the add-on leaves the scene unchanged. A few minutes.
#   bash script.sh BIN_DIR
. "$(dirname "$0")/common.sh"
in_blender -P "$scene" -- CYCLES 96x54 save "$PWD/small.blend"

moving=(keys path track driver child marker lens)
eyes=(offaxis offaxis_left parallel toe toe_left cameras)
each_variant small "${moving[@]}" "${moving[@]/%/,still}" path,eevee path,eevee,still pinhole,framing "${eyes[@]/#/pinhole,}" passes \
    keys,blades homeless panorama mesh wide macro unlayered seeded eevee workbench denoised held_collection held_object \
    held_material unheld pinhole,region

# An animated camera gives the same views as a still one at the position of that frame. 60 dB allow for the rounding of
# its matrix, which moves a ray over an edge here and there; with 64 samples per pixel one ray counts little. The views
# differ from each other: none was moved back.
for kind in "${moving[@]}"; do
    in_blender $kind.blend -P "$views" -- "${plain[@]}" -o $kind --frames 4 --samples 64 --views 2
    in_blender $kind,still.blend -P "$views" -- "${plain[@]}" -o still --samples 64 --views 2
    for view in center view_0 view_1; do alike $kind/$view.0004.exr still/$view.exr 60; done
    for view in view_0 view_1; do unlike $kind/center.0004.exr $kind/$view.0004.exr 30; done
    unlike $kind/view_0.0004.exr $kind/view_1.0004.exr 30
    echo "$kind: the views of a camera that stands still"
done

# The same with EEVEE, for a camera whose matrix is not rounded: with one sample per pixel, edges show all rounding.
if eevee_runs path,eevee; then
    in_eevee path,eevee.blend -P "$views" -- "${plain[@]}" -o eevee --frames 4 --samples 1 --views 1
    in_eevee path,eevee,still.blend -P "$views" -- "${plain[@]}" -o eevee_still --samples 1 --views 1
    for view in center view_0; do alike eevee/$view.0004.exr eevee_still/$view.exr 60; done
    unlike eevee/center.0004.exr eevee/view_0.0004.exr 30
    echo "EEVEE: the views of a camera that stands still"
fi

# Several frames in one process equal the same frames alone, and differ from each other.
in_blender keys.blend -P "$views" -- "${plain[@]}" -o range --frames 1-5x2,6 --samples 4 --views 1
[ "$(cd range && echo *)" = "$(echo {center,view_0}.000{1,3,5,6}.exr)" ] || fail "--frames wrote $(ls range)"
in_blender keys.blend -P "$views" -- "${plain[@]}" -o alone --frame 5 --samples 4 --views 1
alike range/view_0.0005.exr alone/view_0.exr 60
unlike range/center.0001.exr range/center.0005.exr 30
for what in worldToCamera focus aperture pinholeFocalLength aperture_blades aperture_rotation aperture_ratio; do
    exrheader alone/center.exr | grep "^$what (" >/dev/null || fail "no $what in the header"
done

# Each view has noise of its own, even where all see the same.
in_blender small.blend --python-expr "import bpy; bpy.context.scene.camera.data.dof.aperture_fstop = 1e6" -P "$views" -- "${plain[@]}" -o one_place --samples 4 --views 1
unlike one_place/center.exr one_place/view_0.exr 60

# The framing, compared with Blender's own pinhole render: shift, fit, non-square pixels, a percentage. Noise with the
# same seed is the same, so 60 dB; with overscan every pixel has another seed, so 36 dB at 128 samples.
in_blender pinhole,framing.blend -P "$views" -- "${plain[@]}" -o framing --samples 128 --views 0
in_blender pinhole,framing.blend -P "$variants" -- render 128 1 1 "$PWD/own.####.exr"
alike framing/center.exr own.0001.exr 60
in_blender pinhole,framing.blend -P "$views" -- -o over --supersample 1 --samples 128 --views 0 --overscan 9
exrheader over/center.exr >header
grep -Fq 'dataWindow (type box2i): (-9 -9) - (84 51)' header || fail "--overscan: $(grep dataWindow header)"
grep -Fq 'displayWindow (type box2i): (0 0) - (75 42)' header || fail "--overscan: $(grep displayWindow header)"
grep -Fq 'pixelAspectRatio (type float): 1.25' header || fail "$(grep pixelAspectRatio header)"
oiiotool over/center.exr --crop 76x43+0+0 -o inside.exr
alike inside.exr framing/center.exr 36
echo "framing and overscan: as Blender's own picture"

# --overscan auto: the same number of pixels as ldi-plan asks for, at each frame, in the camera's own pixel aspect.
asked() { sed -n '/"overscan"/,/}/s/.*": \([0-9]*\),*$/\1/p' "$1" | sort -n | tail -n 1; }
in_blender lens.blend -P "$views" -- "${plain[@]}" -o far --frames 1,4 --samples 4 --views 0
in_blender lens.blend -P "$views" -- -o auto --supersample 1 --frames 1,4 --samples 4 --views 1 --overscan auto
for frame in 0001 0004; do
    "$bin/ldi-plan" far/center.$frame.exr -o plan.json >/dev/null
    wanted=$(asked plan.json)
    [ "$wanted" -gt 0 ] || fail "ldi-plan asks for no overscan"
    for view in center view_0; do
        exrheader auto/$view.$frame.exr >header
        grep -Fq "dataWindow (type box2i): (-$wanted -$wanted)" header || fail "--overscan auto, not $wanted: $(grep dataWindow header)"
    done
done
in_blender pinhole,framing.blend -P "$views" -- -o over --supersample 1 --samples 4 --views 0 --overscan auto
"$bin/ldi-plan" framing/center.exr -o plan.json >/dev/null
exrheader over/center.exr >header
grep -Fq "dataWindow (type box2i): (-$(asked plan.json) -" header || fail "not $(asked plan.json): $(grep dataWindow header)"
echo "--overscan auto: what the plan asks for"

# --supersample: the views equal those of a scene of twice the size with a quarter of the samples, and say so, and the
# picture has the scene's size. Noise with the same seed is the same.
in_blender small.blend --python-expr "import bpy; r = bpy.context.scene.render; r.resolution_x *= 2; r.resolution_y *= 2
bpy.context.scene.cycles.filter_width = 2; bpy.ops.wm.save_as_mainfile(filepath='$PWD/large.blend')"
in_blender small.blend -P "$views" -- "${plain[@]}" -o fine --samples 16 --views 1 --supersample 2
in_blender large.blend -P "$views" -- "${plain[@]}" -o by_hand --samples 4 --views 1
in_blender small.blend --python-expr "import bpy; bpy.context.scene.cycles.filter_width = 2" -P "$views" -- "${plain[@]}" -o wide --samples 16 --views 1 --supersample 2
for view in center view_0; do alike wide/$view.exr by_hand/$view.exr 60; done
exrheader wide/center.exr >header
grep -Fq 'ldi.pixelFilter (type string): "blackman-harris:2"' header || fail "the filter: $(grep ldi header)"
exrheader fine/view_0.exr >header
grep -Fq 'ldi.supersample (type int): 2' header || fail "--supersample: $(grep ldi header)"
grep -Fq 'displayWindow (type box2i): (0 0) - (191 107)' header || fail "--supersample: $(grep displayWindow header)"
! exrheader by_hand/center.exr | grep 'ldi\.' >/dev/null || fail "a scene of twice the size has sub-pixels"
defocused fine.exr fine/center.exr fine/view_0.exr
exrheader fine.exr | grep -F 'displayWindow (type box2i): (0 0) - (95 53)' >/dev/null || fail "the picture of sub-pixels is not of the scene's size"
in_blender small.blend -P "$views" -- -o fine_over --samples 4 --views 0 --supersample 2 --overscan 3
exrheader fine_over/center.exr | grep -F 'dataWindow (type box2i): (-6 -6) - (197 113)' >/dev/null || fail "--supersample and --overscan"
if blender --python-exit-code 1 -b small.blend -P "$views" -- "${plain[@]}" -o few --samples 3 --supersample 2 >said 2>&1; then fail "3 samples for 4 pixels"; fi
grep -q 'error: --supersample 2: 3 samples a pixel are too few' said || fail "3 samples for 4 pixels: $(tail -n 3 said)"
# Adaptive sampling stops at twice the noise of a sub-pixel.
in_blender small.blend --python-expr "import bpy; bpy.context.scene.cycles.use_adaptive_sampling = True; bpy.context.scene.cycles.adaptive_threshold = 0.2
bpy.context.scene.cycles.adaptive_min_samples = 8; bpy.ops.wm.save_as_mainfile(filepath='$PWD/adaptive.blend')"
in_blender large.blend --python-expr "import bpy; bpy.context.scene.cycles.use_adaptive_sampling = True; bpy.context.scene.cycles.adaptive_threshold = 0.4
bpy.context.scene.cycles.adaptive_min_samples = 2; bpy.context.scene.cycles.filter_width = 1.5" -P "$views" -- "${plain[@]}" -o by_hand --samples 64 --views 0
in_blender adaptive.blend -P "$views" -- "${plain[@]}" -o adaptive --samples 256 --views 0 --supersample 2
alike adaptive/center.exr by_hand/center.exr 60

# --supersample auto, the default: what ldi-plan advises for the centre view.
in_blender small.blend -P "$views" -- "${plain[@]}" -o flat --samples 4 --views 0
for fstop in 0.5 8; do
    "$bin/ldi-plan" flat/center.exr --fstop $fstop -o plan.json >/dev/null
    wanted=$(python3 -c 'import json; plan = json.load(open("plan.json")); print("%.1f %% of the pixels are at edges of depth: supersample %d" % (100 * plan["edges"], plan["supersample"]))')
    in_blender small.blend --python-expr "import bpy; bpy.context.scene.camera.data.dof.aperture_fstop = $fstop" -P "$views" -- --overscan 0 -o auto$fstop --samples 4 --views 1
    grep -qxF "sparselens: frame 1: $wanted" said || fail "--supersample auto, not '$wanted': $(grep supersample said)"
done
# One number for a whole shot: what its first, middle or last frame needs.
in_blender small.blend --python-expr "import bpy
lens = bpy.context.scene.camera.data.dof
for frame, lens.aperture_fstop in ((1, 64), (3, 0.5)): lens.keyframe_insert('aperture_fstop', frame=frame)" -P "$views" -- "${plain[@]:0:2}" -o shot --samples 4 --views 0 --frames 1-3
[ "$(grep -c 'frame 1: .* supersample 1$' said)/$(grep -c 'frame 3: .* supersample 2$' said)" = 1/1 ] || fail "--supersample auto, a shot: $(cat said)"
for frame in 1 2 3; do exrheader shot/center.000$frame.exr | grep -F 'ldi.supersample (type int): 2' >/dev/null || fail "--supersample auto: frame $frame"; done
for view in center view_0; do exrheader auto0.5/$view.exr | grep -F 'ldi.supersample (type int): 2' >/dev/null || fail "--supersample auto: $view is of the picture's size"; done
! exrheader auto8/center.exr | grep -F 'ldi.supersample' >/dev/null || fail "--supersample auto: sub-pixels without edges"
in_blender small.blend -P "$views" -- -o few --samples 3 --views 0 --overscan 0
! exrheader few/center.exr | grep -F 'ldi.supersample' >/dev/null || fail "--supersample auto: 3 samples for 4 pixels"
echo "--supersample: the views of twice the size, where ldi-plan advises it"

# Eyes of a stereo scene, compared with Blender's own stereo render. The right eye has its own seed there: 36 dB; a
# wrong convergence gives 31 dB or less.
for kind in "${eyes[@]}"; do
    in_blender "pinhole,$kind.blend" -P "$views" -- "${plain[@]}" -o $kind --samples 128 --views 0
    in_blender "pinhole,$kind.blend" -P "$variants" -- render 128 1 1 "$PWD/own.####.exr"
    alike $kind/center_L.exr own.0001_L.exr 36
    alike $kind/center_R.exr own.0001_R.exr 36
    echo "$kind: both eyes as Blender's own"
done
in_blender pinhole,cameras.blend -P "$views" -- "${plain[@]}" -o right --samples 4 --eye right
[ "$(cd right && echo *)" = "$(echo center_R.exr view_{0..3}_R.exr)" ] || fail "--eye right wrote $(ls right)"

# All passes, Cryptomatte with its metadata too. The picture from them equals the one from colour and depth alone, with
# ldi-warp reporting that it takes Combined for the beauty.
in_blender passes.blend -P "$views" -- "${plain[@]}" -o layers --samples 4 --multilayer
in_blender passes.blend -P "$views" -- "${plain[@]}" -o plain --samples 4
for view in center view_0 view_1 view_2 view_3; do
    exrheader layers/$view.exr >header
    grep -Eq 'ViewLayer\.(DiffCol|Diffuse Color)\.R,' header || fail "--multilayer: no colour of diffuse in $view.exr" # since 5.0 by its name
    for what in "ViewLayer.Combined.R," "ViewLayer.Depth.Z," "ViewLayer.Normal.X," \
        "ViewLayer.CryptoObject00.r," cryptomatte/ sparselens:sensorWidth; do
        grep -Fq "$what" header || fail "--multilayer: no $what in $view.exr"
    done
    oiiotool layers/$view.exr --ch 'R=ViewLayer.Combined.R,G=ViewLayer.Combined.G,B=ViewLayer.Combined.B' -o combined.exr
    oiiotool plain/$view.exr --ch R,G,B -o beauty.exr
    alike combined.exr beauty.exr 90
done
"$bin/ldi-warp" -v layers/center.exr layers/view_*.exr -o layers.ldi.exr 2>said
grep -q 'beauty: ViewLayer.Combined.R' said || fail "multilayer: ldi-warp -v does not say that it takes Combined: $(cat said)"
"$bin/ldi-cluster" layers.ldi.exr -o - | "$bin/dof-gather" - -o layers.exr
defocused plain.exr plain/center.exr plain/view_*.exr
alike layers.exr plain.exr 90
echo "multilayer: the picture of single-layer views"

# --finish: two renders with Blender's own lens, with half of the samples each and independent noise. Their mean is as
# near to a render of twice the samples as that is to itself with another seed, and the headers describe the lens that
# dof-finish compares.
in_blender keys,blades.blend -P "$views" -- -o halves --supersample 1 --frame 3 --views 0 --samples 4 --finish 129
[ "$(cd halves && echo *)" = "center.exr rays_1.exr rays_2.exr" ] || fail "--finish wrote $(ls halves)"
for half in 1:65 2:64; do
    exrheader "halves/rays_${half%:*}.exr" >header
    grep -Eq "^cycles\..*samples \(type string\): \"${half#*:}\"" header || fail "--finish: samples: $(grep samples header)"
    grep -Fq 'aperture_blades (type int): 5' header || fail "--finish: $(grep blades header)"
done
in_blender keys,blades.blend -P "$variants" -- render 512 3 3 "$PWD/truth.####.exr"
alike halves/rays_1.exr truth.0003.exr 30
unlike halves/rays_1.exr halves/center.exr 28
oiiotool halves/rays_1.exr halves/rays_2.exr --add --mulc 0.5 -o mean.exr
better "$(decibels mean.exr truth.0003.exr)" "$(decibels halves/rays_1.exr truth.0003.exr)" 1.5 "--finish: two renders share noise"
in_blender keys,blades.blend -P "$views" -- -o halves --supersample 1 --frame 3 --samples 16
"$bin/ldi-warp" halves/center.exr halves/view_?.exr -o - | "$bin/dof-gather" - -o halves/gathered.exr
"$bin/dof-finish" halves/gathered.exr halves/rays_1.exr halves/rays_2.exr -o finished.exr -v 2>said
if grep warning said; then fail "--finish: dof-finish warns of the same lens"; fi
better "$(decibels finished.exr truth.0003.exr)" "$(decibels halves/gathered.exr truth.0003.exr)" 0 "--finish"
"$bin/ldi-warp" halves/center.exr halves/view_?.exr -o - | "$bin/dof-gather" - -o halves/round.exr --blades 0
"$bin/dof-finish" halves/round.exr halves/rays_1.exr halves/rays_2.exr -o finished.exr 2>said
grep -q 'rays_2.exr: another lens .*: 5 blades, not no blades' said || fail "--finish: blades: $(cat said)"
echo "--finish: two renders of Blender's own lens"

# Errors: a message on stderr, and an exit code that is not 0.
complains() {
    local code=$1 pattern=$2
    shift 2
    exits "$code" blender -b "$@"
    grep -Eq -e "$pattern" stderr || fail "'$pattern' is not in: $(cat stderr)"
}
complains 1 "has no camera" homeless.blend -P "$views" -- "${plain[@]}" -o none
complains 1 "not a perspective one" panorama.blend -P "$views" -- "${plain[@]}" -o none
complains 1 "no eye 'middle'.*right" pinhole,cameras.blend -P "$views" -- "${plain[@]}" -o none --eye middle
complains 1 "name it \(--eye\)" pinhole,cameras.blend -P "$views" -- "${plain[@]}" -o none --plan plan.json
complains 1 "No such file" small.blend -P "$views" -- "${plain[@]}" -o none --plan missing.json
complains 2 "usage: blender -b" small.blend -P "$views"
complains 2 "invalid frame range" small.blend -P "$views" -- "${plain[@]}" -o none --frames 1-
complains 2 "not allowed with" small.blend -P "$views" -- "${plain[@]}" -o none --frames 1-2 --frame 1
# Impossible renders: one line, before anything is rendered.
refused() { # KIND PATTERN
    complains 1 "^sparselens_views.py: error: .*$2" "$1.blend" -P "$views" -- "${plain[@]}" -o none --samples 1 --frame 6
    [ "$(grep -c 'sparselens_views.py\|Traceback' stderr)" -eq 1 ] || fail "$1: not one line: $(cat stderr)"
}
refused mesh "'Sphere', which is no camera but of type MESH: set a camera"
refused wide "has f-stop 0 at frame 6: set one above 0"
refused macro "has focus distance 0 at frame 6: set one above 0"
refused unlayered "no view layer of scene 'Scene' is used for rendering: switch one on"
complains 2 "two renders take two samples" small.blend -P "$views" -- -o none --finish 1
complains 1 "finishing: the scene's seed is animated" seeded.blend -P "$views" -- -o none --finish 4
complains 1 "finishing: only Cycles" eevee.blend -P "$views" -- -o none --finish 4
refused workbench "Workbench .*: choose Cycles or EEVEE"
if blender -b --python-expr 'import _cycles, sys; sys.exit(1 if _cycles.with_openimagedenoise else 0)' >said 2>&1; then
    refused denoised "denoising is on, but this Blender has no OpenImageDenoise: switch it off"
else
    echo "skipped: denoising without a denoiser: this Blender has one"
fi
[ -z "$(ls -A none 2>/dev/null)" ] || fail "an error left files: $(ls -A none)"
echo "errors: said, with their exit codes"

# Deviations from the scene's settings are reported once for all frames.
warned() { # KIND PATTERN
    exits 0 blender --python-exit-code 1 -b "$1.blend" -P "$views" -- "${plain[@]}" -o warned --samples 1 --views 1 --frames 1-2
    [ "$(grep -Ec "^sparselens_views.py: warning: .*$2" stderr)" -eq 1 ] || fail "$1: not one '$2': $(cat stderr)"
}
for kind in held_collection held_object held_material; do
    warned $kind "(collection 'held'|object 'Sphere') .*holdout.*render it and the rest apart.*docs/comp.md"
done
exits 0 blender --python-exit-code 1 -b unheld.blend -P "$views" -- "${plain[@]}" -o warned --samples 1 --views 0
if grep 'warning:' stderr; then fail "a holdout that is not rendered is warned of"; fi
warned pinhole,region 'the render region is not used.*dof-gather --region'
box=$(sed -nE 's/.*--region ([0-9,]+)$/\1/p' stderr)
# The pixels of that region equal Blender's own render of it; each has another seed, so 36 dB.
in_blender pinhole,region.blend -P "$views" -- "${plain[@]}" -o region --samples 128 --views 0
in_blender pinhole,region.blend -P "$variants" -- render 128 1 1 "$PWD/own.####.exr"
IFS=, read -r x0 y0 x1 y1 <<<"$box"
oiiotool region/center.exr --cut "$((x1 - x0 + 1))x$((y1 - y0 + 1))+$x0+$y0" --ch R,G,B -o cut.exr
oiiotool own.0001.exr --ch R,G,B --origin +0+0 --fullpixels -o own.exr
alike cut.exr own.exr 36
echo "holdouts and the render region: said"

# The add-on renders the same, and leaves the scene unchanged; so does installing.
in_blender marker.blend -P "$source_dir/tests/blender/addon.py" -- "$(dirname "$views")" "$PWD/addon"
grep -q 'Warning: the render region is not used' said || fail "the add-on does not say that the region is not used: $(tail -n 5 said)"
in_blender marker.blend -P "$views" -- -o marker --frame 3 --samples 2 --overscan 3
alike addon/center.exr marker/center.exr 90
alike addon/view_3.exr marker/view_3.exr 90
in_blender marker.blend -P "$source_dir/tests/blender/addon.py" -- "$(dirname "$views")" "$PWD/addon_auto" auto
in_blender marker.blend -P "$views" -- -o marker --frame 3 --samples 2 --overscan auto
alike addon_auto/center.exr marker/center.exr 90
echo "add-on: the same views, the scene unchanged"
if cmake --install "$bin/.." --prefix "$PWD/installed" >said 2>&1; then
    in_blender small.blend -P installed/share/sparselens/blender/sparselens_views.py -- -o installed/views --samples 1 --views 0
    [ -s installed/views/center.exr ] || fail "the installed script wrote nothing"
    echo "installed: the script runs"
else
    echo "skipped: installing, as $bin is not of a complete build ($(grep -m 1 cannot said || true))"
fi
