#!/bin/bash
# dof-report from the shell: a quick report of the built-in scenes and of ready-made views, its files, and that it
# continues where it stopped; the page in headless Chromium.
. "$(dirname "$0")/../../../tests/tools/check.sh"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
for package in numpy matplotlib OpenImageIO; do
    /usr/bin/python3 -c "import $package" 2>/dev/null || skip "needs python3-${package,,}"
done
report=$bin/dof-report

answers_help dof-report -o out
fails_saying 2 'meadow' "$report" meadow -o out
fails_saying 2 'output' "$report" fence
fails_saying 2 'fence' "$report" fence fence -o out
for wrong in '--size 48' '--reference 0' '--runs 0' '--threads -1'; do
    fails_saying 2 '' "$report" fence -o out $wrong
done
[ ! -e out ] || fail 'wrong usage leaves a folder behind'
echo text >occupied
fails_saying 1 'occupied' "$report" --quick fence -o occupied

# Views from a user: rendered and timed by another program.
exits 0 "$bin/dof-trace" lamps --size 96x54 --views 4 --spp 16 --reference 256 -o 'my views'
exits 0 "$bin/dof-trace" lamps --size 96x54 --views 0 --reference 16 --seed 1 -o drt
cp drt/reference.exr 'my views/drt_16.exr'
sed -i 's/"seconds": {/"seconds": {"drt_16.exr": 0.25,/; s/"center.exr": [0-9.]*/"center.exr": 10/' 'my views/camera.json'

# FLIP comes from a module of PyPI, in the place of which stands a program that prints a figure.
printf '%s\n' '#!/bin/sh' '[ $# = 4 ] && [ -e "$3" ] && [ -e "$4" ] && echo 0.125' >evaluator
chmod +x evaluator
export SPARSELENS_FLIP_PYTHON=$PWD/evaluator

quick=(--quick --size 96x54 --reference 256)
exits 0 "$report" "${quick[@]}" -o out fence grass 'my views'
mv stdout printed
[ ! -s stderr ] || fail "talks on stderr: $(cat stderr)"

# value SCENE METHOD BUDGET COLUMN: prints a field of report.csv. These fields have commas only inside quotes.
value() {
    awk -v scene="$1" -v method="$2" -v budget="$3" -v column="$4" '
        { line = $0; n = 0
          while (line != "") {
              if (line ~ /^"/) { match(line, /^"[^"]*"/); field = substr(line, 2, RLENGTH - 2) }
              else { match(line, /^[^,]*/); field = substr(line, 1, RLENGTH) }
              line = substr(line, RLENGTH + 2); f[++n] = field }
          if (NR == 1) { for (i = 1; i <= n; ++i) at[f[i]] = i; columns = n }
          else if (f[1] == scene && f[2] ", " f[3] == method && f[4] == budget) { print f[at[column]]; exit } }' out/report.csv
}
positive() { awk -v v="$1" 'BEGIN { exit !(v > 0) }' || fail "$2 is '$1', not above 0"; }
is() { awk -v a="$1" -v b="$2" -v t="${4:-1e-9}" 'BEGIN { exit !(a != "" && a - b <= t && b - a <= t) }' || fail "$3 is '$1', not '$2'"; }
rows=29 # for each built-in scene
! grep -q 'planned' out/report.csv || rows=31
[ "$(wc -l <out/report.csv)" -eq $((1 + 2 * rows + 6)) ] || fail "report.csv has $(wc -l <out/report.csv) lines"
for scene in fence grass; do
    for method in 'one view, scatter' 'one view, gather' 'one view, lens normal' '4 strata, layered blend' \
        '4 strata, lens normal' '4 peeled layers, layered blend' '4 peeled layers, lens normal' \
        'centre + 4, selective K=8' 'centre + 4, lens normal' 'centre + 4 at 2x, lens normal' 'centre + 8, selective K=8' 'centre + 8, lens normal'; do
        for column in rays seconds seconds_render seconds_process peak_mb psnr_tonemapped ssim relmse \
            psnr_sampling psnr_layers; do
            positive "$(value $scene "$method" '16 samples' $column)" "$column of $scene, $method"
        done
    done
    positive "$(value $scene 'centre + 4, lens normal' '4 samples' seconds_warp)" "time to warp"
    positive "$(value $scene 'centre + 4, selective K=8' '4 samples' seconds_cluster)" "time to cluster"
    for column in pull_flickering_pixels pull_sparkling_pixels pull_largest; do
        [ -n "$(value $scene 'centre + 4, lens normal' '16 samples' $column)" ] || fail "no $column of $scene"
    done
    positive "$(value $scene 'centre + 4, lens normal' '16 samples' pull_largest)" "the largest second difference of $scene"
    positive "$(value $scene 'accumulated lens views, ' '64 views' seconds_process)" "time to accumulate"
    positive "$(value $scene 'distributed ray tracing, ' '64 rays' psnr_tonemapped)" "quality of ray tracing"
done
for region in in_focus silhouettes; do
    positive "$(value fence 'centre + 4, lens normal' '16 samples' ${region}_psnr_tonemapped)" "quality of $region"
done
grep -qx 'fence, 96x54' printed || fail "the table of times does not say the size: $(head -n 3 printed)"
[ "$(value fence 'centre + 4, lens normal' '16 samples' size)" = 96x54 ] || fail 'the size in report.csv'
is "$(value fence 'centre + 4, lens normal' '16 samples' rays)" 80 'rays of five views'
is "$(value fence 'centre + 8, lens normal' '4 samples' nonfinite_image)" 0 'count of what is not finite'
total=$(for stage in render plan warp cluster process; do value grass 'centre + 8, lens normal' '4 samples' seconds_$stage; done |
    awk '{ sum += $1 } END { print sum }')
is "$(value grass 'centre + 8, lens normal' '4 samples' seconds)" "$total" 'sum of the stages' 1e-5
grep -q 'rays a pixel' printed || fail "no crossing is printed: $(cat printed)"
[ "$(grep -c '^Least error of sparse views' printed)" -eq 3 ] || fail "not a verdict a scene: $(cat printed)"

# The figures equal dof-compare's; times of ready-made views come from camera.json.
compared() { "$bin/dof-compare" "$1" "$2" --json | sed -n "s/^  \"${3:-psnr_tonemapped}\": \(.*\),/\1/p"; }
is "$(value fence 'centre + 4, lens normal' '4 samples' psnr_tonemapped)" \
    "$(compared out/fence/views-5x4/lens-normal.exr out/fence/reference/reference.exr)" 'PSNR of fence'
for figure in $("$bin/dof-compare" drt/reference.exr 'my views/reference.exr' --json | sed -n 's/^  "\(.*\)": [^{]*$/\1/p'); do
    head -n 1 out/report.csv | tr , '\n' | grep -qx "$figure" || fail "report.csv has no $figure"
done
is "$(value fence 'centre + 4, lens normal' '4 samples' psnr_worst)" \
    "$(compared out/fence/views-5x4/lens-normal.exr out/fence/reference/reference.exr psnr_worst)" 'worst PSNR of fence' 1e-6
is "$(value fence 'centre + 4, lens normal' '4 samples' flip)" 0.125 'FLIP of fence'
[ "$(value fence 'centre + 4, lens normal' '4 samples' silhouettes_flip)" = '' ] || fail 'FLIP of a region'
is "$(value fence 'centre + 4, lens normal' '4 samples' psnr_layers)" \
    "$(compared out/fence/views-5x4/many-points.exr out/fence/reference/reference.exr)" 'what the layers lack'
is "$(value fence 'centre + 4, lens normal' '4 samples' psnr_sampling)" \
    "$(compared out/fence/views-5x4/lens-normal.exr out/fence/views-5x4/many-points.exr)" 'what lens points lack'
is "$(value my-views 'distributed ray tracing, ' '16 rays' psnr_tonemapped)" \
    "$(compared 'my views/drt_16.exr' 'my views/reference.exr')" 'PSNR of ready-made ray tracing'
is "$(value my-views 'distributed ray tracing, ' '16 rays' seconds)" 0.25 'time of ready-made ray tracing'
is "$(value my-views 'one view, lens normal' '16 samples' seconds_render)" 10 'time of a ready-made view'

# Pictures.
for method in 'centre-p-4-lens-normal-16-samples' 'one-view-scatter-4-samples' 'distributed-ray-tracing-64-rays'; do
    for kind in '' -difference; do
        oiiotool --info "out/pictures/grass/$method$kind.png" >/dev/null || fail "no picture $method$kind"
    done
done
for plot in fence-seconds fence-rays fence-all-rays my-views-seconds; do
    [ -s out/plots/$plot.svg ] || fail "no plot $plot.svg"
    oiiotool --info out/plots/$plot.png >/dev/null || fail "no plot $plot.png"
done

# The page is self-contained.
! grep -qE 'https?:|src="[^d]|<link|url\(' out/index.html || fail 'the page needs other files'
[ "$(grep -c '<section>' out/index.html)" -eq 3 ] || fail 'not a section a scene'

# Nothing is measured again; a changed option measures only what it changes, and lost files are made again.
stamps() { (cd out/steps && find . -name '*.json' -printf '%p %T@\n' | sort); }
newer() { stamps >after; comm -13 before after | sed 's/ .*//'; }
stamps >before
cp out/report.csv first.csv
exits 0 "$report" "${quick[@]}" -o out fence grass 'my views'
[ -z "$(newer)" ] || fail "measured again: $(newer)"
cmp -s first.csv out/report.csv || fail 'another report from the same measurements'
rm out/fence/views-5x4/warped.exr
exits 0 "$report" "${quick[@]}" -o out fence grass 'my views'
[ "$(newer | wc -l)" -eq 1 ] || fail "more than the lost file was made again: $(newer)"
stamps >before
exits 0 "$report" --quick --size 96x54 -o out grass --reference 512
[ "$(newer)" = ./grass/reference.json ] || fail "--reference measured again: $(newer)"
exits 0 env SPARSELENS_FLIP_PYTHON=false "$report" --quick -o small grass --size 40x24 --runs 2 --threads 1 -v
python3 -c 'import csv; assert {row["flip"] for row in csv.DictReader(open("small/report.csv"))} == {""}' ||
    fail 'FLIP without its module'
grep -q 'grass/reference' stderr || fail "-v does not name the steps: $(cat stderr)"
oiiotool --info small/grass/reference/reference.exr | grep -q '40 x  *24' || fail "--size has no effect"
# A slow step is run fewer times, on a loaded machine too.
awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "runs") at = i } NR > 1 { ++runs[$at] } END { for (r in runs) if (r != 1 && r != 2) exit 1; exit !runs[2] }' \
    small/report.csv || fail "--runs has no effect: $(cut -d , -f 1-6 small/report.csv)"
grep -q 'threads: 1' small/index.html || fail "--threads has no effect"

# On a terminal it shows its progress and the time left; elsewhere nothing.
if script -qec true /dev/null >terminal 2>&1 </dev/null; then
    rm small/grass/views-5x4/warped.exr
    script -qec "'$report' --quick grass -o small --size 40x24 --runs 2 --threads 1" /dev/null >terminal </dev/null
    grep -Eq 'dof-report: [0-9]+ of [0-9]+, [0-9]+:[0-9]{2} left: grass/views-5x4/warped' terminal ||
        fail "no progress on a terminal: $(head -c 300 terminal)"
else
    echo "skipped: progress on a terminal: no pseudo-terminal can be made ($(head -c 300 terminal))"
fi

# The page in a browser: pictures are there, and moving the slider changes the picture.
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
[ -n "$chromium" ] || { echo 'skipped: the page in a browser: chromium is not installed'; exit 0; }
# shot NAME SCRIPT: a screenshot of the page after the script has run in it.
shot() {
    { cat out/index.html; echo "<script>$2</script>"; } >"$1.html"
    "$chromium" --headless=new --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$scratch/profile" \
        --window-size=1000,900 --virtual-time-budget=5000 --screenshot="$scratch/$1.png" "file://$scratch/$1.html" \
        >chromium.log 2>&1 || fail "chromium: $(tail -3 chromium.log)"
    [ -s "$1.png" ] || fail "no screenshot: $(tail -3 chromium.log)"
}
set_control() { echo "{ const c = document.querySelector('.viewer .$1'); c.value = '$2'; c.dispatchEvent(new Event('input')); }"; }
differs() { # A B WHAT: in more than 200 pixels
    local count
    count=$(oiiotool "$1.png" "$2.png" --absdiff --maxchan --rangecheck 0 0.1 2>&1 -o diff.exr | sed -n 's/ *\([0-9]*\) *> .*/\1/p')
    [ "${count:-0}" -gt 200 ] || fail "$3 changes nothing: ${count:-no} pixels"
}
zoom=$(set_control zoom 4)
shot left "$zoom $(set_control slider 5)"
shot right "$zoom $(set_control slider 95)"
shot difference "$zoom $(set_control mode difference)"
shot flipped "$zoom $(set_control mode flip) $(set_control slider 0)"
oiiotool --stats left.png | awk '/Stats StdDev/ { exit !($3 > 1) }' || fail 'the page is empty'
differs left right 'the slider'
differs left difference 'the difference'
differs right flipped 'flipping'
echo "dof-report: fine"
