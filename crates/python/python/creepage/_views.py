"""What each view of a picture shows: from where, how much, and deformation how large. Lengths are in m."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ._frames import BAR

# height of a close view over the length of the patch; where there is none, over the height of the disk
PATCHES, HEIGHTS = 1.8, 0.07
# deformation below this share of a view is round-off
ROUND_OFF = 1e-9
# longest arrow, and the least distance of two, over the height of a view
ARROW, APART = 0.065, 0.045


class Seen:
    """The direction in which a camera looks (z is up, x to the right in all), and what the largest deformation takes
    of the height of its view, unless the magnification is given."""

    WHOLE = (-0.35, 1.0, -0.3), 0.02
    CUT = (-0.18, 1.0, -1.0), 0.12
    SIDE = (-0.07, 1.0, -0.19), 0.12
    ABOVE = (-0.25, 0.8, -1.0), 0.05
    BELOW = (-0.25, 0.8, 1.0), 0.05


@dataclass
class Pane:
    """A view: which faces are seen from where, and by how much deformation is magnified."""

    title: str
    faces: np.ndarray
    toward: tuple
    share: float
    mirrored: bool = False
    whole: bool = False  # the camera stays, and shows all
    on_bodies: np.ndarray | None = None  # faces of the bar's contact surface, in the records of the contact
    span: float = math.nan  # height of the view (m)
    magnify: float = math.nan
    deforms: bool = True
    lift: float = 0.0  # of the disk (m)
    centre: np.ndarray | None = None
    arrows: np.ndarray | None = None  # nodes of the contact that may have one

    @property
    def towards(self):
        """The direction in which the camera looks, of the length 1."""
        return np.array(self.toward) / np.linalg.norm(self.toward)

    def fix(self, bounds, aspect):
        """Fixes what is to be the same in all pictures; ``aspect`` is the width of the view over its height."""
        size = bounds.high - bounds.low
        toward = self.towards
        if self.whole:
            self.centre = 0.5 * (bounds.low + bounds.high)
            right = np.cross(toward, (0.0, 0.0, 1.0)) / math.hypot(*toward[:2])
            height, width = (size @ np.abs(axis) for axis in (np.cross(right, toward), right))
            self.span = 1.05 * max(height, width / aspect)
        if not math.isfinite(self.span):
            known = bounds.patch.max() > 0
            self.span = PATCHES * bounds.patch.max() if known else HEIGHTS * size.max()
        self.deforms = bounds.deformation > ROUND_OFF * self.span
        if not math.isfinite(self.magnify):
            fitting = self.share * self.span / max(bounds.deformation, ROUND_OFF * self.span)
            self.magnify = rounded(max(fitting, 1.0), down=True) if self.deforms else 1.0
        if self.on_bodies is not None:  # so far that it does not hide the patch
            self.lift = min(0.75 * bounds.patch[1] * abs(toward[2] / toward[1]), 0.25 * self.span)


@dataclass
class Bounds:
    """What is largest in the records that are drawn."""

    value: float = 0.0
    deformation: float = 0.0
    pressure: float = 0.0
    arrow: float = 0.0
    patch: np.ndarray = field(default_factory=lambda: np.zeros(2))  # length and width (m)
    low: np.ndarray = field(default_factory=lambda: np.full(3, np.inf))
    high: np.ndarray = field(default_factory=lambda: np.full(3, -np.inf))

    def take(self, found, contact):
        """Adds tractions."""
        peak = found.pressure.max()
        self.pressure = max(self.pressure, peak)
        self.arrow = max(self.arrow, np.linalg.norm(found.arrows, axis=1).max())
        on_bar = np.unique(contact.cells[contact.body == BAR])
        loaded = on_bar[found.loaded(peak)[on_bar]]
        if len(loaded):
            self.patch = np.maximum(self.patch, np.ptp(found.frame.placed[loaded, :2], axis=0))


def behind(source):
    """The cells with y > 0; all of a slice of one element, which has none there."""
    kept = source.points[source.cells, 1].mean(axis=1) > 0
    return kept if kept.any() else np.ones(len(kept), bool)


def thinned(source, faces, apart):
    """Nodes of faces that are about so far apart: of a regular mesh every one, every second..."""
    nodes = np.unique(faces)
    places = source.points[nodes]
    edges = source.points[faces] - source.points[np.roll(faces, 1, axis=1)]
    edge = np.median(np.linalg.norm(edges, axis=2))
    step = edge * max(1, round(apart / edge))
    cells = np.floor((places[:, :2] - places[0, :2]) / step + 0.5)
    off = np.linalg.norm(places[:, :2] - places[0, :2] - cells * step, axis=1)
    order = np.argsort(off, kind="stable")
    _, first = np.unique(cells[order], axis=0, return_index=True)
    return np.sort(nodes[order[first]])


def rounded(size, down=False):
    """The nearest of 1, 2 and 5 times a power of ten that is not below ``size``, or not above."""
    power = 10.0 ** math.floor(math.log10(size))
    steps = [float(f"{factor * power:.6g}") for factor in (1, 2, 5, 10)]
    near = 1e-9 * size
    return max(s for s in steps if s <= size + near) if down else min(s for s in steps if s >= size - near)


def scale(largest):
    """The round end of a colour bar, and the equal parts into which it is divided."""
    if not largest > 0:
        return 1.0, 4
    step = rounded(largest / 6)
    parts = math.ceil(largest / step - 1e-9)
    return parts * step, parts
