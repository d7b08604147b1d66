#!/bin/bash
# Do two builds make the same files? Renders small views of every test scene, makes LDIs of them in every mode and
# pictures by every method and look, and prints a line "HASH SCENE/NAME" for each file, sorted, so that diff can compare
# two builds.
#
#   tests/scripts/same-bytes.sh BIN_DIR               prints the list
#   tests/scripts/same-bytes.sh BIN_DIR OTHER_BIN_DIR prints what differs, and fails if anything does
#
# Whole files are hashed, including the header: none holds a date, and command lines are not recorded. camera.json is
# left out, because it has render times. The list does not depend on the number of threads. If Vulkan finds a device,
# even a software one, it makes some files too. Takes a minute per build on two cores, and needs the laboratory
# (dof-trace).
set -euo pipefail
export SPARSELENS_NO_HISTORY=1 LC_ALL=C
unset OCIO SPARSELENS_DEVICE
here=$(realpath "${BASH_SOURCE[0]}")
source_dir=$(cd "$(dirname "$here")/../.." && pwd)
size=96x54

# Each line is an LDI or a picture, and serves as its name.
ldis='
--merge keep
--silhouettes whole
--agreement assume
--optical off
'
pictures='
--method selective
--method selective --layers 2
--quality draft
--quality final
--lens-samples 40
--layer-tolerance 0
--fstop inf
--focus-distance 2
--focus-pixel 48,27
--supersample 2
--supersample 2 --pixel-filter blackman-harris
--proxy 2
--region 30,10,60,40
--overscan keep
--overscan crop
--show coc
--show focus
--show layers
--show tiles
--highlight-gain 10
--highlight-gain 10 --highlight-threshold .5 --highlight-knee .2
--blades 5
--blades 6 --blade-curvature .5
--blades 7 --blade-rotation 20
--squeeze 2
--spherical .6
--spherical -.6
--cat-eye .7
--cat-eye .7 --cat-eye-darkening
--axial-chromatic .4
--axial-chromatic .4 --axial-chromatic-type blue-yellow
--axial-chromatic .4 --axial-chromatic-type green-magenta
--field-curvature .5
--astigmatism .5
--breathing 1
--tilt 5,3
--aperture lenses/mirror.exr
--lens lenses/anamorphic-2x.json
--lens lenses/petzval.json
'

# each LINES COMMAND...: runs the command for each line, with its name and its words as arguments.
each() {
    local line
    while read -r line; do
        [ -z "$line" ] || "${@:2}" "$(tr ' /' _ <<<"$line")" $line
    done <<<"$1"
}
ldi() { "$bin/ldi-warp" views/center.exr views/view_*.exr -o "ldi$1.exr" "${@:2}"; }
picture() { "$bin/dof-gather" "$1" -o "$2.exr" "${@:3}"; }
on_device() { # METHOD...
    ldi _device --device "$device"
    for method; do picture ldi.exr "device_$method" --method "$method" --device "$device"; done
}

# All files of a scene, in a folder with its name. The tools' messages are kept too.
scene() {
    mkdir "$1"
    cd "$1"
    exec >said 2>&1
    ln -s "$source_dir/share/lenses" lenses
    "$bin/dof-trace" "$1" --size $size --spp 4 --reference 8 --deep visible -o views
    ldi ''
    each "$ldis" ldi
    picture ldi.exr picture
    for way in --merge_keep --silhouettes_whole --optical_off; do picture "ldi$way.exr" "of$way"; done
    picture views/center.exr of_one_view
    picture views/deep_visible.exr of_deep
    picture ldi.exr holdout --holdout views/deep_visible.exr
    picture ldi.exr holdout_defocused --holdout views/deep_visible.exr --holdout-defocused
    each "$pictures" picture ldi.exr
    picture ldi.exr scatter --method scatter --proxy 2 # takes minutes if the blur is large
    "$bin/dof-accumulate" views/view_*.exr --center views/center.exr -o average.exr
    "$bin/ldi-cluster" ldi.exr -o clustered.exr
    "$bin/ldi-plan" views/center.exr -o plan.json --masks masks
    [ -z "$device" ] || on_device lens selective
}

# made BIN_DIR: the list of the files that its tools make, or an error.
made() (
    bin=$(cd "$1" && pwd)
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT
    cd "$folder"
    # The device's name, without the part in brackets.
    device=$({ "$bin/dof-gather" --device list 2>/dev/null || true; } | sed -n '1s/ (.*//p')
    export bin device
    "$bin/dof-trace" --help | sed -nE 's/^ *SCENE :\{(.*)\}.*/\1/p' | tr , '\n' |
        xargs -P "$(nproc)" -I {} bash -c 'bash "$0" --scene "$1" || { echo "$1:"; tail -n 3 "$1/said"; exit 1; } >&2' "$here" {}
    find . -type f ! -name camera.json -printf '%P\n' | sort | xargs -d '\n' sha256sum | sed -E 's/^(.{16})\S*  /\1 /'
)

if [ "${1-}" = --scene ]; then # called by made
    scene "$2"
elif [ $# -eq 1 ]; then
    made "$1"
elif [ $# -eq 2 ]; then
    lists=$(mktemp -d)
    trap 'rm -rf "$lists"' EXIT
    made "$1" >"$lists/1"
    made "$2" >"$lists/2"
    diff "$lists/1" "$lists/2"
else
    echo "usage: same-bytes.sh BIN_DIR [OTHER_BIN_DIR]" >&2
    exit 2
fi
