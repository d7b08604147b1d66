"""Starts a dof-view and reads its answers, for its tests."""
import contextlib
import json
import struct
import subprocess
import urllib.error
import urllib.request


class Served:
    def __init__(self, program, *words):
        self.process = subprocess.Popen([program, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        if not self.address:
            raise RuntimeError(self.process.stderr.read())
        self.base, self.key = self.address.split("/?key=")
        self.port = int(self.base.rsplit(":", 1)[1])

    def send(self, path, body, headers=None, timeout=120):
        """Returns status and bytes."""
        headers = {"X-Sparselens-Key": self.key, "Content-Type": "application/json", **(headers or {})}
        request = urllib.request.Request(self.base + path, body, headers)
        try:
            with urllib.request.urlopen(request, timeout=timeout) as answer:
                return answer.status, answer.read()
        except urllib.error.HTTPError as error:
            return error.code, error.read()

    def ask(self, path, page="test", **asked):
        status, said = self.send(path, json.dumps({"page": page, **asked}).encode())
        if status != 200:
            raise RuntimeError(f"{path}: {status} {said.decode(errors='replace')}")
        return said

    def said(self, path, **asked):
        return json.loads(self.ask(path, **asked))

    def picture(self, path="/picture", **asked):
        """Returns the JSON of an answer and its pixels."""
        return apart(self.ask(path, **asked))

    def memory(self, what="VmRSS"):
        """Memory of the process, in MB."""
        with open(f"/proc/{self.process.pid}/status") as status:
            return next(int(line.split()[1]) / 1024 for line in status if line.startswith(what))

    def end(self):
        self.process.terminate()
        self.process.wait(timeout=20)
        self.process.stdout.close()
        self.process.stderr.close()


def apart(answer):
    size = struct.unpack("<I", answer[:4])[0]
    return json.loads(answer[4:4 + size]), answer[4 + size:]


@contextlib.contextmanager
def served(program, *words):
    server = Served(program, *words)
    try:
        yield server
    finally:
        server.end()
