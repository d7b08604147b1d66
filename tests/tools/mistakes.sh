#!/bin/bash
# Common mistakes with views, tested on views of the ray tracer: each gives a warning that says what to do, and correct
# views give none.
. "$(dirname "$0")/check.sh"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
warp=$bin/ldi-warp gather=$bin/dof-gather
unset OCIO
silent() { [ ! -s stderr ] || fail "complained of: $* ($(cat stderr))"; }
says_once() { # PATTERN WHAT
    [ "$(grep -Ec -e "$1" stderr)" = 1 ] || fail "$2: $(cat stderr)"
}
exits 0 "$bin/dof-trace" fence --size 640x360 --spp 4 --views 4 --reference 16 -o views
center=views/center.exr rim=(views/view_?.exr)
exits 0 "$warp" $center "${rim[@]}" -o x.exr
silent "good views"
# Good drafts give no warning either, though thin things and edges have few pixels there.
for draft in 'fence 48x27' 'fair 48x27' 'plane-mirror 48x27' 'glass-slab 96x54' 'macro 96x54'; do
    read -r scene size <<<"$draft"
    exits 0 "$bin/dof-trace" "$scene" --size "$size" --views 4 --spp 4 -o draft
    exits 0 "$warp" draft/center.exr draft/view_?.exr -o x.exr
    silent "good views of $scene, $size"
done
exits 0 "$gather" $center -o x.exr --quality draft
silent "a good view"
exits 0 "$bin/ldi-plan" $center -o plan.json
silent "ldi-plan of a good view"

# met PATTERN FILE [OPTIONS...]: all tools that start from a picture give the warning.
met() {
    exits 0 "$warp" "${@:2}" -o x.exr
    says_once "^ldi-warp: warning: $2: $1" "ldi-warp"
    exits 0 "$gather" "${@:2}" -o x.exr --quality draft
    says_once "^dof-gather: warning: $2: $1" "dof-gather"
    exits 0 "$bin/ldi-plan" "${@:2}" -o plan.json
    says_once "^ldi-plan: warning: $2: $1" "ldi-plan"
    [ "$(grep -c 'warning: ' stderr)" = 1 ] || fail "ldi-plan warns of more than one mistake: $(cat stderr)"
}
# Replaces the colours, or the depth, by those of another file.
colours_of() { oiiotool $center --ch Z "$1" --ch R,G,B,A --chappend --ch R,G,B,A,Z -d half -d Z=float -o "$2"; }
depth_of() { oiiotool $center --ch R,G,B,A "$1" --chappend -d half -d Z=float -o "$2"; }

# Depth of field rendered into the view, with the tracer's lens.
colours_of views/reference.exr defocused.exr
met 'its edges out of focus are blurred.*switch depth of field off' defocused.exr

# Colours encoded for a display; --colorspace corrects them.
oiiotool $center --ch R,G,B,A --colorconvert linear sRGB -o coded.exr
colours_of coded.exr srgb.exr
met 'its colours mix at edges as sRGB codes do.*--colorspace sRGB' srgb.exr
exits 0 "$warp" srgb.exr -o x.exr --colorspace sRGB
silent "--colorspace sRGB"

# Depth as 1 / z, or from a depth buffer; the right option corrects it.
oiiotool $center --ch Z -o z.exr
oiiotool --pattern constant:color=1 640x360 1 z.exr --div --chnames Z -d float -o inverse.z.exr
depth_of inverse.z.exr inverse.exr
met 'its depths are linear in 1 / z.*--depth inverse .*--depth hyperbolic with --near and --far' inverse.exr
exits 0 "$warp" inverse.exr -o x.exr --depth inverse
silent "--depth inverse"
oiiotool inverse.z.exr --mulc -2.2222222 --addc 1.1111111 --chnames Z -d float -o hyperbolic.z.exr # planes at 2 and 20
depth_of hyperbolic.z.exr hyperbolic.exr
met 'its depths are linear in 1 / z' hyperbolic.exr
exits 0 "$warp" hyperbolic.exr -o x.exr --depth hyperbolic --near 2 --far 20
silent "--depth hyperbolic"
exits 0 "$gather" hyperbolic.exr -o x.exr --lens-radius 0 --depth-out z.hyperbolic.exr --depth hyperbolic --near 2 --far 20
picture same z.exr z.hyperbolic.exr Z 1e-3 || fail "--depth hyperbolic: another depth"

# Depth from 0 to 1 with white near.
oiiotool z.exr --mulc -0.01001001 --addc 1.001001 --clamp:min=0:max=1 --chnames Z -d float -o white.z.exr # planes at 0.1 and 100
depth_of white.z.exr white.exr
met 'its depths lie from 0 to 1 and seem to be white near.*--depth normalized with --near, .* and --far' white.exr
exits 0 "$warp" white.exr -o x.exr --depth normalized --near 100 --far 0.1
silent "--depth normalized of white near"
exits 0 "$gather" white.exr -o x.exr --lens-radius 0 --depth-out z.white.exr --depth normalized --near 100 --far 0.1
picture same z.exr z.white.exr Z 1e-3 || fail "--depth normalized of white near: another depth"

# Depth averaged over edges, like colours.
exits 0 "$bin/dof-trace" fence --size 1280x720 --spp 1 --views 0 -o large
oiiotool large/center.exr --ch R,G,B,A,Z --resize:filter=box 640x360 --fullsize 640x360+0+0 -d half -d Z=float -o averaged.exr
met 'its depth is averaged over edges.*without a filter' averaged.exr

# Unpremultiplied colours.
exits 0 "$bin/dof-trace" element --size 320x180 --spp 8 --views 0 -o element
exits 0 "$warp" element/center.exr -o x.exr
silent "an element"
oiiotool element/center.exr --ch R,G,B,A --unpremult element/center.exr --ch Z --chappend -d half -d Z=float -o straight.exr
met 'its edges stay as bright as the surfaces where A falls.*--unpremultiplied' straight.exr
exits 0 "$warp" straight.exr -o x.exr --unpremultiplied
silent "--unpremultiplied"

# Centimetres taken for metres: the lens is 100 times too small.
picture edit $center centimetres.exr 'erase=sparselens:metresPerUnit'
lens=(--focal-length 36 --sensor-width 36 --fstop 30 --focus-distance 5)
met 'the largest circle of confusion is 0\.[0-9]* pixels.*--scene-unit 0.01' centimetres.exr "${lens[@]}"
exits 0 "$gather" centimetres.exr "${lens[@]}" --scene-unit 0.01 -o x.exr
silent "--scene-unit"
exits 0 "$gather" $center --lens-radius 0 -o x.exr
silent "a pinhole"

# Positions of views in millimetres, for a scene unit of a centimetre, a decimetre and a metre; no other warning is
# given.
for factor in 10 100 1000; do
    far=$(awk "BEGIN { print 0.06 * $factor }")
    exits 0 "$warp" $center --view $far,0 views/view_0.exr --view 0,$far views/view_1.exr -o x.exr
    says_once "warning: views/view_0.exr and 1 more: stands $far from the centre, $factor times the radius of the lens, 0.06: in millimetres\?" \
        "millimetres"
    [ "$(wc -l <stderr)" = 1 ] || fail "said more: $(cat stderr)"
done
# The same view twice.
exits 0 "$warp" $center "${rim[@]}" views/view_2.exr -o x.exr
says_once 'warning: views/view_2.exr: is the same picture as views/view_2.exr, from the same place' "a view twice"
