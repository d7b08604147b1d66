# The tables of the tests in lab/tests/stress: errors and bounds of all extreme cases. 3 minutes.
. "$(dirname "$0")/common.inc" "$1"
rm -f page
STRESS_PAGE=page sparselens-lab-tests --gtest_brief=1 --gtest_filter='*/Stress.*' >&2
cat page
