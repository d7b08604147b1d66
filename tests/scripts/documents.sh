# Limits of what people read: a number of words, how comments begin, and figures measured by a command. bash documents.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
fail() {
    echo "FAIL: $*" >&2
    exit 1
}

# Documents to read: README.md, CONTRIBUTING.md and docs. Pages of figures do not count.
most=15000
words=$(cat README.md CONTRIBUTING.md docs/*.md | wc -w)
[ "$words" -le $most ] || fail "README.md, CONTRIBUTING.md and docs have $words words ($most at most)"

# Comments begin with their subject.
riddles=$(grep -rnE '(//|#|/\*|"""|<!--) ?(Of|Who|Those|Nor|But for) ' --include='*.'{cpp,h,glsl,comp,sh,py,js,css,in,txt,cmake,yaml} \
    src tools lab tests share cmake CMakeLists.txt || true)
[ -z "$riddles" ] || fail "a comment does not begin with its subject: $riddles"

# Pictures do not say on which machine and by which command they were made.
told=$(grep -laE 'oiiotool|ImageHistory|/(home|root|work|tmp)/' share/images/*.png || true)
[ -z "$told" ] || fail "metadata names commands or folders: $told (oiiotool IN.png --nosoftwareattrib --eraseattrib '.*' -o OUT.png)"

# measured PAGE DOCUMENT: the text between the marks of lab/measure.
measured() { sed -n "/^<!-- measured: $1 /,/^<!-- end -->\$/{/^<!-- /d;p}" "$2"; }
count=0
for document in README.md docs/*.md lab/results/*.md; do
    while read -r _ _ page hash _; do
        [ -e "lab/measures/$page.sh" ] || fail "$document: there is no lab/measures/$page.sh"
        if [ "$hash" = "-->" ]; then # a page that was never measured
            [ "$(measured "$page" "$document")" = "Not measured yet with this tree: \`lab/measure $page\`." ] ||
                fail "$document has figures of $page that lab/measure has not written"
            continue
        fi
        [ "$(measured "$page" "$document" | sha256sum | cut -c 1-16)" = "$hash" ] ||
            fail "$document: figures of $page were changed by hand: measure them with lab/measure $page"
        measured "$page" "$document" | grep -E "^\`lab/measure $page\`: commit [0-9a-f]{10}" >/dev/null ||
            fail "$document: figures of $page do not say their commit"
        count=$((count + 1))
    done < <(grep -E '^<!-- measured: ' "$document")
    [ "$(grep -cE '^<!-- measured: ' "$document")" -eq "$(grep -c '^<!-- end -->$' "$document")" ] || fail "$document: a mark of lab/measure has no end"
    # Tables of figures come from lab/measure. comp.sh checks those of comp.md; platforms.md has versions, and the
    # figures of blender.md need three releases of Debian.
    [[ $document != docs/comp.md && $document != docs/platforms.md && $document != lab/results/blender.md ]] || continue
    pasted=$(sed '/^<!-- measured: /,/^<!-- end -->$/d' "$document" | grep -E '^\|.*\| *[-+]?[0-9]+\.[0-9]+ *(dB|s|GB)? *\|.*\| *[-+]?[0-9]+\.[0-9]+' || true)
    [ -z "$pasted" ] || fail "$document has a table of figures that no command measured: $(head -n 1 <<<"$pasted")"
done
for script in lab/measures/*.sh; do
    page=$(basename "$script" .sh)
    grep -qE "^<!-- measured: $page " README.md docs/*.md lab/results/*.md || fail "no document shows what $script measures"
done
grep -vE '^#' lab/measures/techniques.txt | while IFS='|' read -r technique file what instead; do
    changed=$(sed "s|$what|$instead|" "$file" | diff "$file" - | grep -c '^<' || true)
    [ "$changed" -eq 1 ] || fail "lab/measures/techniques.txt: \"$technique\" changes $changed lines of $file, not one"
done
tests/scripts/stamps.sh
[ "$count" -gt 0 ] || fail "no document has figures of lab/measure"
echo "documents: $words words, $count tables of lab/measure"
