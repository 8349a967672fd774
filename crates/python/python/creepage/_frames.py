"""The records of a run as they are drawn: places, deformations and values at all nodes.

Deformation is a displacement without the rigid motion of its body. Lengths are in m, times in s, values in the unit of
their label.
"""

from __future__ import annotations

import contextlib
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ._errors import CaseError
from ._run import _NAMES, Records

# what the colours can show: of which file, of which dataset, label with the unit, size of that unit
QUANTITIES = {
    "von_mises": ("fields", "stress", "von Mises stress (MPa)", 1e6),
    "velocity": ("fields", "velocity", "speed (m/s)", 1.0),
    "deformation": ("fields", None, "deformation (µm)", 1e-6),
    "pressure": ("contact", "pressure", "pressure (MPa)", 1e6),
    "shear": ("contact", "shear", "shear traction (MPa)", 1e6),
    "slip_velocity": ("contact", "slip_velocity", "slip velocity (m/s)", 1.0),
}
DISK, BAR = 0, 1


# pressure below this share of the largest is the ragged edge of the patch
EDGE = 0.01
# shear below this share of the pressure is what a preload without friction leaves
ROUND_OFF = 1e-6
DISK, BAR = 0, 1


@dataclass
class Frame:
    """A record: places and deformations of the nodes (m), what the colours show, the point below the axis."""

    placed: np.ndarray
    deformation: np.ndarray
    values: np.ndarray
    lowest: np.ndarray

    def magnified(self, times):
        """Places of the nodes with their deformation ``times`` as large."""
        return self.placed + (times - 1.0) * self.deformation


class Source:
    """The records of the bodies or of the contact surfaces of the run in ``folder``."""

    def __init__(self, folder, what):
        self.what, self.path = what, Path(folder) / _NAMES[what]
        self.records = Records(self.path)
        self.times = self.records.times
        self.points, self.cells = self.records.points, self.records.cells
        name = _NAMES["body"]
        self.body = self.records[name][:] if name in self.records else np.zeros(len(self.cells), int)
        self.disk = np.unique(self.cells[self.body == DISK])
        self.bar = np.unique(self.cells[self.body == BAR])
        # whether the part y >= 0 alone is in the file; of whole bodies it does not say
        self.half = False
        with contextlib.suppress(OSError):
            self.half = what == "fields" and self.records._file.attribute("symmetry") == "half"

    def shows(self, quantity):
        """Whether the run wrote what the quantity is made of."""
        dataset = QUANTITIES[quantity][1]
        return dataset is None or dataset in self.records or quantity in self.records

    def read(self, name, record):
        """A dataset of a record (SI), all its numbers finite."""
        values = self.records[name][record]
        wrong = np.argwhere(~np.isfinite(values))
        if len(wrong):
            place = "element" if self.records[name].on_cells else "node"
            when = f"at {place} {wrong[0][0]} at t = {self.times[record]:g} s"
            raise CaseError(f"{self.path}: {name} is not a number {when}; the run went wrong before")
        return values

    def has(self, name):
        """Whether the run wrote a dataset."""
        return name in self.records

    def frame(self, record, quantity):
        """The record with ``quantity`` at its nodes."""
        points, disk = self.points, self.disk
        # contact histories of other programs need not have it
        moved = self.read("displacement", record) if self.has("displacement") else np.zeros_like(points)
        placed = points + moved
        if self.has("deformation"):
            deformation = self.read("deformation", record)
        else:
            deformation = moved
            if len(disk):
                deformation[disk] = placed[disk] - fit(points[disk], placed[disk])(points[disk])
            deformation[self.bar, 0] -= moved_on(moved[self.bar, 0])
        lowest = placed.mean(axis=0)
        if len(disk):
            axis = np.array([0.0, 0.0, 0.5 * (points[disk, 2].min() + points[disk, 2].max())])
            rigid = fit(points[disk], (placed - deformation)[disk])
            lowest = np.array([rigid(axis)[0], 0.0, placed[disk, 2].min()])
        return Frame(placed, deformation, self.values(quantity, record, deformation), lowest)

    def values(self, quantity, record, deformation):
        """The quantity at every node, in the unit of its label."""
        _, dataset, _, unit = QUANTITIES[quantity]
        if quantity == "von_mises":
            known = self.has(quantity)  # of older runs it is made of the tensor
            values = self.read(quantity, record) if known else von_mises(self.read(dataset, record))
            return self.to_nodes(values) / unit
        values = deformation if dataset is None else self.read(dataset, record)
        values = values if values.ndim == 1 else np.linalg.norm(values, axis=1)
        if quantity == "slip_velocity":  # between surfaces that do not touch there is none
            values = np.where(self.read("pressure", record) > 0, values, 0.0)
        return values / unit

    def to_nodes(self, of_cells):
        """At every node the mean of the cells around it."""
        corners = self.cells.ravel()
        sums = np.bincount(corners, np.repeat(of_cells, self.cells.shape[1]), len(self.points))
        return sums / np.maximum(np.bincount(corners, minlength=len(self.points)), 1)


def von_mises(stress):
    """Of stresses xx yy zz xy yz xz."""
    xx, yy, zz, xy, yz, xz = stress.T
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (xy**2 + yz**2 + xz**2))


def moved_on(along):
    """How far (m) a zone that follows the contact has moved along x: much farther than a bar deforms."""
    if not len(along) or abs(np.median(along)) < 10.0 * np.ptp(along):
        return 0.0
    return np.median(along)


def fit(before, after):
    """The rigid motion in the plane of rolling that brings ``before`` nearest to ``after``, as a function of points."""
    centre, moved = before.mean(axis=0), after.mean(axis=0)
    p, q = before - centre, after - moved
    turn = math.atan2(np.sum(p[:, 0] * q[:, 2] - p[:, 2] * q[:, 0]), np.sum(p[:, 0] * q[:, 0] + p[:, 2] * q[:, 2]))
    sine, cosine = math.sin(turn), math.cos(turn)
    matrix = np.array([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]])
    return lambda points: moved + (points - centre) @ matrix.T


@dataclass
class Tractions:
    """A record of the contact surfaces: pressure (MPa), one arrow per node (SI), and which nodes stick."""

    frame: Frame
    pressure: np.ndarray
    arrows: np.ndarray
    sticks: np.ndarray

    def loaded(self, peak):
        """Nodes in contact, without the ragged edge where pressure is below a hundredth of ``peak``."""
        return self.pressure > EDGE * peak


def tractions(contact, record, arrows="shear"):
    """The tractions of a record of contact surfaces; arrows are zero where the run did not write them."""
    frame = contact.frame(record, "pressure")
    touching = frame.values > 0
    vectors = contact.read(arrows, record) if contact.has(arrows) else np.zeros_like(contact.points)
    if arrows == "shear" and np.abs(vectors).max() < ROUND_OFF * 1e6 * frame.values.max():
        vectors = np.zeros_like(vectors)
    sticks = contact.read("state", record) == 1 if contact.has("state") else np.zeros(len(touching), bool)
    return Tractions(frame, frame.values, np.where(touching[:, None], vectors, 0.0), sticks)


def outside(cells):
    """The outer faces of bricks, as nodes."""
    local = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
    faces = cells[:, local].reshape(-1, 4).astype(np.int64)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]
