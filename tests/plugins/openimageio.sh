#!/bin/bash
# The reader of .dof files in programs that use OpenImageIO: it gives dof-gather's pixels, channels and metadata, and
# what is wrong with a file or a query is an error in words. Eight traps of such readers have a test each.
#   bash openimageio.sh BIN_DIR MODULE_DIR
. "$(dirname "$0")/../tools/check.sh"
modules=$2 module=$2/dof.imageio.so
export PATH=$bin:$PATH OIIO_LIBRARY_PATH=$modules
reader=$bin/sparselens-reader
same() { picture same "$@" >found 2>&1 || fail "$1 and $2 differ ($(cat found))"; }

# A surface before another one, in files with and without overscan, with a layer of floats.
picture make flat.exr 160x90 R=noise:1 G=noise:2 B=noise:3 A=1 diffuse.R=noise:4 Z=3 fill=60x40+30+20 R*=0.5 Z=1.5 all= half=R,G,B,A
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.05)
cat >shot.dof <<'END'
{"ldi": "flat.exr", "focal-length": 50, "sensor-width": 36, "lens-radius": 0.05, "focus": 3}
END
exits 0 dof-gather flat.exr -o gathered.exr "${lens[@]}" --focus-distance 3

exits 0 dof-gather flat.exr -o float.exr "${lens[@]}" --focus-distance 3 -d float

# Trap 4: programs read tiles of one reader from several threads.
exits 0 "$reader" threads 'shot.dof?tiles=32&d=float' float.exr
if nm -D "$module" | grep -qE '__(asan|tsan)_'; then
    echo "skipped: programs without sanitizers cannot load the module"
    exit 0
fi

# Pixels, channels, windows and metadata are those of dof-gather.
exits 0 oiiotool shot.dof -o out.exr
same out.exr gathered.exr
attributes() { oiiotool --info -v "$1" | grep -vE '^ *(Reading|[^ ]+ *: +[0-9]+ x|DateTime|Software|Exif:ImageHistory|dof-gather|oiio:)' | grep -v ' -o '; }
diff <(attributes shot.dof) <(attributes gathered.exr) >found || fail "other metadata: $(cat found)"
SPARSELENS_NO_HISTORY='' exits 0 oiiotool --info -v shot.dof
grep -q 'Software: "sparselens .* : dof-gather .*flat.exr .*--focus-distance 3' stdout || fail "no history: $(cat stdout)"
exits 0 oiiotool 'shot.dof?focus=1.5&blades=5&quality=final' -o out.exr
exits 0 dof-gather flat.exr -o expected.exr "${lens[@]}" --focus-distance 1.5 --blades 5 --quality final
same out.exr expected.exr
picture edit flat.exr over.exr crop=100x60+20+10
printf '{"ldi": "%s", "focal-length": 50, "sensor-width": 36, "lens-radius": 0.2, "focus": 9}\n' over.exr >over.dof
exits 0 oiiotool over.dof -o out.exr
exits 0 dof-gather over.exr -o expected.exr --focal-length 50 --sensor-width 36 --lens-radius 0.2 --focus-distance 9
same out.exr expected.exr
for pair in "$(oiiotool --info -v out.exr)" "$(oiiotool --info -v expected.exr)"; do grep -E 'pixel data origin|full/display' <<<"$pair"; done | sort | uniq -c >found
grep -qv ' 2 ' found && fail "other windows: $(cat found)"
exits 0 oiiotool 'shot.dof?d=float&channels=diffuse' -o out.exr
exits 0 dof-gather flat.exr -o expected.exr "${lens[@]}" --focus-distance 3 -d float --channels diffuse
same out.exr expected.exr

# What programs do with pictures.
for name in shot.dof gathered.exr; do
    exits 0 oiiotool "$name" --resize 80x45 -o "resized-${name%.*}.exr"
    exits 0 maketx "$name" -o "texture-${name%.*}.exr"
done
same resized-shot.exr resized-gathered.exr
same texture-shot.exr texture-gathered.exr
cp flat.exr seq.0001.exr
picture edit flat.exr seq.0002.exr R=0.25
sed 's/flat.exr/seq.%04d.exr/; s/"focus": 3/"focus": {"1": 3, "2": 1.5}/' shot.dof >seq.dof
exits 0 oiiotool --frames 1-2 'seq.dof?frame=#' -o out.#.exr
exits 0 dof-gather seq.####.exr -o expected.####.exr "${lens[@]}" --focus-distance 1:3,2:1.5
for frame in 0001 0002; do same out.$frame.exr expected.$frame.exr; done

# The moments of a shutter.
cp seq.0001.exr moments_0.exr
picture edit seq.0002.exr moments_1.exr crop=100x60+20+10
sed 's/flat.exr/moments_%s.exr/' shot.dof >moments.dof
exits 0 oiiotool moments.dof -o out.exr
exits 0 dof-gather moments_%s.exr -o expected.exr "${lens[@]}" --focus-distance 3
same out.exr expected.exr

# Tiles, with smaller sizes that are proxies.
exits 0 oiiotool 'shot.dof?tiles=32' -o tiles.exr
for level in 0 1 2 3; do
    exits 0 oiiotool tiles.exr --selectmip $level -o level.exr
    exits 0 dof-gather flat.exr -o expected.exr "${lens[@]}" --focus-distance 3 --proxy $((1 << level))
    same level.exr expected.exr
done
exits 0 oiiotool 'over.dof?tiles=32&proxy=2' -o out.exr # whatever sizes there are

# Trap 1: a reader that is "procedural" and cannot open a file ends oiiotool 2.4 by a signal.
# Trap 2: the reason is seen if the file exists; behind a query oiiotool has its own words.
says() { # TEXT COMMAND...: it fails, not by a signal, and says that
    local text=$1
    shift
    exits 1 "$@"
    cat stdout stderr | grep -qE "$text" || fail "$* says $(cat stdout stderr)"
}
printf '{"ldi": "none.exr"}' >none.dof
printf '{"ldi": "flat.exr", "fstop": "wide"}' >wide.dof
printf '{"ldi": "flat.exr", "unknown": 1}' >unknown.dof
printf '{"lens": 1}' >empty.dof
printf '{' >cut.dof
head -c 3000000 /dev/urandom >random.dof
printf '{"ldi": "random.dof"}' >loop.dof
says 'none.exr: cannot open' oiiotool none.dof -o out.exr
says "fstop.*'wide'" oiiotool wide.dof -o out.exr
says 'unknown: is not a setting' oiiotool unknown.dof -o out.exr
says 'ldi: is missing' oiiotool empty.dof -o out.exr
says 'not JSON' oiiotool cut.dof -o out.exr
says 'larger than 1 MB' oiiotool random.dof -o out.exr
says 'not an OpenEXR|not an EXR|random.dof' oiiotool loop.dof -o out.exr
says 'none.exr: cannot open' maketx none.dof -o out.exr
says 'does not exist|not a .dof file' oiiotool nothing.dof -o out.exr
mkdir folder.dof
says . oiiotool folder.dof -o out.exr
for query in fstop= fstop fstop=x unknown=1 '' '?' 'fstop=2?fstop=3' 'a=b=c' 'focus=nan' 'proxy=99999' "$(printf 'x%.0s' {1..5000})=1" $'fstop=2\nfoo=3'; do
    code=0
    oiiotool "shot.dof?$query" -o out.exr >stdout 2>&1 || code=$?
    [ $code -le 1 ] || fail "the query '$query' ends oiiotool with $code"
done

# Trap 3: programs open a file twice, so opening asks for the header only. Trap 5: a program that reads other files does
# not even start dof-view.
mkdir spy
cat >spy/dof-view <<END
#!/bin/bash
tee -a $scratch/requests | "$bin/dof-view" "\$@"
END
chmod +x spy/dof-view
SPARSELENS_BIN=$scratch/spy exits 0 oiiotool --info gathered.exr
[ ! -e requests ] || fail "reading an EXR file starts dof-view"
SPARSELENS_BIN=$scratch/spy exits 0 oiiotool --info -v 'shot.dof?tiles=32'
grep -q '"header"' requests || fail "dof-view is not found by SPARSELENS_BIN"
if grep '"tile"\|"picture"' requests; then fail "opening asks for pixels"; fi

# Trap 5: the module is thin: it links no other library than the program's, and exports nothing but its own.
readelf -d "$module" | sed -nE 's/.*\(NEEDED\).*\[(.*)\]/\1/p' |
    grep -vE '^(libOpenImageIO(_Util)?|libstdc\+\+|libgcc_s|libc|libm|libasan|libubsan|libtsan)\.so|^ld-linux' >found && fail "it links $(xargs <found)"
nm -D --defined-only "$module" | grep -v ' dof_' >found && fail "it exports $(xargs <found)"

# Traps 6 and 7: it is of the version of the OpenImageIO here, and links it, so that programs find it which load
# OpenImageIO for themselves, as Python does.
exits 0 "$reader" version "$module"
python=/usr/bin/python3
if [ -x $python ] && $python -c 'import OpenImageIO' 2>/dev/null; then
    cat >read.py <<'END'
import OpenImageIO as oiio
def same(a, b):
    a, b = (oiio.ImageBuf(name) for name in (a, b))
    assert not a.has_error and not oiio.ImageBufAlgo.compare(a, b, 0, 0).error, a.geterror()
    assert a.spec().channelnames == b.spec().channelnames
same("shot.dof", "gathered.exr")
assert oiio.ImageInput.open("wide.dof") is None and "wide" in oiio.geterror()
END
    exits 0 $python read.py
else
    echo "skipped: Python's OpenImageIO is not installed"
fi

# Trap 8: an LDI that was written again is read again, behind a query, too.
cp flat.exr before.exr
picture edit flat.exr after.exr R*=0.5
for name in shot.dof 'shot.dof?fstop=0.5'; do
    exits 0 "$reader" again "$name" 'cp after.exr flat.exr'
    grep -qx changed stdout || fail "$name: the change of the LDI is not seen"
    exits 0 "$reader" again "$name" 'touch shot.dof'
    grep -qx same stdout || fail "$name: it has changed without a change"
    cp before.exr flat.exr
done
exits 0 "$reader" again shot.dof 'printf "{\"ldi\": \"flat.exr\", \"lens-radius\": 0}" >shot.dof'
grep -qx changed stdout || fail "the change of the .dof file is not seen"

# The program's memory grows by no more than a picture.
picture make large.exr 1920x1080 R=1 G=1 B=1 A=1 Z=1 half=R,G,B,A
printf '{"ldi": "large.exr", "lens-radius": 0, "focal-length": 50, "sensor-width": 36}' >large.dof
exits 0 "$reader" memory large.dof
python3 -c 'import sys; sys.exit(float(sys.argv[1]) > 1)' "$(cat stdout)" || fail "the memory grows by $(cat stdout) pictures"
echo "openimageio: fine"
