# Colour spaces in and out: --colorspace, --colorconfig, $OCIO, file rules, --output-colorspace, --display,
# --view-transform, and pictures that are not EXR.
#   bash colour.sh BIN_DIR
. "$(dirname "$0")/check.sh"
config=$source_dir/share/ocio/config.ocio
unset OCIO
flat=(--lens-radius 0)

# within A B TOLERANCE WHAT: no value differs by more than the tolerance.
within() { picture same "$1" "$2" "$3" >found || fail "$4 ($(cat found))"; }
differ() { picture differ "$1" "$2" 0.01 || fail "$3 changes nothing"; }
# Uses the exact curves, as the tools do: OpenColorIO 2.5 approximates powers by default.
oiiotool() { OCIO_OPTIMIZATION_FLAGS=0 command oiiotool "$@"; }

oiiotool --pattern fill:topleft=0.1,0.5,0.9,1,2:topright=0.9,0.2,0.1,1,2:bottomleft=0,0,0,1,4:bottomright=1,1,1,1,4 \
    16x12 5 --chnames R,G,B,A,Z -d float -o in.exr

# EXR is scene-linear by the file rules of the tools' own configuration.
exits 0 "$bin/dof-gather" in.exr -o plain.exr -d float "${flat[@]}" -v
grep -q 'colour space Linear Rec.709' stderr || fail "-v does not name the space: $(cat stderr)"
picture edit in.exr expected.exr channels=R,G,B,A
within plain.exr expected.exr 0 "no colour option"

# --colorspace converts like oiiotool with the same configuration; depth and coverage stay.
exits 0 "$bin/dof-gather" in.exr -o linear.exr -d float "${flat[@]}" --colorspace sRGB --depth-out depth.exr
oiiotool --colorconfig "$config" in.exr --ch R,G,B,A --colorconvert sRGB 'Linear Rec.709' -o expected.exr
within linear.exr expected.exr 1e-5 "--colorspace sRGB"
differ linear.exr plain.exr "--colorspace"
picture edit in.exr expected.exr channels=Z
within depth.exr expected.exr 0 "--colorspace changes depth"

# The file rules of --colorconfig and of $OCIO; the option takes precedence.
sed '/name: OpenEXR/s/colorspace: Linear Rec.709/colorspace: sRGB/' "$config" >encoded.ocio
exits 0 "$bin/dof-gather" in.exr -o rules.exr -d float "${flat[@]}" --colorconfig encoded.ocio
within rules.exr linear.exr 0 "the file rules of --colorconfig"
exits 0 env OCIO=encoded.ocio "$bin/dof-gather" in.exr -o rules.exr -d float "${flat[@]}"
within rules.exr linear.exr 0 'the file rules of $OCIO'
exits 0 env OCIO=encoded.ocio "$bin/dof-gather" in.exr -o rules.exr -d float "${flat[@]}" --colorconfig "$config"
within rules.exr plain.exr 0 '--colorconfig before $OCIO'
exits 0 env OCIO=encoded.ocio "$bin/dof-gather" in.exr -o rules.exr -d float "${flat[@]}" --colorspace 'Linear Rec.709'
within rules.exr plain.exr 0 "--colorspace before the file rules"

# Our own LDIs are scene-linear whatever the rules say, because ldi-warp converted them.
exits 0 "$bin/ldi-warp" in.exr -o ldi.exr --merge keep --colorspace sRGB
exits 0 env OCIO=encoded.ocio "$bin/dof-gather" ldi.exr -o warped.exr -d float "${flat[@]}"
within warped.exr linear.exr 5e-4 "ldi-warp --colorspace"
exits 0 "$bin/ldi-warp" in.exr -o ldi.exr --merge keep --colorconfig encoded.ocio
exits 0 "$bin/dof-gather" ldi.exr -o warped.exr -d float "${flat[@]}"
within warped.exr linear.exr 5e-4 "ldi-warp --colorconfig"

# chromaticities name the space of the input, unless --colorspace does. EXR stays in its linear space, and states it.
chromaticities() { exrheader "$1" | sed -n '/^chromaticities/,/white/p'; }
oiiotool in.exr --attrib:type=float[8] chromaticities 0.713,0.293,0.165,0.83,0.128,0.044,0.32168,0.33767 -o ap1.exr
exits 0 "$bin/dof-gather" ap1.exr -o kept.exr -d float "${flat[@]}" -v
grep -q 'colour space ACEScg' stderr || fail "chromaticities are ignored: $(cat stderr)"
within kept.exr plain.exr 0 "chromaticities change an EXR"
chromaticities kept.exr | grep -q '0.713' || fail "kept.exr: $(chromaticities kept.exr)"
exits 0 "$bin/dof-gather" in.exr -o stays.exr -d float "${flat[@]}" --colorspace ACEScg
within stays.exr plain.exr 0 "--colorspace ACEScg changes an EXR"
chromaticities stays.exr | grep -q '0.713' || fail "--colorspace ACEScg is not said: $(chromaticities stays.exr)"
exits 0 "$bin/dof-gather" ap1.exr -o out709.exr -d float "${flat[@]}" --output-colorspace 'Linear Rec.709'
oiiotool --colorconfig "$config" in.exr --ch R,G,B,A --colorconvert ACEScg 'Linear Rec.709' -o expected.exr
within out709.exr expected.exr 1e-5 "from chromaticities to --output-colorspace"
chromaticities out709.exr | grep -q '0.64' || fail "stale chromaticities: $(chromaticities out709.exr)"
exits 0 "$bin/dof-gather" ap1.exr -o encoded.exr -d float "${flat[@]}" --output-colorspace 'Gamma 2.2'
[ -z "$(chromaticities encoded.exr)" ] || fail "chromaticities of an encoded space: $(chromaticities encoded.exr)"
exits 0 "$bin/dof-gather" ap1.exr -o plain709.exr -d float "${flat[@]}" --colorspace 'Linear Rec.709'
chromaticities plain709.exr | grep -q '0.64' || fail "--colorspace does not go before chromaticities"
exits 0 "$bin/ldi-warp" ap1.exr -o ap1.ldi.exr --merge keep
for name in ap1.exr ap1.ldi.exr; do
    exits 0 "$bin/dof-gather" "$name" -o shown.png "${flat[@]}"
    oiiotool --colorconfig "$config" in.exr --ch R,G,B --colorconvert ACEScg 'Linear Rec.709' --ociodisplay sRGB Standard --clamp:min=0:max=1 \
        -d float -o expected.exr
    oiiotool shown.png -d float -o shown.exr
    within shown.exr expected.exr 0.0023 "$name by its chromaticities through a display"
done
oiiotool in.exr --attrib:type=float[8] chromaticities 0.7,0.3,0.2,0.7,0.1,0.1,0.33,0.33 -o odd.exr
exits 0 "$bin/dof-gather" odd.exr -o x.png "${flat[@]}"
grep -q 'warning: odd.exr: .* its chromaticities, .*--colorspace' stderr || fail "odd chromaticities: $(cat stderr)"
rm x.png

# colorInteropID and oiio:ColorSpace name the space; chromaticities take precedence, file rules come last. Converted
# pictures do not keep the old id, nor do pictures whose chromaticities contradict it.
stated() { exrheader "$1" | sed -nE 's/^(colorInteropID|oiio:ColorSpace) .*: "(.*)"$/\1=\2/p' | tr '\n' ' '; }
says() { [ "$(stated "$1")" = "$2" ] || fail "$1 says $(stated "$1"), not $2"; }
picture edit in.exr id.exr set=colorInteropID:lin_ap1_scene set=oiio:ColorSpace:ACEScg
exits 0 "$bin/dof-gather" id.exr -o kept.exr -d float "${flat[@]}" -v
grep -q 'colour space ACEScg' stderr || fail "colorInteropID is ignored: $(cat stderr)"
within kept.exr plain.exr 0 "colorInteropID changes an EXR"
says kept.exr 'colorInteropID=lin_ap1_scene oiio:ColorSpace=ACEScg '
exits 0 "$bin/dof-gather" id.exr -o out709.exr -d float "${flat[@]}" --output-colorspace 'Linear Rec.709'
oiiotool --colorconfig "$config" in.exr --ch R,G,B,A --colorconvert ACEScg 'Linear Rec.709' -o expected.exr
within out709.exr expected.exr 1e-5 "from colorInteropID to --output-colorspace"
says out709.exr 'colorInteropID=lin_rec709_scene '
exits 0 "$bin/dof-gather" id.exr -o srgb.exr -d float "${flat[@]}" --output-colorspace sRGB
says srgb.exr ''
exits 0 "$bin/dof-gather" id.exr -o plain709.exr -d float "${flat[@]}" --colorspace 'Linear Rec.709'
says plain709.exr 'colorInteropID=lin_rec709_scene '
picture edit ap1.exr both.exr set=colorInteropID:lin_rec2020_scene
exits 0 "$bin/dof-gather" both.exr -o kept.exr "${flat[@]}"
says kept.exr 'colorInteropID=lin_ap1_scene '
picture edit in.exr oiio.exr set=oiio:ColorSpace:sRGB
exits 0 "$bin/dof-gather" oiio.exr -o kept.exr -d float "${flat[@]}" -v
grep -q 'colour space sRGB' stderr || fail "oiio:ColorSpace is ignored: $(cat stderr)"
says kept.exr ''
differ kept.exr plain.exr "an EXR that oiio:ColorSpace calls encoded"
picture edit in.exr odd.exr set=colorInteropID:nobody_knows
exits 0 "$bin/dof-gather" odd.exr -o x.exr -d float "${flat[@]}"
grep -q 'warning: odd.exr: .* its colorInteropID, .*--colorspace' stderr || fail "an odd colorInteropID: $(cat stderr)"
picture edit in.exr data.exr set=colorInteropID:data
exits 0 "$bin/dof-gather" data.exr -o x.exr -d float "${flat[@]}"
if grep warning: stderr; then fail "colorInteropID data"; fi
within x.exr plain.exr 0 "colorInteropID data"
rm x.exr

# Output: any space, and through a display and a view.
exits 0 "$bin/dof-gather" in.exr -o acescg.exr -d float "${flat[@]}" --output-colorspace ACEScg
oiiotool --colorconfig "$config" in.exr --ch R,G,B,A --colorconvert 'Linear Rec.709' ACEScg -o expected.exr
within acescg.exr expected.exr 1e-5 "--output-colorspace"
differ acescg.exr plain.exr "--output-colorspace"
for name in out.png out.tif; do
    exits 0 "$bin/dof-gather" in.exr -o "$name" "${flat[@]}"
    oiiotool --colorconfig "$config" in.exr --ch R,G,B --ociodisplay sRGB Standard -d float -o expected.exr
    oiiotool "$name" -d float -o shown.exr
    within shown.exr expected.exr 0.0021 "$name" # half a step of 8 bits
done
exits 0 "$bin/dof-gather" in.exr -o out.jpg "${flat[@]}"
oiiotool out.png -o expected.jpg
idiff -q -fail 0 -warn 0 out.jpg expected.jpg >found || fail "out.jpg ($(cat found))"
oiiotool --info out.tif | grep -q uint16 || fail "TIFF has no 16 bits"

# A format without alpha shows an element over black, encoded as such; .hdr holds linear light.
oiiotool --pattern constant:color=0.2,0.1,0.05,0.25,3 16x16 5 --chnames R,G,B,A,Z -d float -o element.exr
oiiotool --pattern constant:color=0.2,0.1,0.05 16x16 3 -d float -o opaque.exr
oiiotool --pattern constant:color=0.2,0.1,0.05,1,3 16x16 5 --chnames R,G,B,A,Z -d float -o full.exr
for ending in jpg hdr webp; do
    exits 0 "$bin/dof-gather" element.exr -o element.$ending "${flat[@]}"
    exits 0 "$bin/dof-gather" full.exr -o full.$ending "${flat[@]}"
    cmp element.$ending full.$ending || fail "an element over black as $ending"
done
oiiotool element.hdr -d float -o shown.exr
within shown.exr opaque.exr 0.002 "the light of .hdr"
exits 0 "$bin/dof-gather" in.exr -o raw.png "${flat[@]}" --view-transform Raw
oiiotool raw.png -d float -o shown.exr
picture edit in.exr expected.exr channels=R,G,B
within shown.exr expected.exr 0.0021 "--view-transform Raw"
exits 0 "$bin/dof-gather" in.exr -o rec.png "${flat[@]}" --display Rec.1886
oiiotool --colorconfig "$config" in.exr --ch R,G,B --ociodisplay Rec.1886 Standard -d float -o expected.exr
oiiotool rec.png -d float -o shown.exr
within shown.exr expected.exr 0.0021 "--display"
exits 0 "$bin/dof-gather" in.exr -o space.png "${flat[@]}" --output-colorspace 'Gamma 2.2'
if idiff -q -fail 0.01 -warn 0.01 space.png out.png >found 2>&1; then fail "--output-colorspace of a PNG changes nothing"; fi

# Coverage is written if there is any; the data window is placed in the display window.
picture make half.exr 4x4+2+3 frame=10x8 R=0.25 G=0.25 B=0.25 A=0.5 Z=2
exits 0 "$bin/dof-gather" half.exr -o half.png "${flat[@]}"
oiiotool --info half.png | grep -q '10 x *8, 4 channel' || fail "half.png: $(oiiotool --info half.png)"
in_half() { oiiotool --iconfig oiio:UnassociatedAlpha 1 half.png -d float --cut "$1" --printstats; } # as it is in the file
in_half 1x1+3+4 | grep -q 'Stats Avg: 0.73.* 0.50' || fail "coverage: $(in_half 1x1+3+4)"
in_half 1x1+0+0 | grep -q 'Stats Max: 0.0* 0.0* 0.0* 0.0*' || fail "not black outside"

# Impossible conversions.
fails_saying 1 "no colour space 'nowhere'" "$bin/dof-gather" in.exr -o x.exr "${flat[@]}" --colorspace nowhere
fails_saying 1 "no display 'wall'" "$bin/dof-gather" in.exr -o x.png "${flat[@]}" --display wall
fails_saying 1 "'upside-down'" "$bin/dof-gather" in.exr -o x.png "${flat[@]}" --view-transform upside-down
fails_saying 1 'gone.ocio.*--colorconfig' "$bin/dof-gather" in.exr -o x.exr "${flat[@]}" --colorconfig gone.ocio
fails_saying 1 'gone.ocio.*OCIO' env OCIO=gone.ocio "$bin/dof-gather" in.exr -o x.exr "${flat[@]}" --colorspace sRGB
exits 1 env OCIO=gone.ocio "$bin/dof-gather" in.exr -o x.png "${flat[@]}"
grep -q '^dof-gather: gone.ocio .*OCIO' stderr || fail "PNG without a configuration: $(cat stderr)"
# From EXR to EXR a bad $OCIO gives one warning for all files.
exits 0 "$bin/dof-gather" in.exr -o good.exr -d float "${flat[@]}"
exits 0 env OCIO=gone.ocio "$bin/dof-gather" in.exr -o bad.exr -d float "${flat[@]}"
within bad.exr good.exr 0 'from EXR to EXR without $OCIO'
grep -Eq '^dof-gather: warning: gone.ocio \(\$OCIO\): no such file; EXR is taken as linear: correct \$OCIO, or .*--colorconfig' stderr ||
    fail "a bad \$OCIO: $(cat stderr)"
exits 0 env OCIO=gone.ocio "$bin/ldi-warp" in.exr --view 1,0 in.exr -o two.exr --focal-length 50 --sensor-width 36
[ "$(grep -c OCIO stderr)" = 1 ] || fail "a bad \$OCIO, more than once: $(cat stderr)"
fails_saying 2 '--display' "$bin/dof-gather" in.exr -o x.exr "${flat[@]}" --display sRGB
fails_saying 2 '--display' "$bin/dof-gather" in.exr -o x.png "${flat[@]}" --display sRGB --output-colorspace sRGB
fails_saying 1 'x.png: needs the channels R, G and B' "$bin/dof-gather" in.exr -o x.png "${flat[@]}" --channels A
fails_saying 1 'in.exr: cannot create the folder' "$bin/dof-gather" in.exr -o in.exr/x.png "${flat[@]}"
[ ! -e x.exr ] && [ ! -e x.png ] || fail "a failure wrote something"

# A built-in configuration of OpenColorIO is not a file: OpenColorIO answers, with the picture since version 2.2.
version=$(oiiotool --help | sed -nE 's/^OpenColorIO ([0-9]+\.[0-9]+).*/\1/p')
[ -n "$version" ] || fail "oiiotool does not tell the version of OpenColorIO"
if [ "$(printf '%s\n' 2.2 "$version" | sort -V | head -n 1)" = 2.2 ]; then
    exits 0 "$bin/dof-gather" in.exr -o own.exr -d float "${flat[@]}" --colorconfig ocio://default --colorspace 'Linear Rec.709 (sRGB)' \
        --output-colorspace ACEScg
    within own.exr acescg.exr 1e-4 "ocio://default" # by the same matrix as in our configuration
else
    fails_saying 1 'ocio://default' "$bin/dof-gather" in.exr -o own.exr "${flat[@]}" --colorconfig ocio://default
    if grep -q 'no such file' stderr; then fail "ocio://default is taken for a file"; fi
fi
fails_saying 1 'ocio://no-such' "$bin/dof-gather" in.exr -o own.exr "${flat[@]}" --colorconfig ocio://no-such
if grep -q 'no such file' stderr; then fail "ocio://no-such is taken for a file"; fi
