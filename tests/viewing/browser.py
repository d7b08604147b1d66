"""browser.py BIN_DIR LDI REFERENCE MATTES [FOLDER]: the page of dof-view in a browser, with mouse and keys. MATTES has
two objects, a near one on the left and a far one on the right. Screenshots go to FOLDER."""
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
ENTER, LEFT, UP, SHIFT, CONTROL = "\ue007", "\ue012", "\ue013", "\ue008", "\ue009"


class Page:
    def __init__(self, browser, server):
        self.browser, self.server = browser, server
        browser.open(server.address)
        self.rests()

    def rests(self, quality="normal"):
        """Waits until the picture has all settings."""
        self.browser.until(f"document.body.dataset.quality === '{quality}' && !flow.drafting && flow.full % 2 === 0", 120)

    def at(self, x, y):
        """The window position of the middle of a pixel of the picture."""
        return self.browser.run("const f = part('frame').getBoundingClientRect(); return [f.left + place.x + (arguments[0] + .5) * place.zoom,"
                                "f.top + place.y + (arguments[1] + .5) * place.zoom]", x, y)

    def does(self, action, *arguments):
        """Does something that changes the picture, and waits until it is complete again."""
        self.browser.run("document.body.dataset.quality = ''")
        action(*arguments)
        self.rests()

    def click(self, x, y, held=None):
        self.browser.pointer(("move", *self.at(x, y)), ("down",), ("up",), held=held)

    def pixels(self, canvas="above"):
        return self.browser.run("const c = part(arguments[0]); return [c.width, c.height,"
                                "Array.from(c.getContext('2d').getImageData(0, 0, c.width, c.height).data).join()]", canvas)

    def writes(self, form):
        """Makes commands write files of this format from now on."""
        self.browser.run("part('format').value = arguments[0]; part('format').dispatchEvent(new Event('change'))", form)
        self.browser.until(f"part('command').value.endsWith('.{form}')")

    def types(self, field, text):
        self.browser.run("const field = part(arguments[0]); field.focus(); field.value = arguments[1];"
                         "field.dispatchEvent(new Event('input')); field.dispatchEvent(new Event('change'))", field, text)

    def set_keys(self, keys):
        """Sets keys of the focus distance, from a frame -> value table."""
        for frame, focus in keys.items():
            self.does(self.browser.run, f"goTo({frame})")
            self.does(self.browser.run, f"set('focus-distance', {focus})")
            self.browser.press("k")

    def copies(self, form, expected):
        """Copies from the timeline in that form; the result must contain the text."""
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
    """A click gives the same distance as --focus-pixel."""
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
    """Final equals dof-gather's picture, and so does that of the copied command."""
    page.browser.press(ENTER)
    page.rests("final")
    page.browser.until("part('command').value.includes('final')")
    command = page.browser.run("return part('command').value")
    assert command.endswith(" -o ldi.dof.exr"), command # beside ldi.exr
    runs(command)
    page.writes("png")
    command = page.browser.run("return part('command').value")
    runs(command)
    page.writes("exr")
    assert tuple(page.pixels()[:2]) == read_png(command.split()[-1])[:2] and page.is_picture(command.split()[-1]), command
    page.shot("final")


def compares(page):
    browser = page.browser
    clip = "return part('above').style.clipPath.replace('0px', '0')"
    browser.run("part('slide').focus()") # keys work whichever button was pressed last
    browser.press("w")
    browser.until("part('below').width > 1 && !part('border').hidden")
    assert "50%" in browser.run(clip), browser.run(clip)
    assert browser.run("return [part('side_left').textContent, part('side_right').textContent]") == ["this picture", "the reference"]
    assert browser.run("return part('side_left').getBoundingClientRect().right < part('border').getBoundingClientRect().left + 9"
                       " && part('side_right').getBoundingClientRect().left > part('border').getBoundingClientRect().left")
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
        legend = browser.run("return part('legend').hidden ? '' : part('legend').textContent")
        assert {"focus": "sharp", "coc": "behind it", "layers": "1 sample", "tiles": "lens points"}[name] in legend, legend
        page.shot(name)
        page.does(browser.press, key)
        assert browser.run("return part('legend').hidden")
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
    for direction in range(12): # the rim: still in the lens when rounded
        page.does(browser.run, f"setEye([2 * Math.cos({direction} * .53), 2 * Math.sin({direction} * .53)])")
        assert browser.run("return part('said').textContent") == ""
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
    shown = browser.run("return Array.from(document.querySelectorAll('.look'), (row) => row.dataset.option)")
    assert set(shown) == names and "tilt" in names, (names, shown)
    said = browser.run("return Array.from(document.querySelectorAll('.look > span'), (name) => name.textContent)")
    assert "anamorphic squeeze" in said and not any("-" in name for name in said), said
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
    assert command.endswith(" -o ldi.dof.####.exr"), command
    page.writes("png")
    command = page.copies("command of all frames", "--frames 1-3")
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
    """Tiles appear before the whole picture."""
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
        page.writes("png")
        command = page.copies("command of all frames", "--frames 1,2,4")
        assert "shot.####.ldi.exr" in command and "1:5,4:8" in command, command
        runs(command)
        assert page.is_picture("shot.dof.0002.png")
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
            browser.until(f"part('object').textContent === 'object {name}'")
            browser.until("objects.list[objects.shown - 1]?.name === '" + name + "'")
            assert browser.run("return document.querySelector('footer').textContent").count(name) == 1
            marked = [int(value) for value in page.pixels("marks")[2].split(",")]
            assert marked[4 * (8 * 24 + 12) + 3] == (255 if name == "far" else 0) and marked[4 * (8 * 24 + 11) + 3] == (255 if name == "near" else 0)
        page.shot("objects")
        browser.until("getComputedStyle(part('marks')).opacity === '0'") # so that the edge can be judged
        browser.pointer(("move", *page.at(21, 8)))
        browser.until("getComputedStyle(part('marks')).opacity === '1'")
        page.does(page.click, 20, 8, SHIFT)
        near, far = browser.run("return [asNumber(state.lens.near), asNumber(state.lens.far)]")
        assert 7.5 < near < 7.62 and 8.95 < far < 9.05, (near, far)


def has_frames_of_any_size(browser):
    """Each frame has its own size on the page, and its own colours."""
    subprocess.run([folder + "/dof-trace", "grass", "--size", "96x54", "--spp", "4", "--supersample", "2", "--views", "0", "-o", "small"], check=True)
    os.symlink(os.path.abspath(ldi), "sized.0001.exr")
    os.symlink(os.path.abspath("small/center.exr"), "sized.0002.exr")
    with served(folder + "/dof-view", "sized.####.exr") as server:
        page = Page(browser, server)
        for key, size in ((".", [96, 54]), (",", [160, 90])):
            page.does(browser.press, key)
            assert browser.run("return [state.facts.width, state.facts.height, part('above').width, part('above').height]") == 2 * size
            box = browser.run("const b = part('above').getBoundingClientRect(), f = part('frame').getBoundingClientRect(); return [b.width, f.width, b.height, f.height]")
            assert abs(box[0] / box[1] - 1) < .01 or abs(box[2] / box[3] - 1) < .01, (size, box)


def is_forgiving(page):
    """Wrong input is not set; steps can be undone; a reload keeps the settings."""
    browser = page.browser
    page.does(page.types, "focus_text", "3.5")
    page.does(page.types, "focus_text", "7")
    page.does(browser.press, "z", CONTROL) # although the field was written in last
    assert browser.run("return [state.settings['focus-distance'], part('focus_text').value]") == ["3.5", "3.5"]
    for wrong in ("abc", "1,5", "60cm", "0", "-1"):
        page.types("focus_text", wrong)
        browser.until("part('focus_text').classList.contains('wrong') && part('said').textContent.includes('focus-distance')")
        assert browser.run("return state.settings['focus-distance']") == "3.5", wrong
    page.does(browser.wheel, *page.at(80, 45), -100)
    browser.until("part('command').value.includes('--focus-distance 3.57') && !part('focus_text').classList.contains('wrong')")
    assert browser.run("return part('focus_text').value").startswith("3.57")
    browser.run("part('frame').focus()")
    page.does(page.types, "look_blades", "5")
    browser.press("k")
    browser.run("part('frame').focus()")
    before = browser.run("return snapshot()")
    page.does(browser.press, "z", CONTROL) # the key
    assert browser.run("return [Object.keys(time.keys).length, state.settings.blades]") == [0, "5"]
    page.does(browser.press, "z", CONTROL)
    assert browser.run("return [state.settings.blades ?? '', part('look_blades').value, state.settings['focus-distance'].slice(0, 4)]") == ["", "", "3.57"]
    page.does(browser.press, "z", CONTROL)
    assert browser.run("return state.settings['focus-distance']") == "3.5"
    for _ in range(3):
        page.does(browser.press, "Z", CONTROL + SHIFT)
    assert browser.run("return snapshot()") == before
    browser.reload()
    page.rests()
    assert browser.run("return snapshot()") == before
    assert browser.run("return [part('look_blades').value, part('keyed').textContent]") == ["5", "keys at 1"]
    page.does(page.click, 60, 50, SHIFT)
    browser.until("part('said').classList.contains('note') && part('said').textContent.includes('Cryptomattes')")
    assert browser.run("return part('focus_name').textContent") == "focus, m"


def outlives_the_server(browser):
    """A bar says that the server does not answer; the page continues when it does, and at another address with the same
    settings."""
    with served(folder + "/dof-view", ldi) as server:
        page = Page(browser, server)
        page.does(browser.run, "set('focus-distance', 2.5)")
        browser.set_online(False)
        page.browser.run("set('focus-distance', 2.75)")
        browser.until("!part('ended').hidden && part('said').hidden")
        page.shot("ended")
        browser.run("document.body.dataset.quality = ''")
        browser.set_online(True)
        browser.until("part('ended').hidden && state.lens.focus === 2.75")
        page.rests()
    browser.until("!part('ended').hidden") # without any action on the page
    with served(folder + "/dof-view", ldi) as server:
        for address in ("abc", "http://example.org/?key=1", server.address):
            browser.run("part('address').value = arguments[0]; part('go_on').requestSubmit()", address)
        browser.until(f"location.port === '{server.port}' && document.body.dataset.quality === 'normal'")
        assert browser.run("return state.lens.focus") == 2.75


def guesses_a_lens(browser):
    """A flat file without a lens is shown, and the page says with which lens."""
    subprocess.run(["oiiotool", "--pattern", "constant:color=.5,.4,.3,1,4", "96x54", "5", "--chnames", "R,G,B,A,Z", "-d", "float", "-o", "flat.exr"], check=True)
    with served(folder + "/dof-view", "flat.exr") as server:
        page = Page(browser, server)
        said = browser.run("return part('guess').textContent")
        assert "guess" in said and "--focal-length 50 --sensor-width 36 --fstop 2.8 --focus-distance 4" in said, said
        assert browser.run("return part('focus_name').textContent") == "focus, units"
        page.shot("guess")
        runs(browser.until("part('command').value"))


def survives_names(browser):
    """A name with special characters of a shell works in the copied commands."""
    name = """a $HOME `id` "b" it's.exr"""
    os.symlink(os.path.abspath(ldi), name)
    os.mkdir("queue")
    with open("queue/sbatch", "w") as script:
        script.write("#!/bin/sh\n[ \"$1\" = --array=1-2 ] && [ \"$2\" = --wrap ] && [ $# = 3 ] || exit 9\nSLURM_ARRAY_TASK_ID=2 sh -c \"$3\"\n")
    os.chmod("queue/sbatch", 0o755)
    path = os.pathsep.join((os.path.abspath("queue"), os.path.abspath(folder), os.environ["PATH"]))
    with served(folder + "/dof-view", name, "--save", ".") as server:
        page = Page(browser, server)
        browser.run("part('last').value = 2; part('time').open = true")
        page.set_keys({1: 2, 2: 3})
        for form, made in (("job for Slurm", 2), ("command of all frames", 1)):
            subprocess.run(page.copies(form, "SLURM" if made == 2 else "--frames 1-2"), shell=True, check=True, env={**os.environ, "PATH": path})
            assert os.path.exists(name.replace(".exr", f".dof.{made:04}.exr")), form
        browser.run("part('save').click()")
        browser.until("part('said').textContent.startsWith('written: ') && part('said').classList.contains('note')")


def fits_small_windows(browser):
    """Below 800 pixels the panel is under the picture; H hides it."""
    boxes = "const f = part('frame').getBoundingClientRect(), a = document.querySelector('aside').getBoundingClientRect(); return [f.width, f.height, f.bottom, a.width, a.top, a.left, f.right]"
    with served(folder + "/dof-view", ldi) as server:
        page = Page(browser, server)
        for width in (480, 900):
            browser.resize(width, 720)
            frame_width, frame_height, frame_bottom, panel_width, panel_top, panel_left, frame_right = browser.run(boxes)
            assert browser.run("return document.documentElement.scrollWidth <= innerWidth")
            if width < 800:
                assert frame_width == panel_width == width and panel_top >= frame_bottom and frame_height > 300
            else:
                assert panel_left >= frame_right > 500
            page.shot(f"width-{width}")
            browser.press("h")
            hidden = browser.run(boxes)
            assert hidden[0] == width and hidden[1] > 600 and hidden[3] == 0, hidden
            browser.press("h")
        browser.resize(1280, 720)


def matches_plates(browser):
    """The plate lies behind the picture, and gives the lens by which it was gathered."""
    truth = ["--lens-radius", "0.11", "--focus-distance", "3"]
    subprocess.run([folder + "/dof-gather", ldi, *truth, "-o", "plate.exr"], check=True)
    with served(folder + "/dof-view", ldi, "--lens-radius", "0.16", "--plate", "plate.exr") as server:
        page = Page(browser, server)
        browser.until("part('below').width === 160")
        browser.press("r")
        browser.pointer(("move", *page.at(152, 80)), ("down",), ("move", *page.at(60, 40)), ("move", *page.at(10, 5)), ("up",))
        assert browser.run("return plate.region") == [10, 5, 152, 80]
        assert "fstop" not in browser.run("return state.settings"), "the drag did more than draw"
        page.shot("region")
        page.does(browser.press, "m")
        assert 2.9 < browser.run("return focusNow()") < 3.1
        assert 0.159 < browser.run("return apertureNow()") < 0.168 # f-number of 36 mm and a radius of 0.11 m: 0.1636
        assert browser.run("return part('said').textContent").startswith("matched: focus ")
        page.shot("matched")


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
            # A second page with its own settings, while the first one is open.
            settings = {"focus-distance": "2.5"}
            said = apart(server.ask("/picture", page="second", settings=settings))[0]
            assert said["lens"]["focus"] == 2.5
            page.does(page.click, 100, 20)
            assert browser.run("return focusNow()") != 2.5
            with served(folder + "/dof-view", ldi) as other:
                is_forgiving(Page(browser, other))
            has_frames(browser)
            has_frames_of_any_size(browser)
            has_pieces(browser)
            knows_objects(browser)
            guesses_a_lens(browser)
            matches_plates(browser)
            survives_names(browser)
            fits_small_windows(browser)
            outlives_the_server(browser)
        finally:
            browser.end()


if driver.missing():
    print(f"skipped: the page in a browser: {driver.missing()} is not installed")
else:
    main()
