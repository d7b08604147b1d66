#!/bin/bash
# The whole chain on one scene: installs and builds what is missing, traces five pinhole views of "fence" and
# their ray-traced reference, makes the defocused picture from the views, measures it against the reference,
# and writes pictures into demo/. The table, and what to look at, go to stdout at the end, all else to stderr.
#
#   tools/demo.sh [--size WxH] [--spp N] [--reference N] [--bin DIR] [-o DIR]
#
# --bin takes executables that are built already; -o names another folder than demo/. Scenes that the same dof-trace
# traced earlier with the same arguments are reused.
set -euo pipefail
export LC_ALL=C
unset OCIO # oiiotool converts pictures for the screen with its built-in sRGB
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
size=640x360 spp=16 reference_spp=1024 bin='' out=$here/demo
while [ $# -gt 0 ]; do
    [ $# -gt 1 ] || { echo "demo: $1 lacks its value, or is unknown" >&2; exit 2; }
    case $1 in
    --size) size=$2 ;;
    --spp) spp=$2 ;;
    --reference) reference_spp=$2 ;;
    --bin) bin=$2 ;;
    -o) out=$2 ;;
    *) echo "demo: unknown option $1" >&2; exit 2 ;;
    esac
    shift 2
done

build() {
    "$here/tools/install-deps.sh" build demo
    # In a build folder with tests they stay on: turning them off would discard their objects.
    local tests=()
    [ -e "$here/build/build.ninja" ] || tests=(-DSPARSELENS_TESTS=OFF -DSPARSELENS_BENCHMARKS=OFF)
    cmake --preset release -S "$here" --log-level=WARNING -DSPARSELENS_LAB=ON "${tests[@]}"
    cmake --build "$here/build" --target tools/all dof-trace -j "$(nproc)"
}

table=()
row() { table+=("$(printf '%-36s %8s %8s %7s  %s' "$1" "${@:2:4}" | sed 's/ *$//')"); }

# timed COMMAND...: stores the wall time in $seconds.
timed() {
    local start=${EPOCHREALTIME/./}
    "$@"
    seconds=$(printf '%.2f' "$((${EPOCHREALTIME/./} - start))e-6")
}

# traced FOLDER ARGUMENT...: runs dof-trace into that folder, unless the folder holds its unchanged result. The stamp
# holds the program's checksum and arguments, the time it took, and the checksums of its output.
traced() {
    local folder=$out/$1 stamp=$out/$1/traced.txt job
    shift
    job="$(sha256sum <"$bin/dof-trace") $*"
    mkdir -p "$folder"
    if [ -e "$stamp" ] && [ "$(sed -n 1p "$stamp")" = "$job" ] &&
        (cd "$folder" && sed 1,2d traced.txt | sha256sum --check --status); then
        seconds=$(sed -n 2p "$stamp") note='taken from an earlier run'
        return
    fi
    rm -f "$stamp"
    timed "$bin/dof-trace" "$@" -o "$folder"
    note=''
    (cd "$folder" && { echo "$job"; echo "$seconds"; sha256sum ./*.exr; } >traced.part && mv traced.part traced.txt)
}

# figure NAME JSON: the first value with that name, which describes the whole picture.
figure() { grep -o "\"$1\": *[^,} ]*" <<<"$2" | sed -n '1{s/.*: *//;s/null/inf/;p}'; }

# compared TITLE SECONDS PICTURE: prints a row with the picture's error.
compared() {
    local json
    json=$("$bin/dof-compare" "$3" "$reference" --json)
    row "$1" "$2" "$(printf '%.2f' "$(figure psnr_tonemapped "$json")")" "$(printf %.4f "$(figure ssim "$json")")"
}

for_screen=(--ch R,G,B --colorconvert linear sRGB --clamp:min=0:max=1)
to_png() { oiiotool "$1.exr" "${for_screen[@]}" -d uint8 -o "$1.png"; }

# The font's path, because OpenImageIO finds fonts by name up to 2.4 only. If oiiotool cannot draw titles, they are left
# out.
font=$(find /usr/share/fonts -name DejaVuSans.ttf -print -quit 2>/dev/null || true)
writes_titles() {
    local code=0
    oiiotool --create 32x32 3 "--text:x=2:y=20:size=12:font=$font" a -d uint8 -o "$out/title.png" >/dev/null 2>&1 || code=1
    rm -f "$out/title.png"
    return $code
}

# strip FILE WIDTH: before, after and reference side by side, each WIDTH wide; below them one detail of each.
strip() {
    local width=${size%x*} height=${size#*x} pictures=() details=() i
    local panel=$2x$(($2 * height / width))
    local detail=$((width * 3 / 16))x$((height * 3 / 16))+$((width * 51 / 100))+$((height * 23 / 100))
    local files=("$center" "$result" "$reference")
    local titles=('before: the centre view' 'after: from 5 views' "reference: $reference_spp rays a pixel")
    for i in 0 1 2; do
        pictures+=("${files[i]}" "${for_screen[@]}" --resize "$panel")
        [ -n "$no_titles" ] || pictures+=(--fill:color=0.1,0.1,0.1 "$2x20+0+0" "--text:x=6:y=14:size=12:font=$font" "${titles[i]}")
        details+=("${files[i]}" "${for_screen[@]}" --cut "$detail" --resize:filter=box "$panel")
    done
    oiiotool "${pictures[@]}" "${details[@]}" --mosaic:pad=4 3x2 -d uint8 -o "$1"
}

# The chain as a pipe, as users write it. It must give the same result as the separate stages.
piped() {
    "$bin/ldi-warp" "$center" "${rim[@]}" -o - | "$bin/ldi-cluster" - -o - |
        "$bin/dof-gather" - --method "${methods[0]}" -o "$out/piped.exr"
}

# Makes the picture with the Python module of the build; if it cannot run, says what is missing.
in_python() {
    local folder python
    folder=$(dirname "$bin")
    python=$(sed -n 's/^_Python_EXECUTABLE:INTERNAL=//p' "$folder/CMakeCache.txt" 2>/dev/null || true)
    if ! compgen -G "$folder/python/sparselens/_sparselens.*" >/dev/null; then # a configured folder has the rest
        note='left out: the module was not built (packages pybind11-dev, python3-dev; target sparselens_python)'
    elif ! "${python:=python3}" -c 'import numpy' 2>/dev/null; then
        note="left out: $python lacks numpy (package python3-numpy)"
    else
        timed env PYTHONPATH="$folder/python" "$python" -c '
import sys
import sparselens
sparselens.write(sys.argv[2], sparselens.gather(sparselens.open_ldi(sys.argv[1])))' "$out/ldi.exr" "$out/python.exr"
        note=''
        same_picture "$out/python.exr" 'Python gives'
    fi
}

same_picture() {
    oiiotool --fail 0 --diff "$1" "$result" >/dev/null || { echo "demo: $2 another picture than the tools"; exit 1; }
}

[ -n "$bin" ] || { build >&2; bin=$here/build/bin; }
[ -x "$bin/dof-trace" ] || { echo "demo: needs dof-trace, so configure with -DSPARSELENS_LAB=ON (package libembree-dev)" >&2; exit 1; }
exec </dev/null 3>&1 1>&2 # tools write messages to stderr; file descriptor 3 is for the table
mkdir -p "$out"
methods=(lens selective) # of dof-gather; the first one's picture is shown
center=$out/views/center.exr reference=$out/reference/reference.exr result=$out/${methods[0]}.exr

row "fence $size" seconds 'PSNR dB' SSIM
traced reference fence --size "$size" --views 0 --spp 1 --reference "$reference_spp"
reference_row=("reference, $reference_spp rays a pixel" "$seconds" '' '' "$note")
traced views fence --size "$size" --views 4 --spp "$spp"
row "5 pinhole views, $spp rays a pixel" "$seconds" '' '' "$note"
rim=("$out"/views/view_[0-3].exr)
compared '  the centre view as it is' '' "$center"

timed "$bin/ldi-warp" "$center" "${rim[@]}" -o "$out/warped.exr"
row ldi-warp "$seconds"
timed "$bin/ldi-cluster" "$out/warped.exr" -o "$out/ldi.exr"
row ldi-cluster "$seconds"
for method in "${methods[@]}"; do
    timed "$bin/dof-gather" "$out/ldi.exr" --method "$method" -o "$out/$method.exr"
    compared "dof-gather --method $method" "$seconds" "$out/$method.exr"
    timed "$bin/dof-gather" "$center" --method "$method" -o "$out/center-$method.exr"
    compared "  the same, of the centre view alone" "$seconds" "$out/center-$method.exr"
done
timed piped
same_picture "$out/piped.exr" 'pipes give'
row 'warp | cluster | gather, as one pipe' "$seconds"
seconds=''
in_python
row 'import sparselens, gather in Python' "$seconds" '' '' "$note"
row "${reference_row[@]}"

for picture in "$center" "$reference" "${methods[@]/#/$out/}"; do to_png "${picture%.exr}"; done
no_titles=
writes_titles || no_titles='; without titles, as oiiotool finds no font (package fonts-dejavu-core)'
strip "$out/fence.png" 480
strip "$out/fence-small.png" 240

printf '%s\n' "${table[@]}" >&3

# Says what to look at and how to continue. Paths are quoted for a shell.
cat >&3 <<END

Look at these pictures (PNG for the screen, EXR for everything else):
  $out/fence.png  before, after and the reference, with details$no_titles
  $result  the best picture (${result%.exr}.png)
  $center  the centre view that it was made from (${center%.exr}.png)
  $reference  the reference (${reference%.exr}.png)

The best one was made by
  $(printf '%q ' "$bin/dof-gather" "$out/ldi.exr" --method "${methods[0]}" -o "$result")
Go on with another focus, for example on the fence:
  $(printf '%q ' "$bin/dof-gather" "$out/ldi.exr" --focus-distance 2.2 -o "$out/on-the-fence.png")
END
[ ! -x "$bin/dof-view" ] || cat >&3 <<END
Or point at what is to be sharp, in a browser:
  $(printf '%q ' "$bin/dof-view" "$out/ldi.exr" --reference "$reference")
END
