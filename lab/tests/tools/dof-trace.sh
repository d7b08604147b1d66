. "$(dirname "$0")/../../../tests/tools/check.sh"
trace=$bin/dof-trace
small=(--size 48x27 --spp 4 --views 2)

answers_help dof-trace

differ() { ! cmp -s "$1" "$2" || fail "$1 and $2 are the same: $3"; }
same() { cmp -s "$1" "$2" || fail "$1 and $2 differ: $3"; }
header() { grep -q -e "$2" <<<"$(exrheader "$1")" || fail "$1 has no '$2': $(exrheader "$1")"; }

# Every scene gives the requested files, and no others.
for scene in fence grass planes slant lamps mirror mist element macro \
    plane-mirror brushed-mirror glass-slab curved-mirrors glossy-floor fair; do
    exits 0 "$trace" $scene -o "$scene" "${small[@]}" --lens-views 2 --reference 3 --deep peel:3 --deep strata:3 --deep visible
    [ "$(ls -A "$scene" | tr '\n' ' ')" = "camera.json center.exr deep_peel.exr deep_strata.exr deep_visible.exr lens_0000.exr \
lens_0001.exr reference.exr view_0.exr view_1.exr " ] || fail "$scene: $(ls -A "$scene")"
    [ ! -s stderr ] || fail "$scene talks on stderr: $(cat stderr)"
    header $scene/deep_peel.exr deepscanline
done
differ fence/center.exr grass/center.exr "the scene has no effect"

# Every picture has its camera; rim views are displaced to the right and to the left.
header fence/center.exr 'worldToCamera'
header fence/view_0.exr '^ *-0\.06 '
header fence/view_1.exr '^ *0\.06 '
for attribute in 'worldToNDC' 'aperture.*: 0.3' 'focus.*: 5' 'pinholeFocalLength.*: 36' 'sparselens:sensorWidth.*: 36' \
    'sparselens:metresPerUnit.*: 1'; do
    for file in center view_0 lens_0000 reference deep_peel deep_strata deep_visible; do header fence/$file.exr "$attribute"; done
done
for key in '"width":48,' '"height":27,' '"focal_mm":36.0,' '"sensor_width_mm":36.0,' '"focus_distance":5.0,' \
    '"fstop":0.3,' '"lens_radius":0.06,' '"views":\[\[1.0,0.0\],\[-1.0,' '"view_spp":4,' '"ref_spp":3,' \
    '"view_1.exr":[0-9.]*'; do
    grep -q -e "$key" <<<"$(tr -d ' \n' <fence/camera.json)" || fail "no $key in $(cat fence/camera.json)"
done

# changes FILE OPTION...: the option changes that file of the scene fence.
changes() {
    local file=$1 default others=()
    shift
    for default in '--size 48x27' '--spp 4' '--views 2' '--reference 3' '--deep peel:3'; do
        [ "${default% *}" = "$1" ] || others+=($default)
    done
    exits 0 "$trace" fence -o changed "${others[@]}" "$@"
    differ "fence/$file" "changed/$file" "$*"
}
changes center.exr --spp 9
changes reference.exr --reference 4
changes center.exr --size 40x27
changes center.exr --overscan 3
changes center.exr --light area
changes center.exr --light albedo
changes center.exr --light normal
changes reference.exr --seed 1
changes center.exr --dolly 0.1
changes reference.exr --dolly 0.1
changes deep_peel.exr --dolly 0.1
changes center.exr -d float
changes center.exr --focal-length 50
changes center.exr --sensor-width 24
changes view_0.exr --fstop 1
changes view_0.exr --lens-radius 0.03
changes view_0.exr --scene-unit 0.5
changes reference.exr --focus-distance 3
# Looks of the lens are the same as in dof-gather; views over the lens show the shape of the aperture.
picture make aperture.exr 4x3 Y=0 fill=4x2 Y=1
echo '{"squeeze": 2}' >lens.json
for look in '--blades 5' '--squeeze 2' '--spherical 0.5' '--aperture aperture.exr' '--cat-eye 1' '--axial-chromatic 0.1' \
    '--field-curvature 0.5' '--astigmatism 0.5' '--tilt 20,0' '--breathing 1' '--lens lens.json'; do
    # shellcheck disable=SC2086
    changes reference.exr $look
done
for text in '--blades 2' '--blade-curvature 1.5' '--blade-rotation x' '--squeeze 0' '--spherical 2' '--cat-eye -1' \
    '--axial-chromatic 6' '--axial-chromatic-type pink' '--field-curvature 1.1' '--tilt 3' '--breathing -1' \
    '--highlight-gain 0.5'; do
    # shellcheck disable=SC2086
    fails_saying 2 "${text%% *}" "$trace" fence -o x "${small[@]}" --reference 3 $text
done
exits 0 "$trace" fence -o eye "${small[@]}" --reference 3 --cat-eye 1
exits 0 "$trace" fence -o dark "${small[@]}" --reference 3 --cat-eye 1 --cat-eye-darkening
differ eye/reference.exr dark/reference.exr "--cat-eye-darkening"
exits 0 "$trace" fence -o red "${small[@]}" --reference 3 --axial-chromatic 0.1
exits 0 "$trace" fence -o blue "${small[@]}" --reference 3 --axial-chromatic 0.1 --axial-chromatic-type blue-yellow
differ red/reference.exr blue/reference.exr "--axial-chromatic-type"
exits 0 "$trace" fence -o blades "${small[@]}" --lens-views 2 --reference 3 --blades 5
exits 0 "$trace" fence -o turned "${small[@]}" --reference 3 --blades 5 --blade-rotation 20
exits 0 "$trace" fence -o bulging "${small[@]}" --reference 3 --blades 5 --blade-curvature 0.5
differ blades/reference.exr turned/reference.exr "--blade-rotation"
differ blades/reference.exr bulging/reference.exr "--blade-curvature"
differ blades/lens_0001.exr fence/lens_0001.exr "--blades and --lens-views"
exits 0 "$trace" fence -o bright "${small[@]}" --reference 3 --highlight-gain 3 --highlight-threshold 0.2 --highlight-knee 0.2
exits 0 "$trace" fence -o plain "${small[@]}" --reference 3
differ plain/reference.exr bright/reference.exr "--highlight-gain"
same plain/view_1.exr bright/view_1.exr "views with --highlight-gain"
exits 0 "$trace" fence -o less "${small[@]}" --reference 3 --highlight-gain 3 --highlight-threshold 0.4 --highlight-knee 0.2
exits 0 "$trace" fence -o softer "${small[@]}" --reference 3 --highlight-gain 3 --highlight-threshold 0.2 --highlight-knee 0.6
differ less/reference.exr bright/reference.exr "--highlight-threshold"
differ softer/reference.exr bright/reference.exr "--highlight-knee"
fails_saying 2 '--lens-views' "$trace" fence -o x "${small[@]}" --lens-views 2 --spherical 1
changes reference.exr --focus-distance inf
changes deep_peel.exr --deep peel:2
changes view_1.exr --views 4
header changed/center.exr 'R, 16-bit'
exits 0 "$trace" fence -o changed "${small[@]}" --deep strata:2
differ fence/deep_strata.exr changed/deep_strata.exr "--deep strata:2"
exits 0 "$trace" fence -o few --size 8x4 --views 0 -v
[ "$(ls few | tr '\n' ' ')" = 'camera.json center.exr ' ] || fail "--views 0: $(ls few)"
grep -q 'center.exr' stderr || fail "-v says nothing"
exits 0 "$trace" fence -o float --size 8x4 --views 0 -d float --overscan 3
header float/center.exr 'R, 32-bit'
header float/center.exr 'dataWindow.*(-3 -3) - (10 6)'
header float/center.exr 'displayWindow.*(0 0) - (7 3)'

# Options that ask for more pictures do not change the others, and neither do threads.
exits 0 "$trace" fence -o again "${small[@]}" --threads 1
for file in center view_0 view_1; do same "fence/$file.exr" "again/$file.exr" "--threads 1"; done

# Without a lens every view equals the centre view, except the camera's own attributes.
for lens in '--lens-radius 0' '--fstop inf'; do
    exits 0 "$trace" grass -o still "${small[@]}" $lens
    same still/center.exr still/view_0.exr "$lens"
    same still/center.exr still/view_1.exr "$lens"
    grep -q '"fstop": null' still/camera.json || fail "$lens: $(cat still/camera.json)"
done

# The shutter: pictures with motion blur, or views of its moments, whose files state the moment and the camera then.
exits 0 "$trace" fair -o open "${small[@]}" --reference 3 --motion-blur
exits 0 "$trace" fair -o moments "${small[@]}" --reference 3 --moments 2
[ "$(ls moments | tr '\n' ' ')" = "camera.json center_0.exr center_1.exr reference.exr view_0_0.exr view_0_1.exr \
view_1_0.exr view_1_1.exr " ] || fail "--moments: $(ls moments)"
differ fair/reference.exr open/reference.exr "--motion-blur"
differ fair/center.exr open/center.exr "views with --motion-blur"
same open/reference.exr moments/reference.exr "--moments, and --motion-blur"
exits 0 "$trace" fair -o rolling "${small[@]}" --reference 3 --moments 2 --rolling-shutter 0.25
differ open/reference.exr rolling/reference.exr "--rolling-shutter"
same moments/view_1_0.exr rolling/view_1_0.exr "a moment with --rolling-shutter"
for k in 0 1; do
    header moments/center_$k.exr "sparselens:moment (type int): $k"
    header moments/view_1_$k.exr 'sparselens:moments (type int): 2'
done
header moments/center_0.exr '(0.999987 0 -0.00499998 0$' # the camera pans
header moments/center_1.exr '(0.999987 0 0.00499998 0$'
exits 0 "$bin/ldi-warp" moments/center_%s.exr moments/view_0_%s.exr moments/view_1_%s.exr -o moments/ldi_%s.exr
exits 0 "$bin/dof-gather" moments/ldi_%s.exr -o moments/picture.exr
exits 0 "$trace" fence -o unmoved "${small[@]}" --reference 3 --motion-blur
for file in center view_1 reference; do same fence/$file.exr unmoved/$file.exr "--motion-blur where nothing moves"; done
exits 0 "$trace" fence -o nearer "${small[@]}" --dolly 0.1
header nearer/center.exr '^ *0 0 -0.1 1'
for wrong in '--moments 0' '--moments 65' '--moments 3' '--moments 2 --plan p.json' '--rolling-shutter 0' '--rolling-shutter 1.5'; do
    # shellcheck disable=SC2086
    fails_saying 2 '--moments|--spp|--rolling-shutter' "$trace" fair -o x "${small[@]}" $wrong
done

# Two halves for dof-finish have independent noise, of each other and of the reference, and state their number of rays.
exits 0 "$trace" fence -o halves "${small[@]}" --reference 3 --halves 6
same fence/reference.exr halves/reference.exr "--halves"
for pair in 'rays_1 rays_2' 'rays_1 reference' 'rays_2 reference'; do
    read -r one other <<<"$pair"
    picture same halves/$one.exr halves/$other.exr 0.01 >found && fail "$pair show the same noise"
    header halves/$one.exr '^sparselens:samples.*: 3$'
    header halves/$other.exr '^sparselens:samples.*: 3$'
done
exits 0 "$trace" fence -o halves2 "${small[@]}" --halves 6 --seed 1
picture same halves/rays_1.exr halves2/rays_1.exr 0.01 >found && fail "--seed has no effect on --halves"
exits 0 "$trace" fence -o looks "${small[@]}" --halves 6 --blades 5
picture same looks/rays_1.exr looks/rays_2.exr 0.01 >found && fail "halves with looks show the same noise"
grep -q '"half_spp": 3' halves/camera.json || fail "camera.json: $(cat halves/camera.json)"
exrheader halves/center.exr | grep -q '^sparselens:samples' && fail 'a view says how many rays it has'

# Wrong usage.
fails_saying 2 'SCENE' "$trace" -o out
fails_saying 2 'meadow' "$trace" meadow -o out
fails_saying 2 'output' "$trace" fence
for wrong in '--spp 0' '--views -1' '--lens-views x' '--reference 0' '--halves 0' '--halves 3' '--size 48' '--size 0x4' '--size 48x27x2' \
    '--size 65536x65536' '--overscan -1' '--seed 64' '--light moon' '-d double' '--deep peel' '--deep visible:2' '--deep peel:0' '--deep skin:3' \
    '--fstop abc' '--fstop 0' '--lens-radius -1' '--focus-distance 0' '--focal-length inf' '--threads -1'; do
    fails_saying 2 '' "$trace" fence -o out $wrong
done
fails_saying 2 'fstop' "$trace" fence -o out --fstop 2 --lens-radius 1
[ ! -e out ] || fail 'wrong usage leaves a folder behind'

# Folders: made with their parents, with any name; otherwise an error names the folder.
exits 0 "$trace" fence -o "deep/er/a folder 'quoted'" --size 4x4 --views 0
[ -e "deep/er/a folder 'quoted'/center.exr" ] || fail 'no folder was made'
echo text >occupied
fails_saying 1 'occupied' "$trace" fence -o occupied --size 4x4
fails_saying 1 'occupied' "$trace" fence -o occupied/below --size 4x4
[ "$(cat occupied)" = text ] || fail 'a file in the way was touched'
