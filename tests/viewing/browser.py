"""browser.py BIN_DIR LDI REFERENCE MATTES [FOLDER]: the page of dof-view in a browser, by hand and by keys. MATTES has two
objects, near on the left and far on the right. Screenshots go to FOLDER."""
import os
import re
import subprocess
import sys
import tempfile

import driver
from png import read_png
from served import apart, served

folder, ldi, reference, mattes = sys.argv[1:5]
shots = sys.argv[5] if len(sys.argv) > 5 else None
ENTER, LEFT, UP, SHIFT = "\ue007", "\ue012", "\ue013", "\ue008"


class Page:
    def __init__(self, browser, server):
        self.browser, self.server = browser, server
        browser.open(server.address)
        self.rests()

    def rests(self, quality="normal"):
        """The picture of all settings is there."""
        self.browser.until(f"document.body.dataset.quality === '{quality}' && !flow.drafting && flow.full % 2 === 0", 120)

    def at(self, x, y):
        """Where in the window the middle of a pixel of the picture is."""
        return self.browser.run("const f = part('frame').getBoundingClientRect(); return [f.left + place.x + (arguments[0] + .5) * place.zoom,"
                                "f.top + place.y + (arguments[1] + .5) * place.zoom]", x, y)

    def does(self, action, *arguments):
        """Something that changes the picture: until it rests again."""
        self.browser.run("document.body.dataset.quality = ''")
        action(*arguments)
        self.rests()

    def click(self, x, y, held=None):
        self.browser.pointer(("move", *self.at(x, y)), ("down",), ("up",), held=held)

    def pixels(self, canvas="above"):
        return self.browser.run("const c = part(arguments[0]); return [c.width, c.height,"
                                "Array.from(c.getContext('2d').getImageData(0, 0, c.width, c.height).data).join()]", canvas)

    def set_keys(self, keys):
        """Of the focus distance: its values by frames."""
        for frame, focus in keys.items():
            self.does(self.browser.run, f"goTo({frame})")
            self.does(self.browser.run, f"set('focus-distance', {focus})")
            self.browser.press("k")

    def copies(self, form, expected):
        """What the timeline copies in that form, of which that is a part."""
        self.browser.run("part('form').value = arguments[0]; part('command').value = ''; part('copy_time').click()", form)
        return self.browser.until(f"part('command').value.includes({expected!r}) && part('command').value")

    def is_picture(self, path):
        """Whether the page shows the pixels of that PNG."""
        shown = bytes(int(value) for value in self.pixels()[2].split(","))
        _, _, channels, pixels = read_png(path)
        return pixels == (shown if channels == 4 else bytes(value for i, value in enumerate(shown) if i % 4 < 3))

    def shot(self, name):
        if shots:
            self.browser.screenshot(os.path.join(shots, name + ".png"))


def runs(command):
    subprocess.run(command.replace("dof-gather", folder + "/dof-gather", 1), shell=True, check=True)


def is_documented(page):
    """docs/view.md names the page's buttons and keys, and no others."""
    with open(os.path.join(os.path.dirname(__file__), "../../docs/view.md")) as document:
        rows = [line.split("|")[1:3] for line in document if line.startswith("| ") and not line.startswith("| hand ")]
    named = {name: keys.split() for hand, keys in rows for name in re.findall(r'"([^"]+)"', hand)}
    shown = page.browser.run("return Array.from(document.querySelectorAll('button, .row > span'), (part) => [part.textContent, part.dataset.key])")
    assert set(named) <= {name for name, _ in shown}, named
    for name, key in shown:
        assert not key or key in named[name], (name, key)
    spelt = {"ArrowUp": "up", "ArrowDown": "down", "ArrowLeft": "left", "ArrowRight": "right", " ": "Space"}
    keys = page.browser.run("return Object.keys(keys)")
    assert {spelt.get(key, key if len(key) > 1 else key.upper()) for key in keys} == {key for _, keys in rows for key in keys.split()}


def focuses(page):
    """A click states the distance of --focus-pixel."""
    for x, y in ((60, 50), (100, 20), (30, 60)):
        expected = subprocess.run([folder + "/dof-gather", ldi, "-v", "--focus-pixel", f"{x},{y}", "--lens-radius", "0", "-o", "any.exr"],
                                  check=True, capture_output=True, text=True).stderr
        page.does(page.click, x, y)
        stated = page.browser.run("return focusNow()")
        assert f"the focus distance is {stated:g}, the depth of pixel {x},{y}" in expected, (stated, expected)
    page.shot("focus")


def moves(page):
    browser, (x, y) = page.browser, page.at(80, 45)
    before = browser.run("return apertureNow()")
    page.does(browser.pointer, ("move", x, y), ("down",), ("move", x + 60, y), ("wait", 50), ("move", x + 120, y), ("up",))
    assert 1.9 < browser.run("return apertureNow()") / before < 2.1, "120 pixels to the right are two stops"
    focus = browser.run("return focusNow()")
    page.does(browser.wheel, x, y, -200)
    assert focus < browser.run("return focusNow()") < 1.1 * focus
    page.does(browser.press, LEFT)
    page.does(browser.press, UP)
    zoom = browser.run("return place.zoom")
    browser.press("+")
    assert browser.run("return place.zoom") > zoom
    browser.press("0")
    assert browser.run("return place.zoom") == zoom


def is_exact(page):
    """Final is what dof-gather writes, and the command that the page copies makes it."""
    page.browser.press(ENTER)
    page.rests("final")
    page.browser.until("part('command').value.includes('final')")
    command = page.browser.run("return part('command').value")
    runs(command)
    assert tuple(page.pixels()[:2]) == read_png(command.split()[-1])[:2] and page.is_picture(command.split()[-1]), command
    page.shot("final")


def compares(page):
    browser = page.browser
    clip = "return part('above').style.clipPath.replace('0px', '0')"
    browser.run("part('slide').focus()") # keys are for the page, whichever button was pressed last
    browser.press("w")
    browser.until("part('below').width > 1 && !part('border').hidden")
    assert "50%" in browser.run(clip), browser.run(clip)
    left, y = browser.run("const b = part('border').getBoundingClientRect(); return [b.left + b.width / 2, b.top + 50]")
    browser.pointer(("move", left, y), ("down",), ("move", left - 100, y), ("up",))
    assert browser.run("return comparing.share") < 50
    page.shot("wipe")
    browser.press("f")
    browser.until("comparing.mode === 'flip'")
    browser.until("part('above').style.clipPath.includes('100%')")
    page.shot("flip")
    browser.press("d")
    browser.until("part('stack').classList.contains('difference')")
    page.shot("difference")
    browser.press("d")
    browser.until("!comparing.mode")
    browser.press("s")
    page.does(page.click, 60, 50)
    browser.press("w")
    browser.until("comparing.target === 'kept' && part('below').width > 1")
    assert page.pixels("below")[2] != page.pixels()[2]
    browser.press("w")
    browser.run("part('with').value = 'rendered'")
    browser.press("w")
    browser.until("comparing.target === 'rendered' && part('below').width === 160")
    browser.press("w")


def shows(page):
    browser, plain = page.browser, page.pixels()[2]
    for key, name in (("p", "focus"), ("c", "coc"), ("l", "layers"), ("t", "tiles")):
        page.does(browser.press, key)
        assert page.pixels()[2] != plain and browser.run(f"return part('show_{name}').classList.contains('on')"), name
        page.shot(name)
        page.does(browser.press, key)
        assert page.pixels()[2] == plain, name
    page.does(browser.press, "e")
    middle, (x, y) = page.pixels()[2], page.at(80, 45)
    assert middle != plain
    page.does(browser.pointer, ("move", x, y), ("down",), ("move", x + 60, y + 30), ("wait", 50), ("move", x + 80, y + 60), ("up",))
    browser.until("part('command').value.includes('--lens-point 0.800,-0.600')")
    assert page.pixels()[2] != middle
    assert browser.run("const disc = part('lens_disc').getBoundingClientRect(), eye = part('eye_at').getBoundingClientRect();"
                       "return eye.left > disc.left + disc.width / 2 && eye.top > disc.top + disc.height / 2")
    page.shot("eye")
    page.does(browser.press, "e")
    assert page.pixels()[2] == plain
    browser.press("x")
    browser.pointer(("move", *page.at(80, 45)))
    browser.until("part('samples').querySelectorAll('tbody tr').length > 0 && part('pixel').textContent.startsWith('80,45')")
    said = page.server.said("/samples", settings={}, pixel=[80, 45])["samples"]
    rows = browser.run("return Array.from(part('samples').querySelectorAll('tbody tr'), (row) => Number(row.cells[1].textContent))")
    assert len(rows) == len(said) and all(abs(row / sample["z"] - 1) < 1e-3 for row, sample in zip(rows, said)), (rows, said)
    page.shot("samples")
    page.does(browser.run, "part('samples').querySelector('tbody tr:last-child').click()")
    assert browser.run("return focusNow()") == said[-1].get("image", said[-1]["z"])
    browser.press("x")


def has_looks(page):
    browser = page.browser
    browser.run("for (const part of document.querySelectorAll('details')) part.open = true")
    names = {look["name"] for look in page.server.said("/facts")["looks"]}
    others = {"lens", "tilt", "axial-chromatic-type", "cat-eye-darkening"}
    shown = browser.run("return Array.from(document.querySelectorAll('.look > span'), (name) => name.textContent)")
    assert set(shown) == names | others, (names, shown)
    before = page.pixels()[2]
    page.does(browser.run, "const slider = part('look_blades').previousSibling; slider.value = 5; slider.dispatchEvent(new Event('input'))")
    assert page.pixels()[2] != before
    page.does(browser.run, "const lens = part('look_lens'); lens.value = 'petzval'; lens.dispatchEvent(new Event('change'))")
    browser.until("part('command').value.includes('petzval.json')")
    page.does(browser.run, "part('tilt_X').value = 5; part('tilt_X').dispatchEvent(new Event('change'))")
    browser.until("part('command').value.includes('--tilt 5,0')")
    browser.until("part('command').value.includes('--blades 5')")
    page.shot("looks")
    browser.run("set('blades', '2')")
    browser.until("part('said').textContent.includes('blades')")
    page.does(browser.run, "part('reset').click()")
    assert browser.run("return Object.keys(state.settings).length") == 0
    browser.run("for (const part of document.querySelectorAll('details')) part.open = false")


def has_keys(page):
    """Frames between two keys, and the command that makes them all."""
    browser = page.browser
    browser.run("part('last').value = 3; part('time').open = true")
    page.set_keys({1: 2, 3: 5})
    page.does(browser.press, ",")
    assert browser.run("return [time.frame, focusNow()]") == [2, 3.5]
    page.shot("keys")
    command = page.copies("command of all frames", "--frames 1-3")
    assert "--focus-distance 1:2,3:5" in command, command
    runs(command)
    made = command.split()[-1].replace("####", "0002")
    assert page.is_picture(made)
    with open("keys.txt", "w") as file:
        file.write(page.copies("focus, for --focus-distance @file", "1:2\n3:5\n"))
    subprocess.run([folder + "/dof-gather", ldi, "--frames", "2", "--focus-distance", "@keys.txt", "--quality", "normal", "-o", "keyed.#.png"], check=True)
    assert read_png("keyed.0002.png") == read_png(made)
    browser.run("part('smooth').checked = true")
    for name, expected in (("focus as a curve of Nuke", "{curve L x1 2 x2 3.5 x3 5}"), ("job for Slurm", "sbatch --array=1-3 --wrap"),
                           ("all keys as JSON", '"focus-distance"'), ("f-number, for --fstop @file", "1:0.3")):
        page.copies(name, expected)


def has_pieces(browser):
    """Tiles of the picture come before all of it."""
    with served(folder + "/dof-view", ldi, "--lens-samples", "20000", "--threads", "1") as server:
        browser.open(server.address)
        browser.until("flow.pieces > 0 && flow.full % 2 === 1 && part('above').width === 160")


def has_frames(browser):
    """A sequence: its timeline, its frames, and the command that makes them with keys."""
    other = "other.ldi.exr"
    subprocess.run([folder + "/dof-trace", "grass", "--size", "160x90", "--spp", "1", "--views", "0", "-o", "grass"], check=True)
    subprocess.run([folder + "/ldi-warp", "grass/center.exr", "-o", other], check=True)
    for number, source in ((1, ldi), (2, other), (4, ldi)):
        os.symlink(os.path.abspath(source), f"shot.{number:04}.ldi.exr")
    with served(folder + "/dof-view", "shot.####.ldi.exr") as server:
        page = Page(browser, server)
        assert browser.run("return [part('time').open, time.frame, part('first').value, part('last').value]") == [True, 1, "1", "4"]
        first = page.pixels()[2]
        page.does(browser.press, ".")
        browser.until("part('name').textContent.includes('shot.0002') && part('command').value.includes('shot.0002')")
        assert page.pixels()[2] != first
        page.shot("sequence")
        page.does(browser.press, ".")
        browser.until("time.frame === 4 && part('name').textContent.includes('shot.0004')")
        assert page.pixels()[2] == first
        page.set_keys({4: 8, 1: 5})
        page.does(browser.press, ".")
        assert browser.run("return [time.frame, focusNow()]") == [2, 6]
        command = page.copies("command of all frames", "--frames 1,2,4")
        assert "shot.####.ldi.exr" in command and "1:5,4:8" in command, command
        runs(command)
        assert page.is_picture("shot.0002.png")
        browser.run("window.seen = new Set(); const before = goTo; goTo = (frame) => (seen.add(frame), before(frame)); play()")
        browser.until("seen.size === 3")
        browser.press(" ")
        browser.until("!time.playing")
        page.rests()


def knows_objects(browser):
    lens = ["--focal-length", "50", "--sensor-width", "36", "--fstop", "0.005", "--focus-distance", "3"]
    with served(folder + "/dof-view", mattes, *lens) as server:
        page = Page(browser, server)
        browser.until("objects.list")
        for x, name in ((3, "near"), (20, "far")):
            browser.pointer(("move", *page.at(x, 8)))
            browser.until(f"part('object').textContent === '{name}'")
            marked = [int(value) for value in page.pixels("marks")[2].split(",")]
            assert marked[4 * (8 * 24 + 12) + 3] == (255 if name == "far" else 0) and marked[4 * (8 * 24 + 11) + 3] == (255 if name == "near" else 0)
        page.shot("objects")
        page.does(page.click, 20, 8, SHIFT)
        near, far = browser.run("return [asNumber(state.lens.near), asNumber(state.lens.far)]")
        assert 7.5 < near < 7.62 and 8.95 < far < 9.05, (near, far)


def main():
    with served(folder + "/dof-view", ldi, "--reference", reference) as server, tempfile.TemporaryDirectory() as profile:
        browser = driver.Browser(profile)
        try:
            page = Page(browser, server)
            assert browser.run("return [innerWidth, innerHeight]") == [1280, 720]
            assert browser.run("return document.documentElement.scrollWidth <= 1280 && document.documentElement.scrollHeight <= 720")
            page.shot("begin")
            is_documented(page)
            focuses(page)
            moves(page)
            is_exact(page)
            page.does(browser.run, "part('reset').click()")
            compares(page)
            shows(page)
            has_looks(page)
            has_keys(page)
            wrong = [line for line in browser.log() if "400 (Bad Request)" not in line and "409 (Conflict)" not in line]
            assert not wrong, wrong
            # A second page, while the first one is open, with settings of its own.
            settings = {"focus-distance": "2.5"}
            said = apart(server.ask("/picture", page="second", settings=settings))[0]
            assert said["lens"]["focus"] == 2.5
            page.does(page.click, 100, 20)
            assert browser.run("return focusNow()") != 2.5
            has_frames(browser)
            has_pieces(browser)
            knows_objects(browser)
        finally:
            browser.end()


if driver.missing():
    print(f"skipped: the page in a browser: {driver.missing()} is not installed")
else:
    main()
