"""protocol.py BIN_DIR LDI REFERENCE SMALL [--all]: the answers of dof-view, its refusals, and its behaviour under load.
LDI and REFERENCE have 160x90 pixels, the LDI SMALL 96x54. The load takes longest, so it is tested with --all only."""
import concurrent.futures
import contextlib
import json
import ntpath
import os
import pathlib
import re
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

from served import apart, served

program, (ldi, reference, small) = sys.argv[1] + "/dof-view", sys.argv[2:5]
ANSWERED = "/facts", "/picture", "/pieces", "/reference", "/plate", "/match", "/rendered", "/objects", "/samples", "/progress", "/commands", "/save"


def knows_the_options(server):
    """The page sets only options that the server's table has."""
    for script in (pathlib.Path(__file__).parents[2] / "tools/viewing/page").glob("*.js"):
        text = script.read_text()
        options = re.findall(r"settings\.(\w+)|settings\['([^']*)'|\b(?:set|typed|baked)\('([^']*)'|'([a-z]+(?:-[a-z]+)+)'", text)
        for option in {name for found in options for name in found if name} - {"f-number", "dof-gather"}:
            server.said("/commands", settings={option: ""})


def answers(server):
    facts = server.said("/facts")
    assert (facts["width"], facts["height"]) == (160, 90) and facts["reference"], facts
    said, pixels = server.picture(settings={})
    assert len(pixels) == said["width"] * said["height"] * said["channels"] == 160 * 90 * said["channels"]
    near, focus, far = (said["lens"][name] for name in ("near", "focus", "far"))
    assert near < focus < far and said["lens"]["largest_coc"] > 1, said
    assert server.picture(settings={"fstop": "16"})[0]["lens"]["largest_coc"] < said["lens"]["largest_coc"]
    brighter = server.picture(settings={}, exposure=1)[1]
    assert sum(brighter) > 1.1 * sum(pixels) and server.picture(settings={})[1] == pixels
    small, few = server.picture(settings={"proxy": "4", "quality": "draft"})
    assert (small["width"], small["height"]) == (40, 23), small
    for path in "/reference", "/rendered":
        other = server.picture(path)[1]
        assert len(other) >= 160 * 90 * 3 and other != pixels, path
    assert server.picture("/rendered")[1] == server.picture(settings={"lens-radius": "0"})[1]
    for overlay in "coc", "focus", "layers", "tiles":
        assert server.picture(settings={"show": overlay})[1] != pixels, overlay
    server.picture(settings={})
    samples = server.said("/samples", settings={}, pixel=[80, 45])
    assert samples["samples"][0]["z"] > 0 and set(samples["value"]) == set("RGBA"), samples
    focused = server.picture(settings={"focus-distance": str(samples["samples"][0]["z"])})[0]
    assert focused["lens"]["focus"] == samples["samples"][0]["z"]
    command = server.said("/commands", settings={"fstop": "2.5", "tilt": "-3,4", "cat-eye-darkening": "on"})
    assert "--fstop 2.5" in command["shell"] and "--tilt -3,4" in command["shell"], command
    assert "fstop=2.5" in command["python"] and "tilt=(-3,4)" in command["python"], command


def matches_plates(folder):
    """The lens of a plate that was gathered by another lens, in a region; what cannot be matched is said."""
    plate = os.path.join(folder, "plate.exr")
    truth = ["--lens-radius", "0.11", "--focus-distance", "3", "--quality", "final"]
    subprocess.run([sys.argv[1] + "/dof-gather", small, *truth, "-o", plate], check=True)
    with served(program, small, "--lens-radius", "0.16", "--plate", plate) as server:
        assert server.said("/facts")["plate"]
        said, shown = server.picture("/plate")
        same = server.picture(settings={"lens-radius": "0.11", "focus-distance": "3", "quality": "final"})[1]
        same = [value for i, value in enumerate(same) if i % 4 < 3] # the file's A is 1, rounded
        assert said["channels"] == 3 and max(abs(a - b) for a, b in zip(shown, same, strict=True)) <= 1
        found = server.said("/match", settings={"lens-radius": "0.05"}, region=[5, 0, 89, 53])
        assert 2.9 < found["focus_distance"]["value"] < 3.1 and 0.106 < found["lens_radius"]["value"] < 0.114, found
        code, said = server.send("/match", b'{"page": "a", "settings": {}, "region": [0, 0, 9, 9]}')
        assert code != 200 and b"nothing to compare" in said, (code, said)
    with served(program, ldi) as server:
        assert status(server, {"page": "a", "settings": {}}, "/match") == 400


def status(server, body, path="/picture", **headers):
    headers = {name.replace("_", "-"): value for name, value in headers.items()}
    return server.send(path, body if isinstance(body, bytes) else json.dumps(body).encode(), headers)[0]


def refuses(server):
    good = {"page": "a", "settings": {}}
    assert status(server, good) == 200
    port = server.port
    wrong_key = ("0" if server.key[0] != "0" else "1") + server.key[1:]
    for headers in ({"X_Sparselens_Key": ""}, {"X_Sparselens_Key": wrong_key}, {"X_Sparselens_Key": server.key[:-1]},
                    {"X_Sparselens_Key": server.key + "0"}, {"Host": f"evil.example:{port}"}, {"Host": f"127.0.0.1.evil.example:{port}"},
                    {"Host": ""}, {"Origin": "http://evil.example"}, {"Origin": "null"}, {"Origin": f"https://127.0.0.1:{port}"},
                    {"Origin": "http://127.0.0.1:1"}):
        for path in (*ANSWERED, "/none"):
            assert status(server, good, path, **headers) == 403, (path, headers)
    for headers in ({"Host": "localhost:9000"}, {"Host": f"[::1]:{port}"}, {"Origin": f"http://127.0.0.1:{port}"}):
        assert status(server, good, **headers) == 200, headers
    for body in (b"", b"{", b"[]", b"null", b"\xff\xfe", b"[" * 16000, b'{"page": 1}', b'{"page": "../a"}', b'{"settings": {}}', b'{"page":"a","x":1}',
                 b'{"page":"a","pixel":[1]}', b'{"page":"a","pixel":[1e99,2]}', b'{"page":"a","exposure":1e9}', b'{"page":"a","settings":[]}',
                 b'{"page":"a","region":[1,2,3]}', b'{"page":"a","region":[4,0,3,9]}'):
        assert status(server, body) == 400, body
    # A page can name no file, and can only set options of the picture.
    for settings in ({"lens": "x"}, {"holdout": "x"}, {"colorconfig": "x"}, {"output": "x"}, {"threads": "9"}, {"aperture": "x"}, {"device": "gpu"},
                     {"fstop": "/etc/passwd"}, {"fstop": "2 --lens x"}, {"fstop": 2}, {"fstop": "-1"}, {"fstop": "two"}, {"tilt": "1"}, {"show": "all"},
                     {"blades": "2"}, {"fstop": "2" * 65}):
        assert status(server, {"page": "a", "settings": settings}) == 400, settings
    assert status(server, {"page": "a", "pixel": [0, 0], "settings": {"quality": "best"}}, "/samples") == 400
    assert status(server, good, "/save") == 400
    assert status(server, b" " * 100_000) in (400, 413)
    assert status(server, good, "/../../etc/passwd") == 404
    for line in (b"GET", b"\0\0\0\0\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"POST /picture HTTP/1.1\r\nContent-Length: -5\r\n\r\n", b"A" * 100_000):
        with socket.create_connection(("127.0.0.1", port)) as raw:
            try:
                raw.sendall(line)
                raw.shutdown(socket.SHUT_WR)
                answer = raw.recv(64)
                assert not answer or answer.split()[1] in (b"400", b"403", b"404", b"413", b"431"), (line[:50], answer)
            except (BrokenPipeError, ConnectionResetError):
                pass
    assert status(server, good) == 200


def listens_here_alone(server):
    with open("/proc/net/tcp") as table:
        at = [line.split()[1] for line in table if f":{server.port:04X} " in line and line.split()[3] == "0A"]
    assert at == [f"0100007F:{server.port:04X}"], at


def bears_many(server):
    """1000 silent connections, or ones that send half a request byte by byte: memory does not grow, and a page is still
    answered."""
    before = server.memory()
    many = []
    for i in range(1000):
        raw = socket.create_connection(("127.0.0.1", server.port))
        if i % 3 == 0:
            raw.sendall(b"POST /picture HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Le")
        many.append(raw)
    ended = threading.Event()

    def drip():
        while not ended.wait(.2):
            for raw in many:
                with contextlib.suppress(OSError):
                    raw.send(b"G")

    dripping = threading.Thread(target=drip)
    dripping.start()
    try:
        for _ in range(3):
            assert status(server, {"page": "a", "settings": {}}) == 200
        assert server.memory() < before + 50, (before, server.memory())
    finally:
        ended.set()
        dripping.join()
        for raw in many:
            raw.close()
    body = json.dumps({"page": "slow", "settings": {}}).encode()
    with socket.create_connection(("127.0.0.1", server.port)) as slow:
        slow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        slow.sendall(b"POST /picture HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Sparselens-Key: %s\r\nContent-Length: %d\r\n\r\n%s" %
                     (server.key.encode(), len(body), body))
        slow.recv(10)
        assert status(server, {"page": "a", "settings": {}}) == 200
    assert server.memory() < before + 50, (before, server.memory())


def bears_lines_without_end(server):
    """Four lines of 64 MB, with and without a request before them: memory does not grow, and none is read to its
    end."""
    before = server.memory()
    piece = b"y" * 65536
    for begun in (b"", b"GET / HTTP/1.1\r\nHost: ", b"POST /picture HTTP/1.1\r\nContent-Length: 64000000\r\n\r\n", b"GET /?key="):
        with socket.create_connection(("127.0.0.1", server.port)) as raw:
            taken = 0
            with contextlib.suppress(OSError):
                raw.sendall(begun)
                while taken < 1024:
                    raw.sendall(piece)
                    taken += 1
                    assert server.memory() < before + 10, (begun, taken, before, server.memory())
        assert status(server, {"page": "a", "settings": {}}) == 200


def bears_little_memory():
    """If a picture finds no memory, the page is told, and the next picture is made."""
    subprocess.run([program.replace("dof-view", "dof-trace"), "fence", "--size", "1920x1080", "--spp", "1", "--views", "0", "-o", "large"], check=True)
    with served(program, "large/center.exr") as server:
        server.said("/facts") # starts that page's threads
        size = int(server.memory("VmSize") * 2**20)
        resource.prlimit(server.process.pid, resource.RLIMIT_AS, (size, resource.RLIM_INFINITY))
        code, why = server.send("/picture", json.dumps({"page": "a", "settings": {}}).encode())
        assert (code, why) == (500, b"there is not enough memory for this\n"), (code, why)
        resource.prlimit(server.process.pid, resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        server.picture(settings={})


def newest_wins(server):
    """Ten moves, each before the picture of the last one can be ready, give one picture; other pages keep theirs."""
    def move(i):
        return server.send("/picture", json.dumps({"page": "moving", "settings": {"focus-distance": str(2 + i)}}).encode())

    finished = server.said("/progress")["finished"]
    with concurrent.futures.ThreadPoolExecutor(12) as pool:
        moves = [pool.submit(move, 0)]
        while "stage" not in server.said("/progress", page="moving"):
            pass
        for i in range(1, 10):
            moves.append(pool.submit(move, i))
            moves[i - 1].result() # after the newer one has come
        other = pool.submit(server.picture, page="other", settings={"focus-distance": "20"})
        codes = [done.result()[0] for done in moves]
        assert other.result()[0]["lens"]["focus"] == 20
    assert codes == [409] * 9 + [200], codes
    assert apart(moves[9].result()[1])[0]["lens"]["focus"] == 11
    assert server.said("/progress")["finished"] == finished + 2, "works that nobody wants were finished"


def makes_pieces(server):
    """Tiles from a pixel outwards, before the picture is complete and with its values, only for their page."""
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        done = pool.submit(server.picture, page="b", settings={}, pixel=[150, 80])
        found = []
        while not done.done():
            said, pixels = apart(server.ask("/pieces", page="b"))
            assert not apart(server.ask("/pieces", page="c"))[0]["pieces"]
            for piece in said["pieces"]:
                size = piece["width"] * piece["height"] * piece["channels"]
                found.append((piece, pixels[:size]))
                pixels = pixels[size:]
            assert not pixels
        said, whole = done.result()
    assert 1 <= len(found) <= 6 and (found[0][0]["x"], found[0][0]["y"]) == (128, 64), found
    def rgba(said, pixels):
        return pixels if said["channels"] == 4 else b"".join(pixels[i:i + 3] + b"\xff" for i in range(0, len(pixels), 3))

    stride, whole = 4 * said["width"], rgba(said, whole)
    for piece, pixels in found:
        begin, size = piece["y"] * stride + 4 * piece["x"], 4 * piece["width"]
        assert rgba(piece, pixels) == b"".join(whole[begin + y * stride:begin + y * stride + size] for y in range(piece["height"])), piece
    assert not apart(server.ask("/pieces", page="b"))[0]["pieces"]


def knows_frames(folder):
    """Each frame equals that of dof-gather, keyed values are those of the frame, and the next frames are read ahead."""
    sequence = os.path.join(folder, "shot.####.ldi.exr")
    for number, source in ((3, ldi), (4, reference), (5, ldi), (7, ldi)):
        os.symlink(os.path.abspath(source), sequence.replace("####", f"{number:04}"))
    with served(program, sequence, "--fstop", "3:2,7:6") as server:
        facts = server.said("/facts", frame=5)
        assert facts["frames"] == [3, 4, 5, 7] and facts["file"].endswith("shot.0005.ldi.exr"), facts
        assert [server.picture(settings={}, frame=n)[0]["lens"]["fstop"] for n in (3, 5, 7)] == [2, 4, 6]
        assert status(server, {"page": "a", "frame": 4, "settings": {}}) == 500 # it has no depth
        for path in "/picture", "/facts", "/objects", "/samples", "/commands", "/rendered":
            assert status(server, {"page": "a", "frame": 6, "settings": {}, "pixel": [1, 1]}, path) == 400, path
        commands = server.said("/commands", settings={}, frame=7)
        assert "shot.0007.ldi.exr" in commands["shell"] and "--fstop 6" in commands["shell"], commands
        assert commands["range"] == [sequence, "--fstop", "3:2,7:6"] and commands["range_output"] == "shot.dof.####.exr", commands
        assert "shot.0007.ldi.exr" in commands["python"], commands
        assert server.said("/commands", settings={"fstop": "8"}, frame=7)["range"] == [sequence, "--fstop", "8"]
    for limit, held in ((None, 3), ("900KB", 2)):
        with served(program, sequence, "--frames", "3,5,7", *(["--max-memory", limit] if limit else [])) as server:
            end = time.monotonic() + 20
            while server.said("/progress", page="any")["held"] < held:
                assert time.monotonic() < end, "no frame is read ahead"
                time.sleep(.01)
            time.sleep(.2 if limit else 0)
            assert server.said("/progress", page="any")["held"] == held, limit
    with served(program, ldi) as server:
        assert status(server, {"page": "a", "frame": 1, "settings": {}}) == 400


def main():
    with served(program, ldi, "--reference", reference) as server:
        knows_the_options(server)
        answers(server)
        refuses(server)
        listens_here_alone(server)
        if "--all" in sys.argv:
            bears_many(server)
            bears_lines_without_end(server)
            bears_little_memory()
        with served(program, ldi) as second:
            assert second.key != server.key and second.port != server.port
            assert status(server, {"page": "a"}, X_Sparselens_Key=second.key) == 403
    with served(program, ldi, "--lens-samples", "8000", "--threads", "1") as server:
        makes_pieces(server)
        newest_wins(server)
    with tempfile.TemporaryDirectory() as folder, served(program, ldi, "--save", folder) as server:
        assert not os.listdir(folder)
        files = [server.said("/save", settings={})["file"] for _ in range(2)]
        assert sorted(os.listdir(folder)) == sorted(map(ntpath.basename, files)) and len(set(files)) == 2, files
    with tempfile.TemporaryDirectory() as folder:
        knows_frames(folder)
        matches_plates(folder)
    with served(program, ldi) as server: # as when its terminal is closed
        os.kill(server.process.pid, signal.SIGHUP)
        assert server.process.wait(timeout=20) == -signal.SIGHUP


main()
