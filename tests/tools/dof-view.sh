#!/bin/bash
# dof-view: the answers and refusals to its pages, that they show the same as dof-gather writes with any options, and
# the page in a browser.
#   bash dof-view.sh BIN_DIR [--all]     without --all (tools.dof-view-all), fewer options, and no browser
. "$(dirname "$0")/check.sh"
answers_help dof-view ldi.exr
traced fence 160x90
traced fence 96x54 small
cp small/ldi.exr small.ldi.exr
helpers=$source_dir/tests/viewing
export PYTHONDONTWRITEBYTECODE=1
# says OPTIONS...: prints the lens facts that a page gets with these options.
says() { exits 0 python3 -c 'import sys; sys.path.insert(0, sys.argv[1]); from served import served
with served(*sys.argv[2:]) as server: print(server.picture(settings={})[0])' "$helpers" "$bin/dof-view" ldi.exr "$@"; }
exits 0 python3 "$helpers/protocol.py" "$bin" ldi.exr reference.exr small.ldi.exr "${@:2}"

# Another program may ask for pictures: tests/plugins has the tests of that.
exits 0 bash -c 'echo "{\"ask\":\"facts\",\"file\":\"ldi.exr\"}" | "$1" --pipe 3<>pixels' - "$bin/dof-view"
[ "$(grep -c '^200 0 {' stdout)" -eq 2 ] || fail "--pipe: not a greeting and an answer: $(cat stdout)"

# All options of dof-gather work. agree OPTIONS...: its picture will be compared, byte by byte, with dof-gather's with
# the same options, and so will that of the copied command. Always a set for each kind: the lens, its looks, files,
# moments of a shutter, the second with fewer samples, colour, windows, a holdout, and a sequence whose second frame has
# another size, other colours and sub-pixels.
pictures=()
agree() { pictures+=("${of:-small.ldi.exr}" "$@" ,); }
cp small.ldi.exr moment_0.exr
exits 0 "$bin/ldi-cluster" small.ldi.exr -o moment_1.exr --tolerance 2
exits 0 "$bin/dof-trace" grass --size 64x36 --spp 4 --supersample 2 --views 0 -o second
oiiotool second/center.exr --attrib:type=float[8] chromaticities 0.713,0.293,0.165,0.83,0.128,0.044,0.32168,0.33767 -o shot.0002.exr
cp small.ldi.exr shot.0001.exr
agree --fstop 0.5 --focus-distance 2.5 --quality final --channels R,G,B,A --device cpu
agree --blades 5 --blade-curvature 0.3 --blade-rotation 20 --squeeze 1.5 --spherical 0.5 --cat-eye 1 --cat-eye-darkening
agree --lens "$source_dir/share/lenses/hexagon.json" --highlight-gain 3 --highlight-threshold 0.5 --highlight-knee 0.5
of=moment_%s.exr agree --shutter-curve triangle --rolling-shutter 0.5
agree --output-colorspace sRGB --proxy 2
agree --overscan keep --region 10,5,50,35
agree --holdout small/center.exr --holdout-defocused
of=shot.####.exr agree --fstop 1:0.3,2:0.8 --blades 5 --cat-eye 1 --tilt -10,5
if [ "${2:-}" = --all ]; then
    agree
    agree --lens-radius 0.05 --focus-pixel 40,22 --quality draft --threads 1
    agree --focal-length 50 --sensor-width 40 --scene-unit 0.5 --lens-samples 50 --layer-tolerance 0.5
    agree --method selective --layers 3
    agree --axial-chromatic 1 --axial-chromatic-type blue-yellow --field-curvature 0.2 --breathing 1 --tilt -10,5 --astigmatism 0.3
    agree --aperture "$source_dir/share/lenses/mirror.exr"
    agree --colorconfig "$source_dir/share/ocio/config.ocio" --colorspace sRGB
    agree --supersample 2 --pixel-filter gaussian --unpremultiplied
    agree --data R,G,B --light R
    agree --display Rec.1886 --view-transform Raw
    oiiotool small/center.exr --ch R,G,B,A,Z --mulc 1,1,1,1,0.05 -o normalized.exr
    of=normalized.exr agree --depth normalized --depth-channel Z --near 0.1 --far 20
    of=normalized.exr agree --depth-file small/center.exr
    lens=(--focal-length 36 --sensor-width 36 --fstop 0.3 --focus-distance 5)
    for name in fg bg; do
        oiiotool small/center.exr --ch R,G,B,A,Z --chnames $name.Combined.R,$name.Combined.G,$name.Combined.B,$name.Combined.A,$name.Depth.Z -o $name.exr
    done
    oiiotool bg.exr fg.exr --chappend -o layers.exr
    of=layers.exr agree "${lens[@]}" --layer fg
    for name in left right; do
        oiiotool small/center.exr --ch R,G,B,A,Z --mulc 0.5,1,1,1,$([ $name = left ] && echo 1 || echo 2) \
            --sattrib oiio:subimagename rgba.$name --sattrib view $name -o $name.exr
    done
    oiiotool left.exr right.exr --siappendall -o stereo.exr
    of=stereo.exr agree "${lens[@]}" --stereo-view right
    of=shot.####.exr agree
    cp small/center.exr hold.0001.exr
    cp shot.0002.exr hold.0002.exr
    of=shot.####.exr agree --holdout hold.####.exr --holdout-defocused --quality final
fi
python3 "$helpers/agree.py" "$bin" "${pictures[@]}" 2>said || fail "$(tail -n 1 said)"

# The tool's own options.
says --port 0 -v
grep -q "'largest_coc'" stdout || fail "says $(cat stdout)"
says --frames 1-3 --fstop 1:2,3:4
grep -q "'fstop': 2.0" stdout || fail "--frames says $(cat stdout)"
says --reference reference.exr --save . --max-memory 1GB
says --plate reference.exr
mkdir path
printf '#!/bin/sh\ncat "$1" >opened\nstat -c %%a "$1" >>opened\nls -l /proc/self/fd >>opened\n' >path/xdg-open
chmod +x path/xdg-open
PATH=$PWD/path:$PATH says --open
grep -qE 'url=http://127.0.0.1:[0-9]+/\?key=[0-9a-f]{32}"' opened && grep -qx 600 opened || fail "--open: $(cat opened)"
! grep -q socket: opened || fail "--open: the browser keeps the port: $(cat opened)"
port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
says --port "$port"
fails_saying 1 'none.exr: cannot open' "$bin/dof-view" ldi.exr --reference none.exr
fails_saying 1 'none.exr: cannot open' "$bin/dof-view" ldi.exr --plate none.exr
fails_saying 1 'is not a folder' "$bin/dof-view" ldi.exr --save ldi.exr
fails_saying 1 'more than --max-memory allows' "$bin/dof-view" ldi.exr --max-memory 1KB
fails_saying 2 'port' "$bin/dof-view" ldi.exr --port 70000
fails_saying 2 'contains|excludes' "$bin/dof-view" ldi.exr --focus-pixel 1,1 --focus-distance 2

[ "${2:-}" = --all ] || exit 0

# Objects: 2.5e38 at depth 2 on the left, 1.5 at depths from 6 to 9 on the right.
names=R,G,B,A,Z,things00.R,things00.G,things00.B,things00.A
oiiotool --pattern constant:color=1,0,0,1,2,2.5e38,1,0,0 12x16 9 --chnames $names -d float -o near.exr
oiiotool near.exr --pattern fill:left=0,1,0,1,6,1.5,1,0,0:right=0,1,0,1,9,1.5,1,0,0 24x16 9 --chnames $names --paste +0+0 -d float \
    --attrib cryptomatte/ab12cd3/name things --attrib cryptomatte/ab12cd3/hash MurmurHash3_32 \
    --attrib cryptomatte/ab12cd3/conversion uint32_to_float32 \
    --evaloff --attrib cryptomatte/ab12cd3/manifest '{"near":"7f3c1440","far":"3fc00000"}' -o mattes.exr
python3 "$helpers/browser.py" "$bin" ldi.exr reference.exr mattes.exr ${SPARSELENS_SHOTS:+"$SPARSELENS_SHOTS"} || fail "the page in a browser"
echo "dof-view: fine"
