"""agree.py BIN_DIR LDI OPTIONS...: the picture that a page of dof-view shows is, byte by byte, that of dof-gather with the same
options, and so is that of the command which the page copies."""
import subprocess
import sys

from png import read_png
from served import served


def main():
    folder, ldi, *options = sys.argv[1:]
    with served(folder + "/dof-view", ldi, *options) as server:
        said, pixels = server.picture(settings={})
        shown = said["width"], said["height"], said["channels"], pixels
        command = server.said("/commands", settings={})["shell"]
    subprocess.run([folder + "/dof-gather", ldi, *options, "-o", "gathered.png"], check=True)
    assert read_png("gathered.png") == shown, "another picture than dof-gather's"
    tool, *words = command.split(" ", 1)
    assert tool == "dof-gather", command
    subprocess.run(f"{folder}/dof-gather {words[0]}", shell=True, check=True)
    assert read_png(words[0].split()[-1]) == shown, f"the command makes another picture: {command}"


main()
