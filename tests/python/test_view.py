"""sparselens.view(): the same server as dof-view, for an Ldi and for a file."""
import json
import os
import pathlib
import struct
import subprocess
import sys
import urllib.error
import urllib.request

import pytest
import sparselens

from conftest import BIN

pytestmark = pytest.mark.skipif(not (BIN / "dof-view").exists(), reason="needs dof-view")


def ask(viewing, path, **asked):
    base, key = viewing.address.split("/?key=")
    request = urllib.request.Request(base + path, json.dumps({"page": "a", **asked}).encode(), {"X-Sparselens-Key": key})
    with urllib.request.urlopen(request) as answer:
        return answer.read()


def picture(viewing, **settings):
    answer = ask(viewing, "/picture", settings=settings)
    size = struct.unpack("<I", answer[:4])[0]
    return json.loads(answer[4:4 + size]), answer[4 + size:]


def test_an_ldi_and_its_file(clustered):
    ldi = sparselens.open_ldi(clustered)
    with sparselens.view(ldi) as of_ldi, sparselens.view(clustered, fstop=0.4, tilt=(3, 0), cat_eye_darkening=True, cat_eye=None) as of_file:
        assert of_ldi.address != of_file.address and of_ldi.address in repr(of_ldi) and of_ldi.address in of_ldi._repr_html_()
        facts = json.loads(ask(of_ldi, "/facts"))
        assert (facts["width"], facts["height"]) == (96, 54)
        said, pixels = picture(of_ldi, fstop="0.4", tilt="3,0")
        other, of_options = picture(of_file)
        assert (said["lens"], pixels) == (other["lens"], of_options) and said["lens"]["fstop"] == 0.4
        assert "--cat-eye-darkening" in json.loads(ask(of_file, "/commands"))["shell"]
        folder = pathlib.Path(facts["file"]).parent
        assert folder.is_dir()
    assert not folder.exists()
    with pytest.raises(urllib.error.URLError):
        ask(of_ldi, "/facts")
    of_ldi.close() # again


def test_what_is_wrong_is_said(clustered, tmp_path):
    with pytest.raises(sparselens.UsageError, match="--no-such"):
        sparselens.view(clustered, no_such=1)
    with pytest.raises(sparselens.Error, match="none.exr: cannot open"):
        sparselens.view(tmp_path / "none.exr")
    with pytest.raises(TypeError, match="an Ldi or the name of a file"):
        sparselens.view(3)


def test_it_ends_with_the_program(clustered):
    script = f"import sparselens, sys; print(sparselens.view({str(clustered)!r}).address)"
    address = subprocess.run([sys.executable, "-c", script], check=True, stdout=subprocess.PIPE, text=True, env=os.environ).stdout.strip()
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(address)
