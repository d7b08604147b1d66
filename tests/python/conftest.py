"""Shared by the tests: the views of the scene fence, and the tools for comparison."""
import os
import pathlib
import subprocess

import pytest
import sparselens


def pytest_terminal_summary(terminalreporter):
    """Prints a line for each skipped test, which tests/skips.sh reads."""
    for report in terminalreporter.stats.get("skipped", []):
        terminalreporter.line(f"skipped: {report.nodeid}: {report.longrepr[2]}")


VIEWS = pathlib.Path(os.environ["SPARSELENS_VIEWS"])
BIN = pathlib.Path(os.environ["SPARSELENS_BIN"])


@pytest.fixture(scope="session")
def names():
    return [VIEWS / "center.exr"] + sorted(VIEWS.glob("view_?.exr"))


@pytest.fixture(scope="session")
def views(names):
    return [sparselens.open_view(name) for name in names]


@pytest.fixture(scope="session")
def tool():
    """tool(NAME, ARGUMENT...) runs it and returns what it prints."""

    def run(name, *arguments):
        command = [BIN / name, *map(str, arguments)]
        return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout

    return run


@pytest.fixture(scope="session")
def warped(tool, names, tmp_path_factory):
    path = tmp_path_factory.mktemp("chain") / "warped.exr"
    tool("ldi-warp", *names, "-o", path)
    return path


@pytest.fixture(scope="session")
def clustered(tool, warped):
    path = warped.with_name("ldi.exr")
    tool("ldi-cluster", warped, "-o", path)
    return path
