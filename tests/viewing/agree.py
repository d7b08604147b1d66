"""agree.py BIN_DIR LDI OPTIONS... [, LDI OPTIONS... [,]]...: a page of dof-view shows, byte by byte, the picture of
dof-gather with the same options. The command that the page copies for PNG gives the same picture, and the one for EXR
writes dof-gather's. LDI may be a sequence; then each frame is compared."""
import itertools
import subprocess
import sys

from png import read_png
from served import served

folder, *words = sys.argv[1:]


def runs(command):
    """Runs the command; returns the name of the file that it writes."""
    tool, words = command.split(" ", 1)
    assert tool == "dof-gather", command
    subprocess.run(f"{folder}/dof-gather {words}", shell=True, check=True)
    return words.split()[-1]


def compare(ldi, *options):
    shown = {}
    with served(folder + "/dof-view", ldi, *options) as server:
        for frame in server.said("/facts").get("frames", [None]):
            asked = {"settings": {}, **({} if frame is None else {"frame": frame})}
            said, pixels = server.picture(**asked)
            commands = [server.said("/commands", **asked, **form)["shell"] for form in ({"format": "png"}, {})]
            shown[frame] = (said["width"], said["height"], said["channels"], pixels), *commands
    gathered = "gathered.####.png" if None not in shown else "gathered.png"
    subprocess.run([folder + "/dof-gather", ldi, *options, "-o", gathered], check=True)
    for frame, (picture, command, for_exr) in shown.items():
        assert read_png(gathered.replace("####", f"{frame or 0:04}")) == picture, f"another picture than dof-gather's: {frame}"
        assert read_png(runs(command)) == picture, f"the command makes another picture: {command}"
        with open(runs(for_exr), "rb") as file:
            assert file.read(4) == b"\x76\x2f\x31\x01", f"not an EXR file: {for_exr}"


for is_comma, picture in itertools.groupby(words, lambda word: word == ","):
    if not is_comma:
        picture = list(picture)
        try:
            compare(*picture)
        except Exception as error:
            sys.exit(f"{' '.join(picture)}: {type(error).__name__}: {str(error).strip()}")
