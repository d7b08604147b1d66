# The tables of the tests in lab/tests/stress: errors and bounds of all extreme cases. 3 minutes.
. "$(dirname "$0")/common.inc" "$1"
rm -f page
STRESS_PAGE=page sparselens-lab-tests --gtest_brief=1 --gtest_filter='*/Stress.*' >&2
# Each reason stands once, below the tables; rows have its number.
awk '
!/^\| / || /^\| case / { print; next }
{
    cells = split($0, cell, / \| /)
    reason = substr(cell[cells], 1, length(cell[cells]) - 2)
    if (!(reason in number)) text[number[reason] = ++reasons] = reason
    print substr($0, 1, length($0) - length(cell[cells])) number[reason] " |"
}
END {
    print "\n## Reasons for the bounds\n"
    for (i = 1; i <= reasons; ++i) print i ". " text[i]
}' page
