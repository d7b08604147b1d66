#!/bin/bash
# dof-view --pipe and its client in C: pictures equal those of dof-gather, hostile requests get errors, and whichever
# side is killed, the other goes on or ends, and nothing is left behind.
#   bash client.sh BIN_DIR
. "$(dirname "$0")/../tools/check.sh"
export PATH=$bin:$PATH
ask() { exits 0 "$bin/sparselens-ask" "$bin/dof-view" "$@"; }

# A surface with a hole before another one.
picture make flat.exr 48x32 R=noise:1 G=noise:2 B=noise:3 A=1 Z=2 fill=16x12+10+8 R*=2 Z=6 all= half=R,G,B,A
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.1 --focus-distance 3)
exits 0 dof-gather flat.exr -o with-lens.exr "${lens[@]}" # its header has the lens
cat >shot.dof <<'END'
{"ldi": "flat.exr", "focal-length": 50, "sensor-width": 36, "lens-radius": 0.1, "focus": 3}
END

# same_as_gather REQUEST OPTIONS...: the bytes of its one channel are those of dof-gather's uncompressed file.
same_as_gather() {
    local request=$1
    shift
    ask 60 "$request"
    grep -q '^200 ' stdout || fail "$request: $(cat stdout)"
    mv pixels given
    exits 0 dof-gather flat.exr -o expected.exr --compression none --channels R "$@"
    # Uncompressed rows of one channel: 8 bytes before each row's values.
    python3 - given expected.exr <<'END' || fail "other pixels than dof-gather $*: $request"
import sys
given, file = (open(name, "rb").read() for name in sys.argv[1:])
width, height = 48, 32
row = 2 * width
rows = file[-height * (8 + row):]
expected = b"".join(rows[y * (8 + row) + 8:(y + 1) * (8 + row)] for y in range(height))
sys.exit(given != expected or not given)
END
}
red='"ask":"picture","channels":["R"]'
same_as_gather "{$red,\"file\":\"shot.dof\"}" "${lens[@]}"
same_as_gather "{$red,\"file\":\"shot.dof\",\"query\":\"focus=5&fstop=0.5\"}" --focal-length 50 --sensor-width 36 --focus-distance 5 --fstop 0.5
same_as_gather "{$red,\"file\":\"shot.dof\",\"settings\":{\"blades\":5,\"quality\":\"final\",\"tilt\":[3,-4]}}" "${lens[@]}" --blades 5 --quality final --tilt 3,-4
same_as_gather "{$red,\"file\":\"shot.dof\",\"settings\":{\"focus\":{\"1\":2,\"11\":4}},\"frame\":6}" "${lens[@]::6}" --focus-distance 3
same_as_gather "{$red,\"file\":\"shot.dof\",\"query\":\"method=selective\"}" "${lens[@]}" --method selective
same_as_gather "{$red,\"file\":\"shot.dof\",\"query\":\"focus-pixel=12,10\"}" "${lens[@]::6}" --focus-pixel 12,10

# Sequences and keys: the frame comes from the request, the query or the name of the file.
cp flat.exr seq.0001.exr
picture make seq.0002.exr 48x32 R=0.5 G=0 B=0 A=1 Z=2
for pattern in 'seq.%04d.exr' 'seq.####.exr' 'seq.#.exr'; do
    printf '{"ldi": "%s", "focal-length": 50, "sensor-width": 36, "fstop": {"1": 1, "2": 2}, "focus": 3}\n' "$pattern" >seq.dof
    cp seq.dof seq.0002.dof
    for two in '"file":"seq.dof","frame":2' '"file":"seq.dof","query":"frame=2"' '"file":"seq.dof","query":"frame=0002"' '"file":"seq.0002.dof"'; do
        ask 60 "{\"ask\":\"header\",$two}"
        grep -qE 'dof-gather [^ ]*seq.0002.exr .*--fstop 2' stdout || fail "$two of $pattern: $(cat stdout)"
    done
done
ask 60 '{"ask":"header","file":"seq.dof"}'
grep -qE 'dof-gather [^ ]*seq.0001.exr ' stdout || fail "not the first frame: $(cat stdout)"
ask 60 '{"ask":"header","file":"shot.dof","settings":{"focus":{"1":2,"2":3}}}'
grep -q '^400 0 .*gives the frame' stdout || fail "keys without a frame: $(cat stdout)"

# Headers do not gather, and are of the picture: of all its sizes, and of a picture that grows.
picture edit flat.exr small.exr crop=20x12+14+10
for query in '' level; do
    for file in flat small; do
        extra=${query:+,\"level\":1}
        ask 60 "{\"ask\":\"header\",\"file\":\"$file.exr\",\"query\":\"focal-length=50&sensor-width=36&lens-radius=0.1&focus=5\"$extra}" \
            "{\"ask\":\"picture\",\"file\":\"$file.exr\",\"query\":\"focal-length=50&sensor-width=36&lens-radius=0.1&focus=5\"$extra}"
        [ "$(sed -E 's/.*("data":[^]]*\]).*/\1/' stdout | sort -u | wc -l)" -eq 1 ] || fail "header and picture differ: $(cat stdout)"
        [ "$(sed -E 's/.*("channels":[^]]*\]).*/\1/' stdout | sort -u | wc -l)" -eq 1 ] || fail "header and picture differ: $(cat stdout)"
    done
done
ask 60 '{"ask":"facts","file":"shot.dof"}'
grep -q '^200 0 .*"focus":3.0' stdout || fail "facts: $(cat stdout)"
ask 60 '{"ask":"tile","file":"shot.dof","box":[1,2,3,5]}'
grep -q "^200 $((3 * 4 * 4 * 2)) " stdout || fail "a tile: $(cat stdout)"

# Hostile requests: an answer in one line each, and the next request works.
good='{"ask":"facts","file":"shot.dof"}'
head -c 70000 /dev/zero | tr '\0' x >long
head -c 200000000 /dev/zero | tr '\0' y >endless
printf '{"ldi": {"1": ' >cut.dof
printf '[%.0s' {1..5000} >deep.dof
head -c 2000000 /dev/zero >zero.dof
printf '{"ldi": "/dev/stdin"}\n' >stdin.dof
printf '{"ldi": "/dev/zero"}\n' >device.dof
printf '{"ldi": "-"}\n' >dash.dof
printf '{"ldi": "flat.exr", "output": "written.exr"}\n' >output.dof
printf '{"ldi": "flat.exr", "lens": "--output=written.exr"}\n' >option.dof
mkfifo pipe.exr
printf '{"ldi": "pipe.exr"}\n' >fifo.dof
{
    printf '\n[]\nnull\n{\n{}\n\xff\xfe\n{"ask":1}\n{"ask":"all","file":"shot.dof"}\n{"ask":"facts"}\n{"ask":"tile","file":"shot.dof"}\n'
    printf '{"ask":"tile","file":"shot.dof","box":[0,0,999999999,999999999]}\n{"ask":"tile","file":"shot.dof","box":[5,5,4,4]}\n'
    printf '{"ask":"picture","file":"shot.dof","box":[0,0,1,1]}\n{"ask":"facts","file":"shot.dof","x":1}\n'
    printf '{"ask":"picture","file":"shot.dof","channels":["none"]}\n{"ask":"facts","file":"shot.dof","frame":1e99}\n'
    printf '{"ask":"header","file":"shot.dof","level":4}\n{"ask":"header","file":"sho\\u0000t.dof"}\n'
    for query in fstop fstop=x =2 'fstop=2&fstop=3' o=x output=x depth-out=x frame=x frames=1 threads=9 lens=none.json fstop=-o \
        proxy=2000 device=list show=all unknown=1 help=1 ldi=x version=1 config=x 'focus=1&focus-pixel=1,1'; do
        printf '{"ask":"header","file":"shot.dof","query":"%s"}\n' "$query"
    done
    for file in none.dof none.exr cut.dof deep.dof zero.dof stdin.dof device.dof dash.dof output.dof option.dof fifo.dof . /dev/zero long; do
        printf '{"ask":"header","file":"%s"}\n' "$file"
    done
    printf '[%.0s' {1..60000}
    printf '\n'
    cat long endless
    printf '\n'
} >hostile
lines=$(wc -l <hostile)
{ cat hostile; echo "$good"; } | (ulimit -v 8000000; timeout 100 dof-view --pipe 3<>memory >answers 2>errors) || fail "a hostile request ends it: $(tail -c 300 errors)"
[ "$(wc -l <answers)" -eq $((lines + 2)) ] || fail "$((lines + 1)) requests, $(wc -l <answers) lines"
sed -n "2,$((lines + 1))p" answers | grep -vE '^(400|500) 0 .' && fail "a hostile request got that answer"
tail -n 1 answers | grep -q '^200 0 {' || fail "after hostile requests: $(tail -n 1 answers)"
[ ! -e written.exr ] || fail "a request has written a file"
[ ! -s errors ] || fail "messages beside the answers: $(cat errors)"

# The file for pixels.
fails_saying 2 'descriptor 3' dof-view --pipe 3>&-
fails_saying 2 'descriptor 3' dof-view --pipe 3</dev/null
fails_saying 2 'excludes' dof-view --pipe --fstop 2
fails_saying 2 'excludes' dof-view --pipe flat.exr

# Whoever is killed. The client's program goes on when the gatherer is; the gatherer ends with the program.
picture="{\"ask\":\"picture\",\"file\":\"shot.dof\"}"
ask kill 100 "$picture"
ask fork "$picture"
ask files "$picture"
ended() { # PROCESS: within ten seconds
    for _ in {1..100}; do
        [ -d "/proc/$1" ] && ! grep -q '^State:.Z' "/proc/$1/status" || return 0
        sleep 0.1
    done
    return 1
}
"$bin/sparselens-ask" "$bin/dof-view" die '{"ask":"picture","file":"shot.dof","query":"lens-samples=100000"}' >process || true
ended "$(cat process)" || fail "the gatherer outlives a killed program"
mkfifo requests
dof-view --pipe <requests 3<>memory >answers &
gatherer=$!
exec 5>requests
echo "$picture" >&5
exec 5>&-
ended $gatherer || fail "the gatherer outlives its standard input"
grep -q '^200 [1-9]' answers || fail "it ends before the answer: $(cat answers)"
bash -c 'sleep 15 | dof-view --pipe 3<>memory >/dev/null & echo $!; sleep 1; kill -9 $$' >process 2>/dev/null || true
ended "$(cat process)" || fail "the gatherer outlives its parent"

# Other programs in the place of dof-view.
program() { printf '#!/bin/sh\n%s\n' "$1" >other && chmod +x other; }
other() { # TEXT SECONDS: asking it fails with that text
    exits 0 timeout 20 "$bin/sparselens-ask" ./other "$2" "$picture"
    grep -qE "^0 0 .*$1" stdout || fail "another program: $(cat stdout)"
}
program 'exit 0'
other 'ends at once' 5
program 'echo "200 0 {\"sparselens\":\"9.0\",\"pipe\":99}"; cat'
other 'not of the version' 5
program 'echo garbage; cat'
other 'not of the version' 5
program 'echo "200 0 {\"sparselens\":\"0\",\"pipe\":2}"; read line; exit 1'
other 'ended twice' 5
program 'echo "200 0 {\"sparselens\":\"0\",\"pipe\":2}"; read line; echo "200 99999999999 {}"; cat'
other 'ended twice' 5
program 'echo "200 0 {\"sparselens\":\"0\",\"pipe\":2}"; exec sleep 1000'
other 'does not answer in time' 1
rm other
other 'cannot start' 5
[ -z "$(find /dev/shm -name 'sparselens*')" ] || fail "shared memory is left behind"
echo "client: fine"
