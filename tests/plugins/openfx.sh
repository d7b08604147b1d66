#!/bin/bash
# The effect for OpenFX in a small host: its pictures equal dof-gather's in every context, format, scale and tiling, what is
# wrong is told in words, and a killed gatherer neither ends the host nor fails a render.
#   bash openfx.sh BIN_DIR FILE.ofx
. "$(dirname "$0")/../tools/check.sh"
effect=$(realpath "$2")
export PATH=$bin:$PATH
host() { exits 0 timeout 300 "$bin/sparselens-ofx-host" "$effect" "$@"; }
rendered() { # CONTEXT OUT WORD...: the effect renders without an error
    host render "$@"
    [ "$(cat stdout)" = "status 0" ] || fail "$*: $(cat stdout)"
}
refused() { # TEXT CONTEXT WORD...: it fails and says that
    local text=$1 context=$2
    shift 2
    host render "$context" refused.exr "$@"
    grep -qx 'status 1' stdout || fail "$*: $(cat stdout)"
    grep -qE "$text" stdout || fail "$* says $(cat stdout)"
}
same() { picture same "$@" >found 2>&1 || fail "$1 and $2 differ ($(cat found))"; }

# The effect links nothing but the C and C++ libraries, and exports what OpenFX asks for.
readelf -d "$effect" | sed -nE 's/.*\(NEEDED\).*\[(.*)\]/\1/p' |
    grep -vE '^(libstdc\+\+|libgcc_s|libc|libm|libasan|libubsan|libtsan)\.so|^ld-linux' >found && fail "it links $(xargs <found)"
nm -D --defined-only "$effect" | grep -vE ' (OfxGetNumberOfPlugins|OfxGetPlugin)$' >found && fail "it exports $(xargs <found)"

# A description starts nothing. The parameters are those of the table.
mkdir spy
cat >spy/dof-view <<END
#!/bin/bash
touch $scratch/started
exec "$bin/dof-view" "\$@"
END
chmod +x spy/dof-view
SPARSELENS_BIN=$scratch/spy host describe
[ ! -e started ] || fail "a description starts dof-view"
[ "$(grep -c '^context' stdout)" -eq 3 ] || fail "contexts: $(grep ^context stdout)"
for line in 'context OfxImageEffectContextGenerator: Output' 'context OfxImageEffectContextFilter: Depth Output Source' \
    '  focus_distance OfxParamTypeDouble keyed' '  quality OfxParamTypeChoice' '  blades OfxParamTypeInteger keyed' \
    '  tilt_x OfxParamTypeDouble keyed' '  cat_eye_darkening OfxParamTypeBoolean' '  lens OfxParamTypeString' '  ldi OfxParamTypeString'; do
    grep -qxF "$line" stdout || fail "no line '$line' in: $(cat stdout)"
done

# A surface before another one, partly transparent, with a deep file and its lens.
picture make flat.exr 64x36 R=noise:1 G=noise:2 B=noise:3 A=1 Z=3 fill=24x16+12+8 R*=0.5 Z=1.5 fill=16x12+40+20 R*=0.5 G*=0.5 B*=0.5 A=0.5 all= half=R,G,B,A
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.05 --focus-distance 2)
exits 0 ldi-warp flat.exr "${lens[@]}" -o shot.ldi.exr
gathered() { exits 0 dof-gather "${@:2}" -o "$1" -d float --channels rgba; } # OUT IN OPTIONS...
gathered as-rendered.exr shot.ldi.exr
gathered expected.exr shot.ldi.exr --focus-distance 3 --fstop 0.7 --blades 5 --quality draft --tilt 3,-4 --cat-eye 1 --cat-eye-darkening
picture differ as-rendered.exr expected.exr >/dev/null || fail "the settings change nothing"
words=(ldi=shot.ldi.exr focus_distance=3 fstop=0.7 blades=5 quality=draft tilt_x=3 tilt_y=-4 cat_eye=1 cat_eye_darkening=1)
picture make grey.exr 64x36 R=0.5 G=0.5 B=0.5 A=1
picture make z.exr 64x36 Z=2
SPARSELENS_BIN=$scratch/spy rendered Generator out.exr ldi=shot.ldi.exr
[ -e started ] || fail "dof-view is not found by SPARSELENS_BIN"
same out.exr as-rendered.exr
rendered Generator out.exr "${words[@]}"
same out.exr expected.exr
rendered Filter out.exr "${words[@]}" @source=grey.exr
same out.exr expected.exr
rendered General out.exr "${words[@]}" @source=grey.exr @z=z.exr @tiles=7 @threads=3 @rows=down
same out.exr expected.exr
rendered Generator out.exr "${words[@]}" frame_offset=7 highlight_threshold=2 lens=petzval cat_eye=1 spherical=0.5
gathered preset.exr shot.ldi.exr --focus-distance 3 --fstop 0.7 --blades 5 --quality draft --tilt 3,-4 --cat-eye 1 --cat-eye-darkening \
    --lens "$source_dir/share/lenses/petzval.json" --spherical 0.5
same out.exr preset.exr

# Keys of the host, and the frame in the name of a sequence or of a .dof file.
gathered expected.exr shot.ldi.exr --focus-distance 2.5
rendered Generator out.exr ldi=shot.ldi.exr focus_distance=0:2,10:4 @time=2.5
same out.exr expected.exr
cp shot.ldi.exr seq.0007.exr
exits 0 ldi-warp flat.exr "${lens[@]}" --scene-unit 2 -o seq.0008.exr
gathered expected.exr seq.0008.exr --fstop 1
for ldi in 'seq.%04d.exr' 'seq.####.exr'; do
    rendered Generator out.exr "ldi=$ldi" fstop=1 frame_offset=5 @time=3
    same out.exr expected.exr
done
echo '{"ldi": "seq.#.exr", "fstop": {"0": 4, "8": 1}}' >seq.dof
rendered Generator out.exr ldi=seq.dof @time=8
same out.exr expected.exr

# Formats. Whole numbers have the colours of a PNG, others those of an EXR file.
exits 0 dof-gather shot.ldi.exr -o shown.exr -d float --channels rgba --output-colorspace sRGB
for format in byte:0.00197:shown short:0.0000077:shown half:0.0005:as-rendered; do
    IFS=: read -r depth bound expected <<<"$format"
    rendered Generator out.exr ldi=shot.ldi.exr "@depth=$depth"
    same out.exr "$expected.exr" "$bound"
done
rendered Generator out.exr ldi=shot.ldi.exr @components=RGB
same out.exr as-rendered.exr R,G,B
rendered Generator out.exr ldi=shot.ldi.exr output_colorspace=ACEScg
gathered expected.exr shot.ldi.exr --output-colorspace ACEScg
same out.exr expected.exr
rendered Generator out.exr ldi=shot.ldi.exr @unpremultiplied=1
same out.exr as-rendered.exr A
for at in 48,26 3,3; do
    read -r red alpha <<<"$(picture pixel as-rendered.exr $at R,A)"
    picture pixel out.exr $at R >straight
    awk -v p="$red" -v a="$alpha" '{ exit !($1 * a - p < 1e-6 && p - $1 * a < 1e-6) }' straight || fail "$at: $red of $alpha becomes $(cat straight)"
done

# Render scales are proxies. The scale 0.4 takes the nearest pixels of the proxy of 2.
for proxy in 2 4 3; do
    gathered expected.exr shot.ldi.exr --proxy $proxy
    rendered Generator out.exr ldi=shot.ldi.exr "@scale=$(awk "BEGIN { print 1 / $proxy }")" @tiles=5
    same out.exr expected.exr
done
picture make ramp.exr 60x40 R=0..59 G=0 B=0 A=1 Z=1 fill=60x10+0+30 G=1
rendered Generator out.exr ldi=ramp.exr lens_radius=0 @size=60x40 @scale=0.4
for at in 0,0 11,7 23,15; do
    read -r red green <<<"$(picture pixel out.exr $at R,G)"
    awk -v r="$red" -v g="$green" -v at=$at 'BEGIN { split(at, p, ","); d = r - ((p[1] + 0.5) / 0.4 - 0.5); exit !(d * d <= 1 && g == (p[2] >= 12)) }' ||
        fail "pixel $at of the scale 0.4 is $red $green"
done

# The region is the data window, in the host's pixels; no window of the host reaches beyond the picture.
picture edit flat.exr part.exr crop=40x20+10+4
part=(focal_length=50 sensor_width=36 lens_radius=0.05 focus_distance=2)
gathered expected.exr part.exr "${lens[@]}" --overscan keep
rendered Generator out.exr ldi=part.exr "${part[@]}" overscan=keep @region=1 @aspect=2
same out.exr expected.exr
rendered Generator out.exr ldi=part.exr "${part[@]}" overscan=keep
picture edit out.exr cut.exr crop=40x20+10+4
same cut.exr expected.exr
[ "$(picture pixel out.exr 5,2 R,A)" = "0 0" ] || fail "outside the picture is $(picture pixel out.exr 5,2 R,A)"

# A flat source with its depth, as a clip or as a file; its proxy comes from the host.
gathered expected.exr flat.exr "${lens[@]}"
rendered Filter out.exr "${part[@]}" @source=flat.exr @z=flat.exr @tiles=20 @threads=2
same out.exr expected.exr
rendered Filter out.exr "${part[@]}" @source=flat.exr depth_file=flat.exr @rows=down
same out.exr expected.exr
picture make half.exr 32x18 R=noise:1 G=noise:2 B=noise:3 A=1 Z=3 fill=12x8+6+4 Z=1.5
gathered expected.exr half.exr "${lens[@]}"
rendered General out.exr "${part[@]}" @source=half.exr @z=half.exr @scale=0.5
same out.exr expected.exr
rendered Filter out.exr lens_radius=0 @source=grey.exr @z=z.exr @depth=byte
same out.exr grey.exr R,G,B,A 0.00393
picture make straight.exr 64x36 R=0.5 G=0.25 B=1 A=0.5
rendered Filter out.exr lens_radius=0 @source=straight.exr @z=z.exr @unpremultiplied=1
same out.exr straight.exr R,G,B,A 0.000001

# The host shows why a render fails, and the next render works.
head -c 3000 shot.ldi.exr >damaged.exr
cp damaged.exr mended.exr
echo no >text.exr
refused 'none.exr: cannot open' Generator ldi=none.exr
refused 'damaged.exr' Generator ldi=damaged.exr
refused 'text.exr' Generator ldi=text.exr
refused 'fstop.*lens radius' Generator ldi=shot.ldi.exr fstop=2 lens_radius=1
refused 'blades' Generator ldi=shot.ldi.exr blades=2
refused 'no colour space|nowhere' Generator ldi=shot.ldi.exr output_colorspace=nowhere
refused 'name an LDI' Generator
refused 'connect the depth' Filter @source=grey.exr
refused 'the focal length is unknown: give focal length' Filter @source=grey.exr @z=z.exr
refused 'seq' Generator 'ldi=seq.%04d.exr' @time=99
SPARSELENS_BIN=/none refused 'cannot start /none/dof-view' Generator ldi=shot.ldi.exr
host render Generator out.exr ldi=mended.exr '@again=cp shot.ldi.exr mended.exr'
[ "$(cat stdout)" = "status 0" ] || fail "after an error: $(cat stdout)"
same out.exr as-rendered.exr
exits 0 ldi-warp flat.exr "${lens[@]::6}" --focus-distance 3 -o other.ldi.exr
gathered expected.exr other.ldi.exr
rendered Generator out.exr ldi=mended.exr '@again=cp other.ldi.exr mended.exr'
same out.exr expected.exr

# A gatherer that is killed at any moment.
rendered Generator out.exr ldi=shot.ldi.exr @kill=30 @tiles=24 @threads=2
rendered Filter out.exr "${part[@]}" @source=flat.exr @z=flat.exr @kill=10
echo "openfx: fine"
