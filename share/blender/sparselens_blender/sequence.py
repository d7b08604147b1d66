"""Pictures of frames: views, LDI and picture, frame by frame."""

import os
import re
from dataclasses import replace

import bpy

from . import costs, pictures, tools
from .chain import Chain, Once
from .temporary_settings import other_files, samples_of
from .halves import check_halves, check_looks, halves_steps
from .looks import looks_of
from .manner import Count
from .one_view import view_steps
from .renders import folder_of, frame_ending, used_layers, views_steps
from .shots import shot_of
from .shutter import shutter_options
from .views import counted, numbered, views_of_lens

FORMATS = {".exr": "OPEN_EXR", ".png": "PNG", ".jpg": "JPEG", ".jpeg": "JPEG",
           ".tif": "TIFF", ".tiff": "TIFF", ".tga": "TARGA", ".bmp": "BMP"}


def format_of(name, scene):
    """The ending of a picture's name, and Blender's word for such a file. A
    name without an ending gets the one of the scene's output settings."""
    ending = os.path.splitext(name)[1].lower()
    if ending in FORMATS:
        return "", FORMATS[ending]
    if re.fullmatch(r"\.[a-z]{2,5}", ending):
        raise ValueError("-o %s: pictures end in one of %s" % (
            name, " ".join(FORMATS)))
    kind = scene.render.image_settings.file_format
    if kind == "OPEN_EXR_MULTILAYER":
        kind = "OPEN_EXR"
    if scene.render.is_movie_format:
        raise ValueError("the scene's output is a film (%s), and sparselens "
                         "makes pictures: give their name an ending, such as "
                         "-o //out/####.png" % kind)
    return (".exr" if kind == "OPEN_EXR" else scene.render.file_extension,
            kind)


class Pictures:
    """Views, LDIs and pictures of frames; options as in options.py."""

    render_again = "if more than the lens has changed, give --again"

    def __init__(self, scene, eyes, manner, options, say):
        self.scene, self.eyes, self.manner, self.options = (
            scene, eyes, manner, options)
        self.say = Once(say)
        self.tools, _ = tools.find(options.tools)
        self.ending, self.kind = format_of(options.output, scene)
        self.name = os.path.join(
            folder_of(os.path.dirname(options.output) or "."),
            os.path.basename(options.output)) + self.ending
        self.views = folder_of(options.views_folder or os.path.join(
            os.path.dirname(self.name), "views"))
        self.count, self.made, self.cost = Count(), 0, ""
        if options.finish:
            check_halves(scene, manner.shutter)
            check_looks(self.looks())
        if options.multilayer and not options.layer:
            used = used_layers(scene)
            if len(used) > 1:
                raise ValueError("--multilayer: a picture is of one of the "
                                 "view layers %s: choose it by --layer"
                                 % ", ".join(used))

    def looks(self):
        """The looks at the current frame: the panel's, which may be keyed,
        unless others are given."""
        return (looks_of(self.scene.sparselens) if self.options.looks is None
                else self.options.looks)

    def steps(self, frames):
        """Yields the renders, in words, and chains of tools to run."""
        several = "#" in os.path.basename(self.name)
        if len(frames) > 1 and not several:
            raise ValueError("-o %s: %d frames need a # in the name, for the "
                             "number" % (self.options.output, len(frames)))
        os.makedirs(os.path.dirname(self.name), exist_ok=True)
        before, within = self.scene.frame_current, self.scene.frame_subframe
        views = views_of_lens(self.options.views, 0)
        try:
            for frame in frames:
                self.scene.frame_set(frame)
                yield from views_steps(
                    self.scene, [frame], self.views, lambda _: views,
                    self.eyes, self.manner, self.count, several, self.say,
                    frames)
                for eye in self.eyes:
                    files = pictures.Files(
                        self.views, eye.file_suffix,
                        frame_ending(frame, several), self.options.views,
                        self.manner.shutter)
                    if self.options.finish:
                        yield from halves_steps(
                            self.scene, files.path, eye,
                            replace(self.manner, multilayer=False,
                                    finish=self.options.finish), view_steps)
                    yield from self.take(frame, eye, files)
        finally:
            self.scene.frame_set(before, subframe=within)
            self.say.end()
        self.warn_of_kept()

    def take(self, frame, eye, files):
        """Makes the picture of the views, and of the rays if there are any."""
        shot = shot_of(self.scene, eye)
        stem, ending = os.path.splitext(numbered(self.name, frame))
        out = stem + eye.file_suffix + ending
        made = out if self.kind == "OPEN_EXR" else files.path("picture")
        layer = self.options.multilayer and self.manner.layer
        gathered = files.path("gathered") if self.options.finish else made
        looks = self.looks()
        if self.options.finish:
            check_looks(looks)
        chain = Chain([
            *pictures.warp_commands(self.tools, files, layer),
            pictures.gather_command(
                self.tools, files.of_moments("ldi"), gathered,
                pictures.lens_options(shot, looks) + shutter_options(
                    self.scene, self.manner.shutter, self.views)),
            *([pictures.finish_command(self.tools, files, made)]
              if self.options.finish else [])])
        print("sparselens: frame %d: making the picture of %s%s" % (
            frame, counted(len(files.each_of("")), "view"),
            self.parts_in_words()), flush=True)
        yield chain
        if not self.options.finish:
            self.cost = costs.in_words(
                pictures.rendered_files(files), chain.seconds)
        for text in chain.warnings:
            self.say(text.split(": warning: ", 1)[1])
        if made != out:
            self.save(made, out)
        self.made += 1
        print("sparselens: frame %d: %s" % (frame, out), flush=True)

    def parts_in_words(self):
        """What makes a picture take longer, and the number of samples."""
        manner = self.manner
        return "".join([
            " of %d samples a pixel" % samples_of(self.scene),
            manner.shutter > 1 and ", %d moments" % manner.shutter or "",
            manner.slices and ", volumes in %d slices" % manner.slices or "",
            manner.layers and ", %s" % counted(
                len(manner.layers), "see-through layer") or ""])

    def warn_of_kept(self):
        """Warns if the scene's file is newer than kept views: the scene may
        differ from them."""
        blend = bpy.data.filepath
        if self.count.kept and os.path.exists(blend) and \
                os.path.getmtime(blend) > self.count.oldest:
            self.say("%s was saved after views that are kept were rendered: "
                     "%s" % (os.path.basename(blend), self.render_again))

    def words(self):
        return "%s in %s, of %s rendered and %d kept in %s" % (
            counted(self.made, "picture"), os.path.dirname(self.name),
            counted(self.count.rendered, "view"), self.count.kept, self.views)

    def save(self, path, out):
        """Writes the picture with the scene's output settings and view
        transform."""
        stem, ending = os.path.splitext(out)
        partial = stem + ".partial" + ending
        image = bpy.data.images.load(path)
        settings = self.scene.render.image_settings
        values = {"file_format": self.kind}
        if "media_type" in settings.bl_rna.properties:  # since Blender 5
            values = {"media_type": "IMAGE"} | values
        try:
            with other_files(settings, **values):
                image.save_render(partial, scene=self.scene)
            os.replace(partial, out)
        finally:
            bpy.data.images.remove(image)
            if os.path.exists(partial):
                os.remove(partial)
