#!/bin/bash
# dof-finish from the shell: nearer to the truth than its inputs, the effect of each option, and its failures.
. "$(dirname "$0")/check.sh"
finish=$bin/dof-finish
answers_help dof-finish a.exr b.exr c.exr -o out.exr

exits 0 "$bin/dof-trace" fence --size 160x90 --spp 4 --halves 80 --reference 1024 -d float -o fence
exits 0 "$bin/ldi-warp" fence/center.exr fence/view_{0..3}.exr -o ldi.exr
exits 0 "$bin/dof-gather" ldi.exr -o gathered.exr
one=fence/rays_1.exr two=fence/rays_2.exr truth=fence/reference.exr
decibels() { "$bin/dof-compare" "$1" "$2" | awk '$1 == "psnr_tonemapped" { print $2 }'; }
holds() { awk "BEGIN { exit !($1) }" || fail "not so: $1: $2"; }
# shellcheck disable=SC2086
same() { picture same "$1" "$2" ${4:-0} >found || fail "$3: $(cat found)"; }
differ() { picture differ "$1" "$2" >found || fail "$3: $(cat found)"; }

# Nearer to the truth than both inputs, and it estimates how near.
exits 0 "$finish" gathered.exr $one $two -o out.exr --stats stats.json -v
grep -Eq '^dof-finish: estimated error: [0-9.]+ dB$' stderr || fail "-v: $(cat stderr)"
picture edit $one one.exr erase=sparselens:samples
oiiotool $one $two --add --mulc 0.5 -o rays.exr
db=$(decibels out.exr $truth)
holds "$db > $(decibels gathered.exr $truth) + 1" "nearer than the gathered picture"
holds "$db > $(decibels rays.exr $truth) + 1" "nearer than the rays"
estimated=$(grep -o '"estimated_psnr":[0-9.]*' stats.json | cut -d: -f2)
holds "$estimated < $db + 2 && $estimated > $db - 2" "the estimate: $estimated for $db"
grep -Eq '"kept":0\.[0-9]+' stats.json || fail "--stats: $(cat stats.json)"
exits 0 "$finish" gathered.exr $one $two -o again.exr --threads 1
cmp -s out.exr again.exr || fail "--threads 1 and --stats change the picture"

# Maps, and the number of rays for a goal.
exits 0 "$finish" gathered.exr $one $two -o trust.exr --show trust
exits 0 "$finish" gathered.exr $one $two -o error.exr --show error
differ trust.exr error.exr "--show"
kept=$(grep -o '"kept":[0-9.]*' stats.json | cut -d: -f2)
holds "$(picture sum trust.exr R) / 14400 - $kept < 0.001" "--show trust is what --stats has the mean of"
holds "$(picture sum trust.exr R) / 14400 - $kept > -0.001" "--show trust is what --stats has the mean of"
holds "$(picture sum error.exr R) / 14400 < 0.1 && $(picture sum error.exr R) > 1" "--show error is the error"
exits 0 "$finish" gathered.exr $one $two -o goal.exr --goal 60 --stats goal.json
same goal.exr out.exr "--goal changes no picture"
grep -qx 'dof-finish: 60 dB: more than 100 times the rays' stderr || fail "--goal 60: $(cat stderr)"
grep -q '"times_the_rays":[0-9]' goal.json || fail "--goal: $(cat goal.json)"
near=$(awk "BEGIN { print $estimated + 0.3 }")
exits 0 "$finish" gathered.exr $one $two -o goal.exr --goal "$near"
grep -Eq "^dof-finish: $near dB: about 1\.[0-9] times the rays\$" stderr || fail "--goal $near: $(cat stderr)"
exits 0 "$finish" gathered.exr $one $two -o goal.exr --goal 20
grep -qx 'dof-finish: 20 dB: reached' stderr || fail "--goal 20: $(cat stderr)"

# The headers state the number of samples; if they do not, all renders count the same.
exits 0 "$finish" gathered.exr $one $two -o stated.exr --samples 40,40
same stated.exr out.exr "--samples as the headers say"
exits 0 "$finish" gathered.exr $one $two -o unequal.exr --samples 64,16
differ unequal.exr out.exr "--samples"
exits 0 "$finish" gathered.exr one.exr $two -o even.exr -v
same even.exr out.exr "renders without a number" 0.001
grep -q 'do not say how many samples' stderr || fail "-v of unknown samples: $(cat stderr)"
fails_saying 2 '--samples.*1 numbers for 2 renders' "$finish" gathered.exr $one $two -o x.exr --samples 3
for value in 0,4 a,b -1,2; do fails_saying 2 '--samples' "$finish" gathered.exr $one $two -o x.exr --samples=$value; done

# More renders and other pictures to choose from: the truth itself is the best choice.
for twice in "$one $one" "$one $one $two $two" "$one $two $one $two" "$one copy.exr"; do
    cp $one copy.exr
    # shellcheck disable=SC2086
    fails_saying 1 'has the same noise as .*: render each with a seed of its own' "$finish" gathered.exr $twice -o four.exr
done
exits 0 "$finish" gathered.exr $one $two --gathered $truth -o other.exr
holds "$(decibels other.exr $truth) > $db + 3" "--gathered"
exits 0 "$finish" gathered.exr $one $two --denoised $truth $truth -o denoised.exr
same denoised.exr other.exr "--denoised and --gathered of the same pictures"
fails_saying 2 '--denoised.*1 pictures for 2 renders' "$finish" gathered.exr $one $two -o x.exr --denoised $one

# --ask: more rays where they are needed. Renders of the rectangles, half of the samples each, make a better picture than
# as many rays everywhere would, and two renders with a channel of counts make the same as many of parts.
exits 0 "$finish" gathered.exr $one $two -o draft.exr --ask mask.exr --rays 160 --stats ask.json
same draft.exr out.exr "--ask changes no picture"
cp stdout asked
grep -Eqx '[0-9]+,[0-9]+,[0-9]+,[0-9]+ [0-9]+' asked || fail "--ask: $(cat asked)"
[ "$(wc -l <asked)" -le 16 ] || fail "--ask: many rectangles: $(cat asked)"
holds "$(picture sum mask.exr samples) / 14400 - 80 < 0.01 && $(picture sum mask.exr samples) / 14400 - 80 > -0.01" "--ask: the mask has the rest of the budget"
holds "$(awk -F '[, ]' '{ n += $3 * $4 * $5 } END { print n / 14400 }' asked) - 80 < 2" "--ask: rectangles within the budget"
grep -q "\"ask\":\[\[$(sed -n '1s/ /,/p' asked)\]" ask.json || fail "--ask --stats: $(cat ask.json)"
exits 0 "$bin/dof-trace" fence --size 160x90 --views 0 --halves 400 --seed 9 -d float -o dear
parts=() counts=40,40
while IFS=', ' read -r x y width height _; do
    for k in 1 2; do
        oiiotool dear/rays_$k.exr --crop "${width}x$height+$x+$y" -o "part_${x}_${y}_$k.exr"
        parts+=("part_${x}_${y}_$k.exr") counts+=,200
    done
done <asked
exits 0 "$finish" gathered.exr $one $two "${parts[@]}" -o parts.exr --samples $counts
holds "$(decibels parts.exr $truth) > $db + 0.3" "--ask: $(decibels parts.exr $truth) with parts"
[ -z "$(cat stderr)" ] || fail "warns of parts: $(cat stderr)"
for k in 1 2; do
    oiiotool fence/rays_$k.exr --ch R,G,B,A,samples=40 -o counted_$k.exr
done
exits 0 "$finish" gathered.exr counted_1.exr counted_2.exr -o counted.exr --samples 7,3
same counted.exr out.exr "a channel of samples comes before --samples"
# Renders of a border: black around it, or cropped to a display window of their own that may tell where it lies.
read -r x y width height _ < <(grep -v '^0,0,' asked | tr , ' ')
whole=() black=() placed=() within=()
for k in 1 2; do
    oiiotool dear/rays_$k.exr --crop "${width}x$height+$x+$y" -o border.exr
    whole+=(border_$k.exr) && cp border.exr border_$k.exr
    oiiotool border.exr --crop 160x90+0+0 -d float -o black_$k.exr && black+=(black_$k.exr)
    oiiotool border.exr --origin +0+0 --fullsize "${width}x$height+0+0" -o placed_$k.exr && placed+=("placed_$k.exr@$x,$y")
    oiiotool border.exr --fullsize "${width}x$height+$x+$y" -o within_$k.exr && within+=(within_$k.exr)
done
exits 0 "$finish" gathered.exr $one $two "${whole[@]}" -o border.exr --samples 40,40,200,200
for way in "${black[*]}" "${placed[*]}" "${within[*]}"; do
    # shellcheck disable=SC2086
    exits 0 "$finish" gathered.exr $one $two $way -o again.exr --samples 40,40,200,200
    cmp -s border.exr again.exr || fail "not the border's picture: $way"
done
fails_saying 1 'placed_1.exr: its picture is .*: render both with the same camera and size' "$finish" gathered.exr $one $two placed_1.exr -o x.exr

# Cycles' noisy colours beside denoised ones.
for k in 1 2; do
    oiiotool "fence/rays_$k.exr" --ch R,G,B,A --median 5x5 --chnames R,G,B,A -o median.exr
    oiiotool median.exr fence/rays_$k.exr --ch R,G,B --chnames 'Noisy Image.R,Noisy Image.G,Noisy Image.B' --chappend -d float -o cycles_$k.exr
    oiiotool median.exr -d float -o median_$k.exr
done
exits 0 "$finish" gathered.exr $one $two --denoised median_1.exr median_2.exr -o denoised.exr
exits 0 "$finish" gathered.exr cycles_1.exr cycles_2.exr --samples 40,40 -o again.exr
same again.exr denoised.exr "Noisy Image"
fails_saying 2 '--ask.*give --rays or --goal' "$finish" gathered.exr $one $two -o x.exr --ask mask.exr
fails_saying 2 '--rays.*--ask' "$finish" gathered.exr $one $two -o x.exr --rays 160
fails_saying 2 '--rays' "$finish" gathered.exr $one $two -o x.exr --ask mask.exr --rays 1e12
fails_saying 2 "--ask.*must end in .exr, not 'mask.png'" "$finish" gathered.exr $one $two -o x.exr --ask mask.png --rays 160
fails_saying 2 '--rays 80: the renders have 80 already' "$finish" gathered.exr $one $two -o x.exr --ask mask.exr --rays 80

# Frames, pipes, pictures for the screen, types, file names.
for frame in 1 2; do cp gathered.exr g.000$frame.exr && cp $one a.000$frame.exr && cp $two b.000$frame.exr; done
exits 0 "$finish" g.####.exr a.####.exr b.####.exr -o f.####.exr --frames 1-2
same f.0001.exr out.exr "--frames"
same f.0002.exr out.exr "--frames"
"$bin/dof-gather" ldi.exr -o - | "$finish" - $one $two -o - >piped.exr
same piped.exr out.exr "pipes"
exits 0 "$finish" gathered.exr $one $two -o out.png
head -c 4 out.png | grep -q PNG || fail "no PNG"
exits 0 "$finish" gathered.exr $one $two -o float.exr -d float
exrheader float.exr | grep -q 'R, 32-bit' || fail "-d float"
same float.exr out.exr "-d float" 0.01
exits 0 "$finish" gathered.exr $one $two -o zip.exr --compression zip
same zip.exr out.exr "--compression"
exits 0 "$finish" gathered.exr $one $two -o encoded.exr --output-colorspace 'Gamma 2.2'
differ encoded.exr out.exr "--output-colorspace"
for how in '--display Rec.1886' '--view-transform Raw'; do
    # shellcheck disable=SC2086
    exits 0 "$finish" gathered.exr $one $two -o shown.png $how
    if cmp -s shown.png out.png; then fail "$how changes nothing"; fi
done
history() { exrheader "$1" | grep -A9 '^Exif:ImageHistory'; }
unset SPARSELENS_NO_HISTORY
exits 0 "$finish" gathered.exr $one $two -o told.exr
history told.exr | grep -q 'dof-finish gathered.exr fence/rays_1.exr fence/rays_2.exr' || fail "history: $(history told.exr)"
exits 0 "$finish" gathered.exr $one $two -o told.exr --no-history
if history told.exr | grep -q dof-finish; then fail "--no-history: $(history told.exr)"; fi
export SPARSELENS_NO_HISTORY=1
fails_saying 2 'would overwrite the input b.0001.exr' "$finish" gathered.exr $one b.0001.exr -o b.0001.exr
fails_saying 2 'would overwrite the input b.0001.exr' "$finish" gathered.exr $one b.0001.exr -o x.exr --ask b.0001.exr --rays 160
for input in "--denoised $one b.0001.exr" --gathered=b.0001.exr; do
    fails_saying 2 'would overwrite the input b.0001.exr' "$finish" gathered.exr $one $two $input -o b.0001.exr
done

# --neighbours: the renders of the frames around, of other seeds, are as good as more rays; also beyond the range.
for frame in 1 2 3; do
    cp gathered.exr n.000$frame.exr
    exits 0 "$bin/dof-trace" fence --size 160x90 --views 0 --spp 1 --halves 80 --seed $frame -d float -o seed
    for k in 1 2; do mv seed/rays_$k.exr n$k.000$frame.exr; done
done
sequence=(n.####.exr n1.####.exr n2.####.exr)
exits 0 "$finish" "${sequence[@]}" -o alone.####.exr --frames 1-3
exits 0 "$finish" "${sequence[@]}" -o around.####.exr --frames 1-3 --neighbours 1 -v
[ "$(grep -c 'frames around: 1' stderr) $(grep -c 'frames around: 2' stderr)" = "2 1" ] || fail "--neighbours -v: $(cat stderr)"
holds "$(decibels around.0002.exr $truth) > $(decibels alone.0002.exr $truth) + 1" "--neighbours: $(decibels around.0002.exr $truth)"
exits 0 "$finish" "${sequence[@]}" -o chunk.####.exr --frames 2-2 --neighbours 1 --threads 1
same chunk.0002.exr around.0002.exr "a frame alone has its neighbours"
fails_saying 2 'gathered.exr is the same for all frames: give a sequence' "$finish" gathered.exr $one $two -o x.exr --neighbours 1
fails_saying 2 '--neighbours' "$finish" "${sequence[@]}" -o x.####.exr --frames 1-3 --neighbours -1
cp n.0001.exr kept.exr
oiiotool kept.exr --crop 80x45+0+0 --fullpixels -o n.0001.exr
fails_saying 1 'n.0001.exr: its size differs from that of n.0002.exr' "$finish" "${sequence[@]}" -o x.####.exr --frames 2-2 --neighbours 1

# Non-finite pixels stay as gathered; alpha and depth are unchanged.
picture edit $one nan.exr fill=3x3+50+40 R=nan
exits 0 "$finish" gathered.exr nan.exr $two -o mended.exr
grep -Eq '^dof-finish: .*9 pixels of the renders are missing, not finite or beyond 1e8: they stay as gathered$' stderr || fail "NaN: $(cat stderr)"
for at in 50,40 52,42; do picture pixel mended.exr $at R,G,B | grep -qi nan && fail "NaN is in the picture"; done
holds "$(decibels mended.exr $truth) > $db - 0.2" "NaN costs little"
same mended.exr gathered.exr "alpha stays" "A 1e-5"

# Mistakes are named: another exposure, half a pixel; and none if there is none.
[ -z "$(grep warning stderr | grep -v 'not finite')" ] || fail "warns of a good picture: $(cat stderr)"
picture edit gathered.exr stop.exr 'R*=2' 'G*=2' 'B*=2'
exits 0 "$finish" stop.exr $one $two -o x1.exr
grep -Eq '^dof-finish: warning: the gathered picture is (1.9[0-9]|2.0[0-9]) times as bright' stderr || fail "a stop: $(cat stderr)"
oiiotool gathered.exr --origin +1+0 --fullsize 160x90+0+0 --crop 160x90+0+0 -o moved.exr
oiiotool gathered.exr moved.exr --add --mulc 0.5 -o half.exr
exits 0 "$finish" half.exr $one $two -o x1.exr
grep -Eq '^dof-finish: warning: the gathered picture lies about 0.[3-7] pixels to the right' stderr || fail "half a pixel: $(cat stderr)"

# The headers reveal another lens, which is named with both values; a header that says nothing gives no warning.
for lens in '--fstop 0.2857 0.3 aperture.of.60.mm.radius,.not.63' '--focus-distance 5.15 5 focus.at.5.m,.not.5.15'; do
    read -r option wrong right text <<<"$lens"
    exits 0 "$bin/dof-gather" ldi.exr -o wrong.exr "$option" "$wrong"
    exits 0 "$finish" wrong.exr $one $two -o x1.exr
    [ "$(grep -Ec "^dof-finish: warning: fence/rays_[12].exr: another lens or camera than that of the gathered picture: (an )?$text" stderr)" -eq 2 ] || fail "$option $wrong: $(cat stderr)"
    exits 0 "$bin/dof-gather" ldi.exr -o right.exr "$option" "$right"
    exits 0 "$finish" right.exr $one $two -o x1.exr
    if grep 'another lens' stderr; then fail "$option $right is the same lens"; fi
done
exits 0 "$bin/dof-gather" ldi.exr -o hexagon.exr --blades 6
for k in 1 2; do oiiotool fence/rays_$k.exr --attrib:type=int aperture_blades 6 -o six_$k.exr; done
exits 0 "$finish" gathered.exr six_1.exr six_2.exr -o x1.exr
grep -q 'another lens .*: 6 blades, not no blades' stderr || fail "a hexagon: $(cat stderr)"
exits 0 "$finish" hexagon.exr six_1.exr six_2.exr -o x1.exr
if grep 'another lens' stderr; then fail "two hexagons"; fi
for k in 1 2; do
    picture edit fence/rays_$k.exr silent_$k.exr erase=pinholeFocalLength erase=aperture erase=focus
done
exits 0 "$finish" wrong.exr silent_1.exr silent_2.exr -o x1.exr
if grep 'another lens' stderr; then fail "a header that does not name its lens"; fi

# Another camera, field of view or colour space: named, or converted.
exits 0 "$bin/dof-trace" fence --size 160x90 --views 0 --halves 16 --dolly 0.3 -o moved
exits 0 "$finish" gathered.exr moved/rays_1.exr moved/rays_2.exr -o x1.exr
[ "$(grep -c '^dof-finish: warning: moved/rays_[12].exr: another lens or camera .*: a camera that stands or looks elsewhere (worldToCamera)$' stderr)" -eq 2 ] ||
    fail "another camera: $(cat stderr)"
exits 0 "$bin/dof-gather" ldi.exr --output-colorspace ACEScg -o aces.exr
exits 0 "$finish" aces.exr $one $two -o x1.exr --output-colorspace lin_rec709
[ "$(grep -c 'fence/rays_[12].exr: its colours are in another space than those of aces.exr, and are converted' stderr)" -eq 2 ] ||
    fail "other colours: $(cat stderr)"
holds "$(decibels x1.exr $truth) > $db - 0.3" "colours of another space: $(decibels x1.exr $truth)"

# Renders without their noise, or with that of another: named.
oiiotool $one --median 5x5 -o median_1.exr
oiiotool $two --median 5x5 -o median_2.exr
exits 0 "$finish" gathered.exr median_1.exr median_2.exr -o x1.exr
grep -Eq '^dof-finish: warning: median_1.exr and median_2.exr do not differ by noise' stderr || fail "denoised renders: $(cat stderr)"
exits 0 "$finish" gathered.exr $one gathered.exr -o x1.exr
[ "$(cat stderr)" = "dof-finish: warning: gathered.exr has less noise than its samples tell: give renders as they are, without denoising, and the right numbers of samples" ] ||
    fail "the gathered picture as a render: $(cat stderr)"
oiiotool $one --mulc 1.0001 -o copy.exr
fails_saying 1 'copy.exr: has the same noise as fence/rays_1.exr' "$finish" gathered.exr $one copy.exr -o x.exr
oiiotool $one --crop 160x45+0+0 $two --over -o copy.exr
fails_saying 1 'copy.exr: has the same noise as fence/rays_1.exr' "$finish" gathered.exr $one copy.exr -o x.exr

# Failures: one line that says what to do; the old output stays.
fails_saying 2 'noise of a single render is unknown.*another seed' "$finish" gathered.exr $one -o x.exr
picture edit $two small.exr crop=80x90+0+0
exits 0 "$finish" gathered.exr $one small.exr -o cropped.exr
exits 0 "$bin/dof-trace" fence --size 80x45 --views 0 --halves 4 -o other
fails_saying 1 'other/rays_2.exr: its picture is 80x45, the gathered one 160x90' "$finish" gathered.exr $one other/rays_2.exr -o x.exr
head -c 9000 $two >cut.exr
fails_saying 1 'cut.exr' "$finish" gathered.exr $one cut.exr -o x.exr
fails_saying 1 'missing.exr' "$finish" gathered.exr $one missing.exr -o x.exr
fails_saying 1 'ldi.exr' "$finish" ldi.exr $one $two -o x.exr
fails_saying 2 '--show' "$finish" gathered.exr $one $two -o x.exr --show me
fails_saying 2 '--goal' "$finish" gathered.exr $one $two -o x.exr --goal 0
[ ! -e x.exr ] || fail "a failure wrote x.exr"
cp out.exr old.exr
exits 1 "$finish" gathered.exr $one cut.exr -o old.exr
cmp -s old.exr out.exr || fail "a failure harms the old output"
