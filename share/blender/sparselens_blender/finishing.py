"""Finishes the picture of a scene's frame with two renders through the
lens."""

import json
import os
from dataclasses import replace

from . import pictures, tools
from .chain import Chain
from .halves import check_halves, check_looks, halves_steps
from .kept import of_other_file
from .looks import looks_of
from .one_view import view_steps
from .renders import folder_of, used_layers
from .shots import eyes_of
from .render_job import chosen_folder, image_of, show


class Finishing:
    """The pictures of the current frame, one for each eye: gathered as Take
    Picture does, then finished."""

    def __init__(self, scene, manner):
        settings = scene.sparselens
        self.scene, self.images, self.warnings = scene, [], []
        self.cost = ""  # a further focus takes new rays
        self.tools, _ = tools.find(chosen_folder())
        self.looks, layer = looks_of(settings), used_layers(scene)[0]
        check_halves(scene, manner.shutter)
        check_looks(self.looks)
        self.rays = replace(manner, multilayer=False, layer=layer,
                            finish=max(settings.finish, 2))
        self.asked_for = 0
        if settings.finish_where_needed and self.rays.finish >= 4:
            self.asked_for = self.rays.finish
            self.rays = replace(self.rays, finish=self.asked_for // 2)
        self.layer = layer if manner.multilayer else None
        views = folder_of(settings.folder)
        self.eyes = []
        for eye in eyes_of(scene):
            files, shot = pictures.files_to_take(
                scene, views, eye, settings.views, manner.supersample)
            self.warnings += filter(None, [of_other_file(files.each("center"))])
            self.eyes.append((eye, shot, files))

    def run(self, commands):
        chain = Chain(commands)
        yield chain
        self.warnings += chain.warnings

    def asking(self, files):
        """Options of dof-finish: where the other half of the rays is worth
        most."""
        path = files.path("mask")
        if os.path.exists(path + ".json"):
            os.remove(path + ".json")
        return ["--ask", path, "--rays", str(self.asked_for),
                "--stats", path + ".json"]

    def asked(self, files):
        path = files.path("mask") + ".json"
        with open(path, encoding="utf-8") as file:
            found = json.load(file).get("ask", [])
        os.remove(path)
        return found

    def steps(self):
        """Yields the renders, in words, and the chains of tools."""
        for eye, shot, files in self.eyes:
            yield from halves_steps(self.scene, files.path, eye, self.rays,
                                    view_steps)
            made = files.path("picture")
            yield from self.run([
                *pictures.warp_commands(self.tools, files, self.layer),
                pictures.gather_command(
                    self.tools, files.path("ldi"), files.path("gathered"),
                    pictures.lens_options(shot, self.looks)),
                pictures.finish_command(self.tools, files, made, options=(
                    self.asking(files) if self.asked_for else ()))])
            asked = self.asked(files) if self.asked_for else []
            if asked:
                yield from halves_steps(self.scene, files.path, eye, self.rays,
                                        view_steps, asked)
                yield from self.run([pictures.finish_command(
                    self.tools, files, made, len(asked))])
            image = image_of(self.scene.name, eye, made)
            show(image)
            self.images.append(image.name)
