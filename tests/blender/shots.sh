#!/bin/bash
# The day-to-day shots of ../shared/shots, 96x54: pictures of --picture by its defaults, beside Cycles' own lens. A
# minute.
#   bash shots.sh BIN_DIR
. "$(dirname "$0")/common.sh"
shots=$source_dir/../shared/shots
[ -s "$shots/make.py" ] || skip "../shared/shots is not there"
in_blender --factory-startup -P "$shots/make.py" -- "$PWD/base.blend"

# Cameras, pixels, apertures, films and eyes; pictures that a warning belongs to; scenes that are refused.
good=(static keyed rig shift aspect2 pct unit blades blades5 ratio transp transpfg nosuz onlysuz crypto stereo)
warned=(border:'the render region is not used' bordercrop:'the render region is not used' mb:'motion blur is on'
    holdout:"collection 'hold' is a holdout" layers:'the scene renders 2 view layers')
refused=(ortho:"not a perspective one" pano:"not a perspective one")
in_blender base.blend -P "$source_dir/tests/blender/shots.py" -- "$(dirname "$views")" "$shots/variants" "$PWD" "$bin" \
    "${good[@]}" "${warned[@]%%:*}" "${refused[@]%%:*}"

# nearer PICTURE TRUTH OTHER BY: PICTURE is nearer to TRUTH than OTHER by as many dB. All have the same noise.
nearer() {
    echo "${1%.exr}: $(decibels "$1" "$2") dB, and $(decibels "$3" "$2") of $3"
    better "$(decibels "$1" "$2")" "$(decibels "$3" "$2")" "$4" "$1 and $3"
}
gathered() { # FILE OUT OPTION...
    "$bin/dof-gather" "$1" -o "$2" --overscan crop "${@:3}" 2>log || fail "$(cat log)"
}
for name in "${good[@]}" "${warned[@]%%:*}"; do
    grep -qx 'exit code 0' "$name.said" || fail "$name: $(cat "$name.said")"
done
# Depth of field takes away at least half of what a pinhole's picture lacks: 2.5 dB of 3, beside the noise.
for name in static keyed rig shift aspect2 pct unit blades blades5 ratio transp transpfg nosuz onlysuz crypto mb; do
    gathered $name/center.exr $name.pinhole.exr --fstop inf
    nearer $name.exr $name.true.exr $name.pinhole.exr 2.5
done
# A camera that stands elsewhere, or an aperture that is round, shows.
for name in keyed rig shift; do nearer $name.exr $name.true.exr static.exr 4; done
for name in blades5 ratio; do
    gathered $name/ldi.exr $name.round.exr --blades 0 --squeeze 1
    nearer $name.exr $name.true.exr $name.round.exr 2
done
nearer stereo_L.exr stereo.true_L.exr stereo_R.exr 4
nearer stereo_R.exr stereo.true_R.exr stereo_L.exr 4
for said in "${warned[@]}"; do
    grep -q "warning: ${said#*:}" "${said%%:*}.said" || fail "${said%%:*}: $(cat "${said%%:*}.said")"
done
for said in "${refused[@]}"; do
    name=${said%%:*}
    grep -q "error: .*${said#*:}" "$name.said" || fail "$name: $(cat "$name.said")"
    grep -qx 'exit code 1' "$name.said" || fail "$name: $(cat "$name.said")"
    [ -z "$(ls -A "$name" 2>/dev/null)" ] && [ ! -e "$name.exr" ] || fail "$name left files"
done
echo "shots: as Cycles' own lens, warned of, or refused"
