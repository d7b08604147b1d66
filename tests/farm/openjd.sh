# The templates of Open Job Description: the specification allows them, and run as in a session they give the same as
# the tools without them.
. "$(dirname "$0")/../tools/check.sh"
python3 -c 'import jsonschema, yaml' 2>/dev/null || skip "needs python3-jsonschema and python3-yaml"
farm=$source_dir/tests/farm
templates_tool() { python3 "$farm/openjd_template.py" "$@" >log 2>&1 || fail "$* ($(tail -3 log))"; }
templates=("$source_dir"/share/openjd/*.yaml)
[ "${#templates[@]}" -eq 2 ] || fail "not two templates: ${templates[*]}"

templates_tool check "$farm/jobtemplate-2023-09.json" "${templates[@]}" "$source_dir/share/openjd/blender/template.yaml"
templates_tool faults "$farm/jobtemplate-2023-09.json" "${templates[@]}"

# The template for Blender gives it each word apart, and nothing in the options is executed (tests/blender runs it).
mkdir stand-in
printf '%s\n' '#!/bin/sh' 'printf "%s|" "$@" >>asked' 'echo >>asked' >stand-in/blender
chmod +x stand-in/blender
mkdir session
with_blender() { PATH=$PWD/stand-in:$PATH templates_tool run "$source_dir/share/openjd/blender/template.yaml" session Scene='my shot.blend' Output='//out/####' "$@"; }
with_blender Frames=-1,2
with_blender Frames=1 Script=views.py Options='--looks "--cat-eye 1" $(touch run)'
printf '%s\n' '-b|my shot.blend|--command|sparselens|-o|//out/####|--frames=-1|' '-b|my shot.blend|--command|sparselens|-o|//out/####|--frames=2|' \
    '-b|my shot.blend|-P|views.py|--|--picture|-o|//out/####|--frames=1|--looks|--cat-eye 1|$(touch|run)|' | cmp - asked || fail "Blender: $(cat asked)"
rm asked
SLURM_ARRAY_TASK_ID=7 PATH=$PWD/stand-in:$PATH bash "$source_dir/share/slurm/blender.sh" 'my shot.blend' '//out/####' --samples 4
echo '-b|my shot.blend|--command|sparselens|-o|//out/####|--frames=7|--samples|4|' | cmp - asked || fail "Slurm and Blender: $(cat asked)"

# Frames -1, 1, 2 and 3, with four equal views.
PATH=$bin:$PATH
dof-trace fence --size 48x27 --views 2 --spp 1 -o still
mkdir 'the views'
for number in -001 0001 0002 0003; do
    for file in center view_0 view_1; do cp still/$file.exr "the views/$file.$number.exr"; done
done
ldi-warp still/center.exr still/view_0.exr still/view_1.exr -o - | dof-gather - -o expected.exr --focus-distance 3 --fstop 1
for template in "${templates[@]}"; do
    rm -rf out session && mkdir session
    templates_tool run "$template" session Views="$scratch/the views" Output="$scratch/out" Frames=-1,1-3 FramesPerTask=2 \
        LensOptions='--focus-distance 3 --fstop 1'
    [ "$(ls out | wc -l)" -eq 8 ] || fail "$template: not four LDIs and pictures: $(ls out)"
    for number in -001 0001 0002 0003; do cmp out/picture.$number.exr expected.exr || fail "$template: frame $number"; done
    [ "$(grep -c openjd_fail log)" -eq 0 ] || fail "$template: $(cat log)"
    grep -q '^openjd_status: dof-gather: frame -1' log || fail "$template: no openjd_status ($(cat log))"
    tasks=$(grep -cE '^(warp|gather) ' log)
    case $template in
    *chunks*) [ "$tasks" -eq 6 ] || fail "$template: $tasks tasks, not 2 of 3 chunks (-1, 1-2, 3)" ;;
    *) [ "$tasks" -eq 8 ] || fail "$template: $tasks tasks, not 2 of 4 frames" ;;
    esac
done
# Options with blanks in quotes; an unclosed quote is a failure, and nothing in the options is executed.
for template in "${templates[@]}"; do
    echo '{"name": "my lens", "blades": 6}' >'my lens.json'
    rm -rf out
    templates_tool run "$template" session Views="$scratch/the views" Output="$scratch/out" Frames=1 \
        LensOptions="--focus-distance 3 --fstop 1 --lens '$scratch/my lens.json'"
    exrheader out/picture.0001.exr | grep '^lensModel .*"my lens"' >/dev/null || fail "$template: --lens with a blank"
    for options in '--lens "my lens.json' '$(touch run)' '; touch run'; do
        if python3 "$farm/openjd_template.py" run "$template" session Views="$scratch/the views" Output="$scratch/out2" \
            Frames=1 LensOptions="$options" >log 2>&1; then fail "$template: no failure: $options"; fi
    done
    [ ! -e run ] || fail "$template runs what stands in the options"
done
if python3 "$farm/openjd_template.py" run "${templates[0]}" session Views="$scratch/no views" Output="$scratch/out" Frames=9 >log 2>&1; then
    fail "a frame without views is no failure: $(cat log)"
fi
grep -q '^openjd_fail: ldi-warp: ' log || fail "no openjd_fail: $(cat log)"
