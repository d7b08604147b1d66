"""The stubs and help() are complete, and match the module."""
import ast
import inspect
import pathlib
import re
import subprocess
import sys

import numpy
import pytest
import sparselens

STUBS = pathlib.Path(sparselens.__file__).parent
USE = '''
import numpy
import sparselens

def focus(names: list[str], distance: float) -> numpy.typing.NDArray[numpy.float32]:
    views = [sparselens.open_view(name, lens_radius=0.05) for name in names]
    ldi = sparselens.cluster(sparselens.warp(views, merge="keep"), tolerance=0.5)
    picture = sparselens.gather(ldi, focus_distance=distance, progress=lambda stage, percent: print(stage, percent))
    figures = sparselens.compare(picture, views[0], regions=ldi)
    print(figures["psnr"] + figures["regions"]["blurred"]["ssim"])
    print(sparselens.match(ldi, picture)["focus_distance"]["value"], len(sparselens.match(ldi, [picture], fit="focus")))
    sparselens.write("picture.exr", picture, type="half")
    return picture.pixels
'''


def mypy(*arguments):
    pytest.importorskip("mypy")
    return subprocess.run([sys.executable, "-m", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True)


def test_strict(tmp_path):
    use = tmp_path / "use.py"
    use.write_text(USE)
    found = mypy("mypy", "--strict", f"--cache-dir={tmp_path}", STUBS / "__init__.pyi", use)
    assert found.returncode == 0, found.stdout
    use.write_text(USE.replace('"keep"', '"kept"').replace("lens_radius", "radius"))
    found = mypy("mypy", "--strict", f"--cache-dir={tmp_path}", use)
    assert found.stdout.count("error:") == 2, found.stdout


def test_stubs_have_all():
    text = (STUBS / "__init__.pyi").read_text()
    for name in sparselens.__all__:
        assert f"def {name}(" in text or f"class {name}(" in text or f"class {name}:" in text, name
        for member in dir(getattr(sparselens, name)):
            assert member.startswith("_") or member in dir(Exception) or f"def {member}(" in text, (name, member)


def stub_of(name):
    """The parameters of a function in the stubs; of an overloaded one, those of the last."""
    tree = ast.parse((STUBS / "__init__.pyi").read_text())
    *_, function = (node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == name)
    return [argument.arg for argument in function.args.args + function.args.kwonlyargs]


@pytest.mark.parametrize("name", [n for n in sparselens.__all__ if inspect.isbuiltin(getattr(sparselens, n))])
def test_help(name):
    """help() begins with the signature from the stubs."""
    function = getattr(sparselens, name)
    named = list(inspect.signature(function).parameters)
    assert named == stub_of(name)
    assert len(function.__doc__) > 60


def test_stubs_have_the_table():
    """The keywords, words and ranges of the stubs are those of the table of parameters."""
    table = sparselens._sparselens._parameters()
    of = {call: {row["name"] for row in table if row["call"] == call} for call in ("open_ldi", "gather", "write")}
    lens = {row["name"] for row in table if row["call"] == "gather" and row["group"] == "Lens"}
    assert set(stub_of("gather")) == of["gather"] | {"ldi", "progress"}
    assert set(stub_of("open_ldi")) == of["open_ldi"] | lens | {"path"}
    assert of["write"] <= set(stub_of("write"))
    for name in ("open_view", "warp", "cluster", "match", "show", "plan", "compare"):
        assert lens <= set(stub_of(name)), name
    text, rows = (STUBS / "__init__.pyi").read_text(), {row["name"]: row for row in table}
    for name, row in rows.items():
        for words in re.findall(rf" {name}: (?:Optional\[)?Literal\[([^]]*)\]", text):
            assert re.findall('"([^"]*)"', words) == row["words"], name
    ranges = [(name, range) for name, range in re.findall(r"(\w+) \((-?[\d.]+ to -?[\d.]+)", text) if name in rows]
    assert len(ranges) > 5
    for name, range in ranges:
        assert rows[name]["wanted"].endswith("from " + range), name


LENS = dict(focal_length=36, sensor_width=36, lens_radius=0.1, focus_distance=3)
LDI = sparselens.Ldi(numpy.array([0, 1], numpy.uint64), numpy.ones(1, numpy.float32), {}, size=(1, 1), **LENS)
VIEW = sparselens.View(numpy.ones((1, 1, 4), numpy.float32), numpy.ones((1, 1), numpy.float32), **LENS)
PICTURE = sparselens.Picture(numpy.ones((1, 1, 4), numpy.float32))
FIRST = {"open_view": ["x"], "open_ldi": ["x"], "open_picture": ["x"], "warp": [[VIEW]], "show": [LDI, "coc"], "plan": [VIEW], "match": [LDI, PICTURE],
         "compare": [VIEW, VIEW], "finish": [PICTURE, [PICTURE, PICTURE]], "write": ["x.exr", VIEW.pixels], "set_limits": []}


@pytest.mark.parametrize("name", [n for n in sparselens.__all__ if inspect.isbuiltin(getattr(sparselens, n))])
def test_keywords(name):
    """A function accepts the keywords of its stub."""
    first = FIRST.get(name, [LDI])
    for keyword in stub_of(name)[len(first):]:
        if keyword == "masks":  # only a Plan has it
            continue
        with pytest.raises(TypeError, match=f"^{keyword}: must be "):
            getattr(sparselens, name)(*first, **{keyword: object()})


def test_help_of_members():
    for kind in (sparselens.View, sparselens.Ldi, sparselens.Picture, sparselens.Plan, sparselens.PlannedView, sparselens.Camera):
        assert kind.__module__ == "sparselens" and kind.__doc__
        for name, member in inspect.getmembers(kind):
            assert name.startswith("_") or member.__doc__, (kind, name)
