#!/bin/bash
# The parts of dof-report, each by itself, in pytest.
#   bash run.sh BIN_DIR
. "$(dirname "$0")/../../../tests/tools/check.sh"
for package in pytest numpy matplotlib OpenImageIO; do
    /usr/bin/python3 -c "import $package" 2>/dev/null || skip "needs python3-${package,,}"
done
export PYTHONPATH=$bin/dof-report PYTHONDONTWRITEBYTECODE=1
/usr/bin/python3 -m pytest -q -p no:cacheprovider "$source_dir/lab/tests/report" --basetemp="$scratch/pytest"
