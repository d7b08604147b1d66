"""How views are rendered, and how many were."""

import math
import os
from dataclasses import dataclass

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
    oldest: float = math.inf  # time of the oldest kept view

    def keep(self, paths):
        self.kept += len(paths)
        self.oldest = min([self.oldest, *map(os.path.getmtime, paths)])
