"""The contact of other programs as a run: the forces and the motion of nodes, and the two surfaces."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from . import _creepage
from ._case import toml_value
from ._errors import refuse
from ._run import _NAMES

MESH = "mesh.inp"
# wheel and rail by the labels of their faces
SIDES = ("wheel", "rail")
ONE_SIDED = (
    "there are no forces of the wheel: its side of the contact is not judged",
    "there are no forces of the rail: its side is not judged; patch and figures, which are the rail's, are empty",
)
# corners of the faces of a brick in their order around it
OF_BRICK = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
UNITS = (
    {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254},
    {"kg": 1.0, "ton": 1e3, "g": 1e-3},
    {"s": 1.0, "ms": 1e-3, "us": 1e-6},
)


class Records:
    """Vectors of numbered nodes, by their times in single precision, which some files have and others do not.

    Attributes:
        name: of the file or database, for refusals.
        ids: the numbers of the nodes.
        remedy: what must be asked of the other program to have these records.
        states: time to the digits of the file, and the vectors by their names.
    """

    def __init__(self, name, ids, remedy=None):
        self.name, self.ids, self.remedy, self.states = name, np.asarray(ids, np.int64), remedy, {}

    def add(self, time, vectors):
        """Adds a state."""
        self.states[float(np.float32(time))] = float(time), vectors

    def vectors(self, time, *quantities):
        """Quantities such as velocity at a time: for each an array of rows x, y, z."""
        return [self.states[time][1][quantity] for quantity in quantities]


class Nodes:
    """The nodes of the contact whose motion is recorded, and where they stand among the records."""

    def __init__(self, contact, sides, motion):
        ids = np.array(contact["nodes"])
        recorded = np.isin(ids, motion.ids)
        faces = [np.array(faces) for faces in contact["faces"]]
        faces = [side[recorded[side].all(axis=1)] for side in faces]
        for name, side, every in zip(SIDES, faces, contact["faces"]):
            missing = ids[np.setdiff1d(np.ravel(every), np.flatnonzero(recorded))]
            if not len(side):
                refuse(f"{motion.name} lacks the nodes of the {name}, such as {missing[0]}", motion.remedy)
        # those of the wheel come first
        kept = np.concatenate([np.unique(side) for side in faces])
        row = np.full(len(ids), -1)
        row[kept] = np.arange(len(kept))
        self.ids, self.kept = ids[kept], kept
        self.faces = np.concatenate([row[side] for side in faces])
        self.face_body = np.repeat([0, 1], [len(side) for side in faces])
        self.body = np.repeat([0, 1], [len(np.unique(side)) for side in faces])
        # the rows of mirror images, and of nodes on the plane between, whose images bear the same force
        self.image = kept >= len(ids) - contact["images"]
        self.on_plane = row[[n for n in contact["on_plane"] if row[n] >= 0]]
        self.of_motion = places(motion.ids, self.ids)[1]
        self.of_sides = [places(side.ids, self.ids) for side in sides]
        self.unrecorded = [np.isin(side.ids, np.setdiff1d(ids, self.ids)) for side in sides]
        for body, name in enumerate(SIDES):
            if not any(np.any(known[self.body == body]) for known, _ in self.of_sides):
                refuse(f"{sides[0].name.split('/')[0]} has no node of the {name}", sides[0].remedy)

    def mirrored(self, vectors):
        """Vectors of all nodes, those of the images turned over."""
        vectors[self.image, 1] *= -1
        return vectors


def places(there, wanted):
    """Which of the wanted numbers are there, and where those stand."""
    order = np.argsort(there, kind="stable")
    place = np.minimum(np.searchsorted(there, wanted, sorter=order), len(order) - 1)
    known = there[order[place]] == wanted
    return known, order[place][known]


def fresh(out) -> Path:
    """The folder of a new run."""
    for name in (_NAMES["contact"], _NAMES["case"], MESH):
        if (Path(out) / name).exists():
            refuse(f"{Path(out) / name} is there already", "choose another folder with --out RUN")
    return Path(out)


def written(out, contact, sides, motion) -> dict:
    """Writes the contact of a run into the folder ``out``.

    Args:
        contact: the surfaces, units and time of begin, as of ``interface_of_k``.
        sides: the contact forces, those of each side or of both together.
        motion: displacements and velocities.

    Returns:
        dict: what the command prints with ``--json``.
    """
    nodes = Nodes(contact, sides, motion)
    times, counts = common(sides, motion, contact["begins"] / contact["units"][2])
    out.mkdir(parents=True, exist_ok=True)
    try:
        lost, notes = write_contact(out / _NAMES["contact"], contact, nodes, sides, motion, times)
    except BaseException:
        (out / _NAMES["contact"]).unlink(missing_ok=True)
        raise
    begin, end = (since(contact, motion, t) for t in (times[0], times[-1]))
    return {
        "run": str(out),
        "nodes": [int(np.sum(nodes.body == body)) for body in range(2)],
        "records": len(times),
        "time": [begin, end],
        **counts,
        "without_projection": lost,
        "notes": notes,
    }


def since(contact, motion, time) -> float:
    """A time of the records as that of the run (s), which begins with the initial velocities."""
    return max(0.0, motion.states[time][0] * contact["units"][2] - contact["begins"])


def common(sides, motion, begins):
    """The times of forces and motion from ``begins`` on, and how many states are left out."""
    everywhere = set(motion.states).intersection(*(side.states for side in sides))
    anywhere = set(motion.states).union(*(side.states for side in sides))
    # to the digits of single precision
    times = sorted(t for t in everywhere if t >= begins * (1 - 1e-6))
    if not everywhere:
        names = f"{sides[0].name.split('/')[0]} and of {motion.name}"
        refuse(f"no state of {names} has the same time", "record both with the same interval, and run it again")
    if not times:
        refuse(f"no state is as late as STIME = {begins:g}, when the wheel begins to roll", "run the deck to its end")
    return times, {"unmatched": len(anywhere - everywhere), "earlier": len(everywhere) - len(times)}


def write_contact(path, contact, nodes, sides, motion, times):
    """Writes the history; returns how often a node with a force had no projection, and notes."""
    length, mass, second = contact["units"]
    points, areas = np.array(contact["points"])[nodes.kept], np.array(contact["areas"])[nodes.kept]
    turn_over = senses(nodes, points, sides, motion, times, length)
    writer = _creepage.ContactWriter(path, points, areas, nodes.faces.tolist(), nodes.face_body.tolist())
    lost, loaded = 0, np.zeros(len(nodes.ids), bool)
    for time in times:
        force = mass * length / second**2 * forces(nodes, sides, motion, turn_over, time)
        loaded |= force.any(axis=1)
        velocity, displacement = moving(nodes, motion, time)
        lost += writer.append(
            since(contact, motion, time),
            force.ravel(),
            length / second * velocity.ravel(),
            length * displacement.ravel(),
        )
    pulling = [side.name for side, turned in zip(sides, turn_over) if turned < 0]
    notes = [f"the forces of {name} pull: they were taken as those on the other body" for name in pulling]
    return lost, notes + [ONE_SIDED[body] for body in range(2) if not loaded[nodes.body == body].any()]


def moving(nodes, motion, time):
    """Velocities and displacements of all nodes at a time, in the units of the records."""
    return [nodes.mirrored(of[nodes.of_motion]) for of in motion.vectors(time, "velocity", "displacement")]


def normals(points, faces):
    """Unit normals of nodes: the mean of the unit normals that the faces around them have at these corners."""
    found = np.zeros_like(points)
    corners = points[faces]
    for k in range(4):
        across = np.cross(corners[:, (k + 1) % 4] - corners[:, k], corners[:, (k + 3) % 4] - corners[:, k])
        np.add.at(found, faces[:, k], across / np.linalg.norm(across, axis=1)[:, None])
    return found / np.maximum(np.linalg.norm(found, axis=1), 1e-300)[:, None]


def senses(nodes, points, sides, motion, times, length):
    """For each side 1, or -1 where its forces pull on the whole: then they are those on the other body."""
    found = np.zeros(len(sides))
    for time in reversed(times):
        normal = normals(points + length * moving(nodes, motion, time)[1], nodes.faces)
        for k in np.flatnonzero(found == 0):
            known, rows = nodes.of_sides[k]
            own = ~nodes.image[known]
            (force,) = sides[k].vectors(time, "force")
            found[k] = -np.sign(np.sum(force[rows][own] * normal[known][own]))
        if found.all():
            break
    if not found.any():
        forces = sides[0].name.split("/")[0]
        refuse(f"all forces of {forces} are zero: the surfaces never touch", "name the contact with --wheel and --rail")
    return np.where(found < 0, -1, 1)


def forces(nodes, sides, motion, turn_over, time):
    """The contact forces of all nodes at a time, in the units of the records."""
    force = np.zeros((len(nodes.ids), 3))
    for side, turned, (known, rows), unrecorded in zip(sides, turn_over, nodes.of_sides, nodes.unrecorded):
        (found,) = side.vectors(time, "force")
        missing = side.ids[unrecorded & found.any(axis=1)]
        if len(missing):
            more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
            refuse(f"{motion.name} lacks node {missing[0]}{more}, which bears a contact force", motion.remedy)
        force[known] += turned * found[rows]
    force[nodes.on_plane] *= (2, 0, 2)
    return nodes.mirrored(force)


def between(ids, points, faces, unit) -> dict:
    """The two surfaces of a mesh, as ``interface_of_k`` gives those of a keyword file.

    Args:
        ids, points: numbers of the nodes, and where they are in the mesh.
        faces: of wheel and rail, rows of four nodes by their places among the points.
        unit: the units of length, mass and time, such as mm-ton-s.
    """
    for name, side in zip(SIDES, faces):
        if not len(side):
            refuse(f"the {name} has no faces", "give nodes of the outer faces of bricks with eight nodes")
    units = units_of(unit)
    kept = np.unique(np.concatenate(faces))
    row = np.zeros(len(points), int)
    row[kept] = np.arange(len(kept))
    faces = [row[side] for side in faces]
    points = units[0] * np.asarray(points)[kept]
    areas = sum(tributary(points, side) for side in faces)
    made = {"nodes": np.asarray(ids)[kept], "points": points, "areas": areas, "faces": faces}
    return {**made, "images": 0, "on_plane": [], "begins": 0.0, "units": units}


def units_of(unit):
    """Length (m), mass (kg) and time (s) of a word such as mm-ton-s."""
    words = unit.split("-")
    if len(words) != 3 or not all(word in known for word, known in zip(words, UNITS)):
        refuse(f"unknown units {unit!r}", "; ".join(", ".join(known) for known in UNITS) + ": for example mm-ton-s")
    return [known[word] for word, known in zip(words, UNITS)]


def tributary(points, faces):
    """Areas of the nodes: the integrals of the bilinear shape functions, by 2x2 Gauss points."""
    corner = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    area = np.zeros(len(points))
    for gauss in corner / 3**0.5:
        along, across = (0.25 * corner[:, k] * (1 + corner[:, 1 - k] * gauss[1 - k]) for k in (0, 1))
        jacobian = np.cross(along @ points[faces], across @ points[faces])
        share = 0.25 * np.prod(1 + corner * gauss, axis=1)
        np.add.at(area, faces, np.linalg.norm(jacobian, axis=1)[:, None] * share)
    return area


def skin(points, bricks, chosen):
    """The outer faces of bricks whose corners are all chosen, by a mask of the nodes: counter-clockwise from outside,
    whatever the order of the bricks' nodes."""
    faces = bricks[:, OF_BRICK].reshape(-1, 4)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    outer = np.sort(first[count == 1])
    outer = outer[chosen[faces[outer]].all(axis=1)]
    faces, middle = faces[outer], points[bricks[outer // 6]].mean(axis=1)
    corners = points[faces]
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    inward = np.sum(across * (corners.mean(axis=1) - middle), axis=1) < 0
    faces[inward] = faces[inward, ::-1]
    return faces


def case_of(out, law, scales) -> str:
    """The text of a case that has friction and scales alone."""
    return "\n".join([f"name = {toml_value(out.name)}", *friction(law)]) + "\n" + scales_of(scales)


def friction(law) -> list[str]:
    """Lines of a case for FS, FD and DC: mu = FD + (FS - FD) exp(-DC v)."""
    if law is None:
        return []
    fs, fd, dc = law
    if dc == 0 or fs == fd:
        return ["", "[friction]", 'law = "coulomb"', f"static = {fs!r}"]
    return ["", "[friction]", 'law = "exponential"', f"static = {fs!r}", f"dynamic = {fd!r}", f"decay = {dc!r}"]


def scales_of(scales) -> str:
    """Lines of a case for the scales of the check."""
    if not scales:
        return ""
    return "\n[scales]\n" + "".join(f"{name} = {float(value)!r}\n" for name, value in scales.items())
