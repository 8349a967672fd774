"""A keyword file of `creepage export-k` in OpenRadioss, and its contact in the layout of `creepage import-contact`.

    python openradioss.py prepare DECK.k FOLDER [INTERVAL]   deck.k, and two engine files in place of the starter's
    python openradioss.py tables DECK.k FOLDER VTK...        nodes.csv, faces.csv, values.csv

INTERVAL (s) is that of the records, by default the deck's of `*DATABASE_BINARY_INTFOR`. VTK... are the animation files that
OpenRadioss's `anim_to_vtk` has converted.

OpenRadioss passes over `*INITIAL_VELOCITY_GENERATION_START_TIME`; the second engine file gives the velocity instead. Its damping
relative to a rigid body slows the disk's rotation down: it is left out, so that the case should be exported with
`--set damping.mass=0`. Units of the deck: mm-ton-s.
"""

import csv
import re
import sys
from pathlib import Path

import numpy as np

TREAD, TOP, RECORDED, SLIDING = 11, 12, 4, 3
# the parts of the disk
DISK = (1, 3)


class Deck:
    """The cards that are needed here."""

    def __init__(self, path):
        text = Path(path).read_text()
        if "$ units: mm-ton-s" not in text:
            sys.exit(f"{path}: export it in mm-ton-s")
        self.cards = re.split(r"(?m)^(?=\*)", text)

    def lines(self, keyword):
        """The data lines of each card of a keyword."""
        for card in self.cards:
            name, *lines = card.splitlines()
            if name == f"*{keyword}":
                yield [line for line in lines if not line.startswith("$")]

    def field(self, keyword, line, i):
        """Field i of a data line of the first card of a keyword."""
        return float(next(self.lines(keyword))[line][10 * i : 10 * i + 10])

    def set(self, keyword, number):
        """The numbers in a set of nodes or segments, a row per line; empty without such a set."""
        for head, *lines in self.lines(keyword):
            if int(head[:10]) == number:
                return [[int(line[i : i + 10]) for i in range(0, len(line), 10)] for line in lines]
        return []

    def nodes(self):
        """Position of each node (mm) by its number."""
        (lines,) = self.lines("NODE")
        return {int(n[:8]): [float(n[8 + 16 * i : 24 + 16 * i]) for i in range(3)] for n in lines}

    def disk(self):
        """First and last number of the disk's nodes."""
        (lines,) = self.lines("ELEMENT_SOLID")
        rows = (tuple(int(e[i : i + 8]) for i in range(0, 80, 8)) for e in lines)
        nodes = {n for _, part, *corners in rows if part in DISK for n in corners}
        if len(nodes) != max(nodes) - min(nodes) + 1:
            sys.exit("the numbers of the disk's nodes have gaps")
        return min(nodes), max(nodes)


def prepare(path, folder, interval=None):
    deck, folder = Deck(path), Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    left_out = (
        "*INITIAL_VELOCITY_GENERATION",
        "*DAMPING_RELATIVE",
        "*DATABASE_HISTORY",
    )
    kept = [card for card in deck.cards if not card.startswith(left_out)]
    (folder / "deck.k").write_text("".join(kept))
    begins = deck.field("INITIAL_VELOCITY_GENERATION_START_TIME", 0, 0)
    end = deck.field("CONTROL_TERMINATION", 0, 0)
    interval = interval or deck.field("DATABASE_BINARY_INTFOR", 0, 0)
    omega, speed = (deck.field("INITIAL_VELOCITY_GENERATION", 0, i) for i in (2, 3))
    height = deck.field("INITIAL_VELOCITY_GENERATION", 1, 2)
    factor = deck.field("CONTROL_TIMESTEP", 0, 1)
    first, last = deck.disk()
    for run, stop in ((1, begins), (2, end)):
        records = 2 * stop if run == 1 else begins
        text = (
            f"/RUN/deck/{run}/\n{stop!r}\n/TFILE/4\n{interval / 4!r}\n"
            f"/ANIM/DT\n{records!r} {interval!r}\n/ANIM/VECT/DISP\n/ANIM/VECT/VEL\n/ANIM/VECT/CONT\n"
            f"/PRINT/-1000\n/DT\n{factor!r} 0\n/PARITH/OFF\n"
        )
        if run == 2:
            # a turn about the y axis of the origin and a translation: free rolling about the disk's centre
            along = speed - omega * height
            text += f"/INIV/AXIS/Y/1\n0\n{along!r} 0 0 {omega!r}\n{first} {last}\n"
        # the starter writes a deck_0001.rad of its own
        (folder / f"engine_000{run}.rad").write_text(text)


def read_vtk(path):
    """Time (s) and fields over nodes of a legacy file of text."""
    lines, found, i = Path(path).read_text().splitlines(), {}, 0

    def block(n, of=float):
        return np.array([line.split() for line in lines[i + 1 : i + 1 + n]], of)

    while i < len(lines):
        words = lines[i].split()
        if words[:1] == ["TIME"]:
            found["time"] = float(lines[i + 1])
        elif words[:1] == ["POINTS"]:
            n = int(words[1])
            found["points"] = block(n)
            i += n
        elif words[:2] == ["SCALARS", "NODE_ID"]:
            i += 1
            found["id"] = block(n, int)[:, 0]
            i += n
        elif words[:1] == ["VECTORS"]:
            found[words[1]] = block(n)
            i += n
        i += 1
    return found


def surface(points, faces):
    """Unit normals and areas (mm2) of the nodes of a surface, by the numbers of its faces' corners."""
    corners = points[faces]
    normal = 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    shares = np.zeros((len(points), 3))
    np.add.at(shares, faces.ravel(), np.repeat(normal / 4, 4, axis=0))
    area = np.linalg.norm(shares, axis=1)
    return shares / np.maximum(area, 1e-30)[:, None], area


def opposite(at, velocity, other, corners, speeds):
    """Slip velocity of nodes against the faces below or above them: bilinear over x and y."""
    lo, hi = corners[:, :, :2].min(axis=1), corners[:, :, :2].max(axis=1)
    slip = np.zeros_like(velocity)
    for k, x in enumerate(at):
        over = np.where(((lo <= x[:2] + 1e-6) & (x[:2] - 1e-6 <= hi)).all(axis=1))[0]
        if len(over) == 0:
            over = [np.argmin(np.linalg.norm(corners[:, :, :2].mean(axis=1) - x[:2], axis=1))]
        face = over[0]
        # Newton's method for the place in the face
        p, (r, s) = corners[face][:, :2], (0.0, 0.0)
        for _ in range(8):
            n = 0.25 * np.array([(1 - r) * (1 - s), (1 + r) * (1 - s), (1 + r) * (1 + s), (1 - r) * (1 + s)])
            d = 0.25 * np.array([[-(1 - s), 1 - s, 1 + s, -(1 + s)], [-(1 - r), -(1 + r), 1 + r, 1 - r]])
            r, s = (r, s) + np.linalg.solve((d @ p).T, x[:2] - n @ p)
        slip[k] = velocity[k] - n @ speeds[face]
    return slip


def tables(path, folder, files):
    deck, folder = Deck(path), Path(folder)
    begins = deck.field("INITIAL_VELOCITY_GENERATION_START_TIME", 0, 0)
    at = deck.nodes()
    recorded = {n for row in deck.set("SET_NODE_LIST", RECORDED) for n in row}
    sliding = {n for row in deck.set("SET_NODE_LIST", SLIDING) for n in row}
    faces = [deck.set("SET_SEGMENT", number) for number in (TREAD, TOP)]
    if not recorded or not all(faces):
        sys.exit("the deck lacks the nodes that are recorded, or the faces of a surface")
    shown = [[face for face in side if recorded.issuperset(face)] for side in faces]
    numbers = sorted(recorded)
    row = {n: i for i, n in enumerate(numbers)}
    everything = np.array([at[n] for n in sorted(at)])
    index = {n: i for i, n in enumerate(sorted(at))}
    held = np.array([index[n] for n in sorted(sliding)], int)
    whole = [np.array([[index[n] for n in face] for face in side]) for side in faces]
    area = sum(surface(everything, side)[1] for side in whole)
    with open(folder / "nodes.csv", "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["x", "y", "z", "area"])
        for n in numbers:
            out.writerow([repr(float(x)) for x in (*(1e-3 * np.array(at[n])), 1e-6 * area[index[n]])])
    with open(folder / "faces.csv", "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["n0", "n1", "n2", "n3", "body"])
        for body, side in enumerate(shown):
            out.writerows([*(row[n] for n in face), body] for face in side)
    columns = ["time", "node", "pressure"]
    for name in ("shear", "slip_velocity", "velocity", "displacement"):
        columns += [f"{name}_{axis}" for axis in "xyz"]
    with open(folder / "values.csv", "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(columns)
        for vtk in files:
            out.writerows(record(read_vtk(vtk), begins, everything, index, whole, shown, row, area, held))


def record(vtk, begins, reference, index, whole, shown, row, area, held):
    """The rows of one time: the nodes in contact, in SI units."""
    of = {n: i for i, n in enumerate(vtk["id"])}
    take = [of[n] for n in sorted(index)]
    points, velocity, force = (vtk[name][take] for name in ("points", "Velocity", "Contact_Forces"))
    velocity = velocity * 1e-3
    # the neighbours' share of a force across the plane of symmetry, which the missing half cancels
    force[held, 1] = 0.0
    for body, side in enumerate(shown):
        normal, _ = surface(points, whole[body])
        nodes = np.array(sorted({n for face in side for n in face}))
        k = np.array([index[n] for n in nodes])
        inside = np.linalg.norm(force[k], axis=1) > 1e-9
        nodes, k = nodes[inside], k[inside]
        other = np.array([[index[n] for n in face] for face in shown[1 - body]])
        slip = opposite(points[k], velocity[k], other, points[other], velocity[other])
        # N/mm2
        traction = 1e6 * force[k] / area[k][:, None]
        pressure = -(traction * normal[k]).sum(axis=1)
        shear = traction + pressure[:, None] * normal[k]
        slip -= (slip * normal[k]).sum(axis=1)[:, None] * normal[k]
        moved = 1e-3 * (points[k] - reference[k])
        for j, n in enumerate(nodes):
            # the other program's damping makes a few nodes pull: they are written as they are
            values = (pressure[j], *shear[j], *slip[j], *velocity[k[j]], *moved[j])
            yield [repr(vtk["time"] - begins), row[n], *(repr(float(x)) for x in values)]


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["prepare", deck, folder]:
            prepare(deck, folder)
        case ["prepare", deck, folder, interval]:
            prepare(deck, folder, float(interval))
        case ["tables", deck, folder, *files] if files:
            tables(deck, folder, sorted(files))
        case _:
            sys.exit(__doc__)
