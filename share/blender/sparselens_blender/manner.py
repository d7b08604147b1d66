"""How views are rendered, and how many were."""

import math
import os
from dataclasses import dataclass, field

from .shutter import Moment, of_moment
from .sub_pixels import AUTO


@dataclass
class Manner:
    """How views are rendered."""

    overscan: object = AUTO  # pixels of the scene's picture, or AUTO
    multilayer: bool = False
    layer: str = None        # the only view layer to render; None: all
    supersample: object = AUTO  # pixels per picture pixel, across and down
    finish: int = 0          # samples per pixel, both lens renders together
    slices: int = 0          # of volumes; 0: the views show the volumes
    layers: tuple = ()       # names of see-through things
    keep: bool = False       # keep unchanged views of an earlier run
    shutter: int = 1         # moments; 1: a still
    moment: Moment = None    # that is rendered
    overscans: dict = field(default_factory=dict)  # known ones, by centre view

    @property
    def attributes(self):
        return self.moment.attributes if self.moment else {}

    def path(self, whole):
        """The name of the moment's file, from that of a still's."""
        return of_moment(whole, self.moment.number) if self.moment else whole


@dataclass
class Count:
    """The numbers of rendered and kept views."""

    rendered: int = 0
    kept: int = 0
    most: int = 0  # of all frames
    paths: list = field(default_factory=list)  # of the rendered ones
    oldest: float = math.inf  # time of the oldest kept view

    def expect(self, views, frames):
        """Notes that each frame that is left has this number of views."""
        self.most = self.rendered + self.kept + views * frames

    def note(self, path):
        """Counts a rendered view, and says so."""
        self.rendered += 1
        self.paths.append(path)
        print("sparselens: %s: %s" % (os.path.basename(path), self.so_far()),
              flush=True)

    def so_far(self):
        done = self.rendered + self.kept
        return "%d of %d views, %d %%" % (done, self.most, 100 * done
                                          // max(self.most, 1))

    def keep(self, paths):
        self.kept += len(paths)
        self.oldest = min([self.oldest, *map(os.path.getmtime, paths)])
