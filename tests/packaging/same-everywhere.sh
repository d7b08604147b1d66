#!/bin/bash
# The archives for other kinds of machines make the same bytes from the same views: LDIs and pictures of all scenes of the
# laboratory, and the pictures of tools/demo.sh; by qemu or wine where this machine cannot run them.
#   bash same-everywhere.sh BIN_DIR ARCHIVE...
. "$(dirname "$0")/../tools/check.sh"
[ $# -ge 2 ] || fail "name an archive of tools/release.sh --all"
. "$source_dir/tests/packaging/windows-programs.sh"
folder_of() { # ARCHIVE: what it unpacks to
    local name=${1##*/}
    name=${name%.zip}
    echo "$scratch/${name%.tar.xz}"
}
for archive in "${@:2}"; do
    cmake -E tar xf "$archive" # beside the folders of earlier ones
    windows_programs "$(folder_of "$archive")/bin"
    exits 0 "$(folder_of "$archive")/bin/dof-gather" --version
done
scenes=$("$bin/dof-trace" --help | sed -nE '/SCENE :/s/.*\{(.*)\}.*/\1/p' | tr , ' ')
[ "$(wc -w <<<"$scenes")" -ge 10 ] || fail "dof-trace lists no scenes"
made() { # DIR SCENE TO: the LDI, pictures of two qualities and another method, and one stopped down
    exits 0 "$1/ldi-warp" "$2/center.exr" "$2"/view_*.exr -o "$3.warped.exr"
    exits 0 "$1/ldi-cluster" "$3.warped.exr" -o "$3.ldi.exr"
    for by in '--quality draft' '--quality final' '--method selective' '--lens-radius 0.02'; do
        exits 0 "$1/dof-gather" "$3.ldi.exr" $by -o "$3.${by##* }.exr"
    done
}
for scene in $scenes; do
    exits 0 "$bin/dof-trace" "$scene" --size 160x90 --views 4 --spp 4 -o "$scene"
    made "$bin" "$scene" here
    for archive in "${@:2}"; do
        made "$(folder_of "$archive")/bin" "$scene" there
        for file in here.*; do
            cmp "$file" "there.${file#here.}" || fail "$scene: ${file#here.} differs in ${archive##*/}"
        done
        echo "$scene: $(ls here.* | wc -l) files are the same in ${archive##*/}"
        rm there.*
    done
    rm here.*
done

# The pictures of the demo. Its scene is traced here. oiiotool writes the names of folders into pictures.
demo() { # DIR FOLDER
    mkdir tools
    for tool in dof-compare dof-gather ldi-cluster ldi-warp; do ln -s "$1/$tool" tools/; done
    ln -s "$bin/dof-trace" tools/
    exits 0 "$source_dir/tools/demo.sh" --bin "$PWD/tools" --size 320x180 --spp 4 --reference 16 -o "$PWD/demo"
    rm -r tools
    mv demo "$2"
}
demo "$bin" demo-here
for archive in "${@:2}"; do
    demo "$(folder_of "$archive")/bin" demo-there
    same=0
    while read -r file; do
        cmp "demo-here/$file" "demo-there/$file" || fail "the demo: $file differs in ${archive##*/}"
        same=$((same + 1))
    done < <(cd demo-here && find . -name '*.exr' -o -name '*.png')
    [ $same -ge 15 ] || fail "the demo made only $same pictures"
    echo "the demo: $same pictures are the same in ${archive##*/}"
    rm -r demo-there
done
