#!/bin/bash
# Common mistakes in Blender, and the messages of the script and the tools about them. A few minutes.
#   bash mistakes.sh BIN_DIR
. "$(dirname "$0")/common.sh"
# shellcheck disable=SC2046
in_blender -P "$source_dir/tests/blender/words.py" -- "$(dirname "$views")" $("$bin/dof-gather" --help | sed -nE 's/^  (-., ?)?--([a-z-]+).*/\2/p')
echo "the panel's messages: name its fields"

in_blender -P "$scene" -- CYCLES 96x54 save "$PWD/small.blend"
same() { picture same "$1" "$2" >found 2>&1 || fail "$3 ($(cat found))"; }

# Two view layers: a file that holds one of them says which; from a file that holds both, the tools take the named one,
# with its own depth and mattes.
variant small layers
in_blender layers.blend -P "$views" -- "${plain[@]}" -o both --samples 4 --views 2 --multilayer
in_blender layers.blend -P "$views" -- "${plain[@]}" -o either --samples 4 --views 0
grep -q "warning: the scene renders 2 view layers, back, front, of which the files hold 'back' alone" said || fail "layers: $(cat said)"
fails_saying 2 'both/center.exr: holds several pictures, back.Combined and front.Combined: give --layer' \
    "$bin/ldi-warp" both/center.exr both/view_0.exr both/view_1.exr -o x.exr
for layer in back front; do
    in_blender layers.blend -P "$views" -- "${plain[@]}" -o $layer --samples 4 --views 2 --layer $layer
    in_blender layers.blend -P "$views" -- "${plain[@]}" -o all_of_$layer --samples 4 --views 0 --layer $layer --multilayer
    if grep -q warning said; then fail "--layer $layer: $(cat said)"; fi
    exits 0 "$bin/ldi-warp" --layer $layer both/center.exr both/view_0.exr both/view_1.exr -o both.ldi.exr
    exits 0 "$bin/ldi-warp" $layer/center.exr $layer/view_0.exr $layer/view_1.exr -o one.ldi.exr
    for file in both one; do exits 0 "$bin/dof-gather" $file.ldi.exr --channels rgba -o $file.exr; done
    same both.exr one.exr "--layer $layer of a file of two, and the layer alone"
    exits 0 "$bin/dof-gather" both.ldi.exr --channels $layer.CryptoObject -o matte.exr
    exits 0 "$bin/dof-gather" all_of_$layer/center.exr -o x.exr
done
picture differ back/center.exr front/center.exr || fail "two view layers are one picture"
same either/center.exr back/center.exr "what is written without --layer"
exits 1 blender -b layers.blend -P "$views" -- "${plain[@]}" -o none --layer hero
grep -q "no view layer 'hero'; it has: back, front" stderr || fail "--layer hero: $(cat stderr)"
echo "two view layers: each by its own depth"

# A view rendered by hand with depth of field is noticed; one without it, and the script's views, are not.
in_blender -P "$scene" -- CYCLES 480x270 save "$PWD/large.blend"
variant large pinhole
lens=(--focal-length 50 --sensor-width 36 --fstop 0.5 --focus-distance 4)
for kind in large pinhole; do
    in_blender $kind.blend -P "$variants" -- render_depth 16 1 1 "$PWD/$kind.####.exr"
    exits 0 "$bin/ldi-warp" $kind.0001.exr "${lens[@]}" -o x.exr
    mv stderr $kind.said
done
grep -q 'warning: large.0001.exr: its edges out of focus are blurred.*switch depth of field off' large.said || fail "depth of field: $(cat large.said)"
if grep -v 'render more overscan' pinhole.said; then fail "a pinhole"; fi
echo "depth of field that is on: said"

# Cameras aimed at the focus, like the eyes of a stereo pair with toe-in.
variant large toe_rim,pinhole
in_blender toe_rim,pinhole.blend -P "$views" -- "${plain[@]}" -o toe --samples 8 --views 0
exits 1 "$bin/ldi-warp" toe/center_L.exr toe/center_R.exr -o x.exr
grep -q 'center_R.exr: .*turned' stderr || fail "a turned view by its matrix: $(cat stderr)"
exits 0 "$bin/ldi-warp" toe/center_L.exr --view 0.05,0 toe/center_R.exr -o x.exr
grep -q 'warning: toe/center_R.exr: disagrees .* if it were turned by .* render all views with parallel axes' stderr || fail "a turned view: $(cat stderr)"
echo "turned views: said"
