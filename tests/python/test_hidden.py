"""lab/hidden.py on a small picture: every row exists, and known surfaces beat guessed ones."""
import pathlib
import shutil
import subprocess
import sys

import pytest

from conftest import BIN

SCRIPT = pathlib.Path(__file__).parents[2] / "lab/hidden.py"
ROWS = ["visible surfaces alone, holes left dark", "... divided by what is known",
        "... the nearest background repeated behind", "... the background blurred inwards",
        "... dof-gather's own fillers", "depth peeling, 4 layers", "five views, ldi-warp"]


@pytest.mark.skipif(not shutil.which("oiiotool"), reason="needs oiiotool")
@pytest.mark.slow
def test_hidden(tmp_path):
    command = [sys.executable, SCRIPT, "fence", "-o", tmp_path, "--bin", BIN, "--size", "240x135", "--rays", "32",
               "--quality", "normal"]
    said = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    title, *lines = said.splitlines()
    assert title.split()[-1] == "fence" and [line[:44].rstrip() for line in lines] == ROWS
    dark, known, nearest, blurred, fillers, peeled, views = (float(line[44:].split()[0]) for line in lines)
    assert dark < known < min(nearest, blurred, fillers)
    assert max(nearest, blurred, fillers, peeled) < views
    assert (tmp_path / "fence.png").stat().st_size > 1000
