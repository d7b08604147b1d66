# sparselens-pictures, which the other scripts rely on: it finds what it should, OpenImageIO reads its pictures
# correctly, and it reports each kind of difference.
#   bash pictures.sh BIN_DIR
. "$(dirname "$0")/check.sh"
for tool in oiiotool exrheader; do command -v $tool >/dev/null || skip "needs $tool (openimageio-tools, openexr)"; done
# finds PATTERN COMMAND...: the answer is no, with a reason.
finds() {
    exits 1 picture "${@:2}"
    grep -Eq "$1" stdout || fail "'$1' is not in: $(cat stdout)"
}
unsaid() { fails_saying 2 "$1" picture "${@:2}"; }

# Its pictures, as read by OpenImageIO and OpenEXR's own tool.
picture make a.exr 4x3+5+6 frame=20x10 R=0.5 G=1..4 B=noise:1 A=1 fill=2x1+6+7 R=0.25 all= 'R*=2' id=7 half=R,G set=shot:sq01 set=near:0.5
oiiotool a.exr --ch R,G,A --printstats >stats
grep -q 'Stats Avg: 0.916667 2.500000 1.000000' stats || fail "means: $(cat stats)"
grep -q 'Stats Max: 1.000000 4.000000 1.000000' stats || fail "maxima: $(cat stats)"
exrheader a.exr >header
for line in 'dataWindow .*\(5 6\) - \(8 8\)' 'displayWindow .*\(0 0\) - \(19 9\)' ' *R, 16-bit' ' *B, 32-bit' 'shot .*"sq01"' 'near .*: 0.5$'; do
    grep -Eq "^$line" header || fail "'$line' is not in: $(cat header)"
done
[ "$(picture pixel a.exr 6,7 R,G,A)" = "0.5 2 1" ] && [ "$(picture pixel a.exr 8,7 R,G)" = "1 4" ] || fail "pixel: $(picture pixel a.exr 8,7 R,G)"
[ "$(picture sum a.exr R)" = 11 ] || fail "sum: $(picture sum a.exr R)"
oiiotool a.exr --ch R,G,B,A -o b.exr
picture same a.exr b.exr R,G,B,A || fail "OpenImageIO's copy"
picture same a.exr a.exr || fail "a file is not itself"

# Each kind of difference.
picture edit a.exr b.exr 'erase=sh.*' set=near:9 float=
picture same a.exr b.exr || fail "attributes or types count"
! exrheader b.exr | grep -q '^shot' || fail "erase="
picture edit a.exr b.exr fill=1x1+8+8 A=1.25
finds 'A of pixel 8,8 is 1 and 1.25; 1 values differ, by 0.25' same a.exr b.exr
finds 'A of pixel 8,8' same a.exr b.exr 0.24
picture same a.exr b.exr 0.25 && picture same a.exr b.exr R,G,B || fail "a tolerance, or other channels"
picture differ a.exr b.exr || fail "they do differ"
finds 'are the same' differ a.exr b.exr 0.25
finds 'are the same' differ a.exr a.exr
for change in A=-1 A=nan A=inf; do
    picture edit a.exr b.exr $change
    finds 'A of pixel 5,6' same a.exr b.exr 0.5
    picture same b.exr b.exr 0.5 && picture same b.exr b.exr || fail "$change is not itself"
done
picture edit a.exr zero.exr A=0
picture edit a.exr minus.exr A=-0.0
finds 'is 0 and -0' same zero.exr minus.exr
picture edit a.exr b.exr crop=4x2+5+6
finds 'data windows are 5,6 to 8,8 and 5,6 to 8,7' same a.exr b.exr
picture edit b.exr b.exr crop=4x3+5+6
finds 'of pixel 5,8' same a.exr b.exr # transparent black
picture edit a.exr b.exr channels=R,G,B,alpha=A,id
finds 'channels are A,B,G,R,id and B,G,R,alpha,id' same a.exr b.exr
unsaid 'no channel A' same a.exr b.exr A

# Deep files, made by OpenImageIO.
oiiotool --pattern constant:color=0.25,0.5,0.125,0.5,4 6x2 5 --chnames R,G,B,A,Z -d float --deepen -o near.exr
oiiotool --pattern constant:color=0.5,0.25,1,1,9 6x2 5 --chnames R,G,B,A,Z -d float --deepen -o far.exr
oiiotool near.exr far.exr --deepmerge -o both.exr
[ "$(picture samples both.exr)" = "24 2" ] && [ "$(picture samples near.exr)" = "12 1" ] || fail "samples: $(picture samples both.exr)"
picture same both.exr both.exr || fail "a deep file is not itself"
finds 'pixel 0,0 has 1 and 2 samples' same near.exr both.exr
finds 'Z of pixel 0,0 is 4 and 9' same near.exr far.exr Z
finds "data windows" same a.exr both.exr

# Without an answer, the exit code is neither yes nor no.
unsaid 'none.exr' same a.exr none.exr
unsaid 'none.exr' differ a.exr none.exr
head -c 400 a.exr >cut.exr
unsaid 'cut.exr' differ a.exr cut.exr
unsaid 'no value at 4,6' pixel a.exr 4,6 R
for words in 'channels=Q' 'fill=2' 'R=1x' 'frame=0x0' 'word'; do unsaid "$words" edit a.exr x.exr "$words"; done
[ ! -e x.exr ] || fail "a failure wrote x.exr"
exits 2 picture
exits 2 picture same a.exr
exits 2 picture both a.exr a.exr
