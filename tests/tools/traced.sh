#!/bin/bash
# Traces what the other scripts share (traced, check.sh), before they run. It is made once, also by scripts side by side,
# and again when the tools are newer. In an installed folder it is left in the scratch folder.
#   bash traced.sh BIN_DIR
. "$(dirname "$0")/check.sh"
for scene in fence grass; do
    for size in 96x54 160x90; do traced $scene $size $scene-$size; done
done
for name in center view_0 view_1 view_2 view_3 ldi rays_1 rays_2 reference; do
    [ -s "grass-96x54/$name.exr" ] || fail "no $name.exr: $(ls grass-96x54)"
done

mkdir -p build/bin # its tools are those of BIN_DIR
ln -s "$bin"/* build/bin
touch build/CMakeCache.txt
bin=$PWD/build/bin
made() { ls -A build/traced; }
for k in 1 2 3 4; do traced fence 96x54 $k & done
wait
[ "$(made | wc -l)" -eq 1 ] || fail "side by side: $(made)"
for k in 1 2 3 4; do diff -r fence-96x54 $k || fail "another picture: $k"; done
once=$(made)
traced fence 96x54 again
[ "$(made)" = "$once" ] || fail "made twice: $once, $(made)"
rm build/bin/dof-trace
cp "$(dirname "$(readlink build/bin/ldi-warp)")/dof-trace" build/bin
traced fence 96x54 again
[ "$(made | wc -l)" -eq 1 ] && [ "$(made)" != "$once" ] || fail "not made for a newer tool: $(made)"
rm build/CMakeCache.txt # an installed folder
rm -r build/traced
traced fence 96x54 installed
[ ! -e build/traced ] || fail "made beside installed tools"
