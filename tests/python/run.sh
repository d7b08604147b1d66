# The Python module: its tests in pytest, the example of docs/python.md and the script of share/python. Skipped if that
# Python lacks pytest or numpy.
#   bash run.sh BIN_DIR MODULE_DIR PYTHON [--slow]     --slow: only the tests marked `slow`; without it, all others
. "$(dirname "$0")/../tools/check.sh"
python=$3
export PYTHONPATH=$2 PYTHONDONTWRITEBYTECODE=1 SPARSELENS_BIN=$bin

"$python" -c 'import sparselens' || fail "the module cannot be imported"
for package in pytest numpy; do
    "$python" -c "import $package" 2>/dev/null || skip "$python lacks $package (Debian: python3-$package)"
done

traced fence 96x54 views
export SPARSELENS_VIEWS=$scratch/views
marked=${4:-not slow}
"$python" -m pytest -q -p no:cacheprovider -o markers=slow -m "${marked#--}" "$source_dir/tests/python" --basetemp="$scratch/pytest"
[ "$marked" != --slow ] || exit 0

readme_block python docs/python.md >example.py
[ -s example.py ] || fail "docs/python.md has no example"
exits 0 "$python" example.py
exits 0 "$python" "$source_dir/share/python/pull_focus.py" views/center.exr views/view_?.exr -o pull --focus 2.2 3.4
for picture in focus-at-3.4.exr pull/focus_2.2.png pull/focus_3.4.png pull/focus_2.2.exr; do
    [ -s "$picture" ] || fail "$picture is not written"
done
