#!/bin/bash
# dof-compare from the shell: its output, and the effect of each option.
. "$(dirname "$0")/check.sh"
for tool in oiiotool idiff; do
    command -v $tool >/dev/null || skip "needs $tool (openimageio-tools)"
done
compare=$bin/dof-compare

# figure KEY [REGION]: prints a number from the JSON in the file stdout.
figure() {
    python3 -c 'import json, sys
figures = json.load(open("stdout"))
if sys.argv[2]: figures = figures["regions"][sys.argv[2]]
print(json.dumps(figures[sys.argv[1]]))' "$1" "${2:-}"
}
# is KEY EXPECTED [REGION] [TOLERANCE]
is() {
    local value
    value=$(figure "$1" "${3:-}")
    [ -n "$value" ] || fail "no $1 ${3:-} in $(cat stdout)"
    awk -v a="$value" -v b="$2" -v t="${4:-0.001}" 'BEGIN {
        exit !(a == b || (a + 0 == a && b + 0 == b && a - b <= t && b - a <= t)) }' ||
        fail "$1 ${3:-} is $value, not $2"
}
constant() { # FILE R,G,B,A SIZE
    local values
    IFS=, read -ra values <<<"$2"
    picture make "$1" "$3" R="${values[0]}" G="${values[1]}" B="${values[2]}" A="${values[3]}"
}

answers_help dof-compare A.exr REF.exr

# Closed forms.
constant a.exr 0.75,0.75,0.75,0.5 32x20
constant b.exr 0.5,0.5,0.5,1 32x20
exits 0 "$compare" a.exr b.exr --json
is psnr 12.0412
is psnr_tonemapped "$(awk 'BEGIN { d = (0.75 / 1.75)^(1 / 2.2) - (0.5 / 1.5)^(1 / 2.2); print -20 * log(d) / log(10) }')"
is psnr_worst "$(figure psnr_tonemapped)" # the same everywhere
is relmse 0.240385
is smape 0.198413
is p99 0.25
is max 0.25
is max_alpha 0.5
is pixels 640
is nonfinite '{"image": 0, "reference": 0}'
exits 0 "$compare" a.exr a.exr --json
is psnr null
is psnr_tonemapped null
is ssim 1

# The table has the same figures.
exits 0 "$compare" a.exr b.exr
grep -Eq '^psnr +12.0412$' stdout || fail "no psnr in the table: $(cat stdout)"
grep -Eq '^nonfinite \(image\) +0$' stdout || fail "no count in the table: $(cat stdout)"
[ ! -s stderr ] || fail "says on stderr: $(cat stderr)"

# PSNR and the largest error, compared with idiff.
for i in 1 2; do picture make n$i.exr 64x48 R=noise:1$i G=noise:2$i B=noise:3$i 'R*=0.9' half=; done
idiff n1.exr n2.exr >idiff.txt || true
exits 0 "$compare" n1.exr n2.exr --json
is psnr "$(sed -n 's/.*Peak SNR = //p' idiff.txt)"
is max "$(sed -n 's/.*Max error  = \([^ ]*\).*/\1/p' idiff.txt)" "" 1e-6

# Pictures brighter than 1, as they are and tone-mapped by oiiotool, compared with idiff's root mean square: its own
# PSNR uses their largest value as the peak. idiff prints six digits.
exits 0 "$bin/dof-trace" fence --size 96x54 --views 0 --reference 16 -d float -o few
exits 0 "$bin/dof-trace" fence --size 96x54 --views 0 --reference 256 -d float --seed 1 -o many
for rays in few many; do
    oiiotool $rays/reference.exr --ch R,G,B -d float -o $rays.exr
    oiiotool $rays.exr $rays.exr --addc 1 --div --powc 0.45454545 -d float -o $rays-toned.exr
    oiiotool $rays.exr --clamp:min=0:max=1 --colorconvert linear sRGB -d float -o $rays-srgb.exr
done
decibels() { idiff "$@" | awk '/RMS error/ { print -20 * log($4) / log(10) }'; }
exits 0 "$compare" few/reference.exr many/reference.exr --json
is psnr "$(decibels few.exr many.exr)" "" 0.0002
is psnr_tonemapped "$(decibels few-toned.exr many-toned.exr)" "" 0.0002
is psnr_srgb "$(decibels few-srgb.exr many-srgb.exr)" "" 0.0002

# Non-finite pixels are counted and left out.
picture edit b.exr bad.exr fill=1x1+3+4 R=inf
exits 0 "$compare" bad.exr b.exr --json
is nonfinite '{"image": 1, "reference": 0}'
is pixels 639
is psnr null
is ssim 1
exits 0 "$compare" b.exr bad.exr --json
is nonfinite '{"image": 0, "reference": 1}'
is relmse 0

# Uses the reference's data window; pixels that A lacks are transparent black.
picture edit b.exr right.exr crop=16x20+16+0
exits 0 "$compare" right.exr b.exr --json
is pixels 640
is relmse 0.480769
is max_alpha 1
exits 0 "$compare" b.exr right.exr --json
is pixels 320
is psnr null

# Regions: left half in focus at 5, right half at 20, behind focus. F = 32 pixels.
constant near.exr 1,1,1,1 16x20
picture edit b.exr ldi.exr Z=5 fill=16x20+16+0 Z=20 all= other=5
lens=(--focal-length 36 --sensor-width 36 --lens-radius 0.9 --focus-distance 5) # c = 0 and 4.32
regions() { exits 0 "$compare" a.exr b.exr --json --regions "$@"; }
regions ldi.exr "${lens[@]}"
is pixels 640
is pixels 320 in_focus
is pixels 0 blurred
is pixels 200 silhouettes # 5 columns on either side: |x - 15| and |x - 16| up to 4.32
is psnr null blurred
is psnr 12.0412 in_focus
exits 0 "$compare" a.exr b.exr --regions ldi.exr "${lens[@]}"
head -1 stdout | grep -Eq 'all +in_focus +blurred +silhouettes' || fail "no columns: $(head -1 stdout)"

# Each lens option changes the regions.
changes() { # PIXELS REGION OPTIONS...: with these options a region has this many pixels
    regions ldi.exr "${@:3}"
    is pixels "$1" "$2"
}
changes 320 blurred --focal-length 72 --sensor-width 36 --lens-radius 0.9 --focus-distance 5
changes 320 blurred --focal-length 36 --sensor-width 18 --lens-radius 0.9 --focus-distance 5
changes 320 blurred --focal-length 36 --sensor-width 36 --lens-radius 1.8 --focus-distance 5
changes 0 in_focus --focal-length 36 --sensor-width 36 --lens-radius 0.9 --focus-distance 10
changes 320 blurred --focal-length 36 --sensor-width 36 --fstop 0.01 --focus-distance 5
changes 640 in_focus --focal-length 36 --sensor-width 36 --fstop 0.1 --focus-distance 5
changes 320 blurred --focal-length 36 --sensor-width 36 --fstop 0.1 --focus-distance 5 --scene-unit 0.1
changes 640 in_focus --lens-radius 0
changes 640 blurred "${lens[@]}" --depth inverse # 1/5, 1/20: far in front of focus
changes 640 in_focus "${lens[@]}" --depth-channel other
# Along the ray: z = 5 / s, s = sqrt(1 + (r / 32)^2), so |c| = 11.52 (s - 1) at lens radius 1.8.
near=$(awk 'BEGIN { for (x = 0; x < 16; ++x) for (y = 0; y < 20; ++y)
    n += 11.52 * (sqrt(1 + ((x - 15.5)^2 + (y - 9.5)^2) / 1024) - 1) < 1; print n }')
[ "$near" -lt 320 ] || fail "the picture is too small for --depth distance to show"
changes "$near" in_focus --focal-length 36 --sensor-width 36 --lens-radius 1.8 --focus-distance 5 --depth distance

# The lens may come from the LDI's metadata, the regions from a deep file; missing values are named.
oiiotool ldi.exr --attrib:type=float pinholeFocalLength 36 --attrib:type=float sparselens:sensorWidth 36 \
    --attrib:type=float aperture 0.02 --attrib:type=float focus 5 --chnames R,G,B,A,Z,other --deepen -o deep.exr
regions deep.exr
is pixels 320 in_focus
is pixels 200 silhouettes
exits 0 "$compare" a.exr b.exr --regions deep.exr -v
grep -q 'focal length 32.*focused at 5' stderr || fail "-v does not tell the lens: $(cat stderr)"
fails_saying 2 'focal length.*--focal-length' "$compare" a.exr b.exr --regions ldi.exr --fstop 2
fails_saying 2 "requires --regions" "$compare" a.exr b.exr --fstop 2 # changes nothing without --regions

# Standard input, threads.
exits 0 "$compare" n1.exr n2.exr --json --threads 1
mv stdout one.json
exits 0 "$compare" n1.exr n2.exr --json --threads 2
cmp -s one.json stdout || fail "threads change figures"
"$compare" - n2.exr --json <n1.exr >piped.json || fail "cannot read standard input"
cmp -s one.json piped.json || fail "another result from standard input"

# Impossible comparisons.
fails_saying 1 'none.exr' "$compare" none.exr b.exr
echo text >text.exr
fails_saying 1 'text.exr' "$compare" a.exr text.exr
fails_saying 1 'n1.exr.*64x48.*32x20' "$compare" n1.exr b.exr
fails_saying 1 'n1.exr.*display window' "$compare" a.exr b.exr --regions n1.exr "${lens[@]}" --depth-channel R
picture edit ldi.exr onlyz.exr channels=Z
fails_saying 1 'onlyz.exr.*channel R' "$compare" onlyz.exr b.exr
fails_saying 2 REF "$compare" a.exr
fails_saying 2 'twice' "$compare" - -
echo "dof-compare: fine"

# Two references: without their noise the error is correct; if it is below their resolution, the tool says so.
exits 0 "$bin/dof-trace" fence --size 64x36 --views 0 --halves 512 --reference 1024 -d float -o noisy
picture edit noisy/reference.exr wrong.exr 'R*=1.3' 'G*=1.3' 'B*=1.3'
"$compare" wrong.exr noisy/reference.exr >figures
known=$(awk '$1 == "psnr_tonemapped" { print $2 }' figures)
exits 0 "$compare" wrong.exr noisy/rays_1.exr noisy/rays_2.exr
awk -v known="$known" '$1 == "psnr_without_noise" { found = $2 > known - 0.5 && $2 < known + 0.5 } END { exit !found }' stdout ||
    fail "psnr_without_noise: $(cat stdout), not $known"
exits 0 "$compare" noisy/reference.exr noisy/rays_1.exr noisy/rays_2.exr
grep -Eq '^psnr_without_noise +> [0-9.]+$' stdout || fail "an error too small to tell: $(cat stdout)"
exits 0 "$compare" noisy/reference.exr noisy/rays_1.exr noisy/rays_2.exr --json
grep -q '"psnr_without_noise": null' stdout && grep -Eq '"mse_deviation": [0-9.e-]+' stdout || fail "--json: $(cat stdout)"
mv stdout one-way.json
exits 0 "$compare" noisy/reference.exr noisy/rays_2.exr noisy/rays_1.exr --json --threads 1
cmp -s stdout one-way.json || fail "the order of references matters"
fails_saying 1 'n1.exr' "$compare" wrong.exr noisy/rays_1.exr n1.exr
fails_saying 1 'has the same noise' "$compare" few/reference.exr many/reference.exr many/reference.exr
fails_saying 2 'REF_2' "$compare" 's.####.exr' 's.####.exr' 's.####.exr' --frames 1-3

# --frames: the steadiness of a sequence. Of three pixels one is constant, one changes evenly, one jumps in the last
# frame.
frame() { picture make "$1" 3x1 R=0.5 G=0.5 B=0.5 A=1 fill=1x1+1+0 R=$2 G=$2 B=$2 fill=1x1+2+0 R=$3 G=$3 B=$3; }
frame s.0001.exr 0.50 0.5
frame s.0002.exr 0.51 0.5
frame s.0003.exr 0.52 0.9
exits 0 "$compare" 's.####.exr' --frames 1-3 --json
grep -q '"above_0.05": 1' stdout || fail "--frames does not find the pixel that pops: $(cat stdout)"
grep -q '"frames": 3' stdout || fail "--frames: $(cat stdout)"
exits 0 "$compare" 's.####.exr' 's.####.exr' --frames 1-3
grep -Eq '^psnr_change +inf' stdout || fail "--frames with a reference: $(cat stdout)"
# A camera that moves is said, where nothing else tells how much changes: without a reference.
for i in 1 2 3; do
    oiiotool "s.000$i.exr" --attrib:type=matrix worldToCamera "1,0,0,0,0,1,0,0,0,0,1,0,0.$i,0,0,1" -o "m.000$i.exr"
    oiiotool "s.000$i.exr" --attrib:type=matrix worldToCamera "1,0,0,0,0,1,0,0,0,0,1,0,0.5,0,0,1" -o "k.000$i.exr"
done
exits 0 "$compare" 'm.####.exr' --frames 1-3
grep -q 'm.####.exr: the camera moves.*give REF' stderr || fail "a moving camera: $(cat stderr)"
for quiet in 'm.####.exr m.####.exr' 'k.####.exr'; do
    exits 0 "$compare" $quiet --frames 1-3
    [ ! -s stderr ] || fail "$quiet: $(cat stderr)"
done
fails_saying 2 'three frames' "$compare" 's.####.exr' --frames 1-2
fails_saying 1 's.0004.exr' "$compare" 's.####.exr' --frames 1-4
fails_saying 2 regions "$compare" 's.####.exr' --frames 1-3 --regions ldi.exr
