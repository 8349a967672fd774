"""Results of LS-DYNA as a run: the contact forces and the motion of nodes from binout, the surfaces from the deck."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from . import _binout, _creepage
from ._case import toml_value
from ._errors import CaseError, refuse
from ._execute import execute
from ._run import _NAMES, Run

DECKS = (".k", ".key", ".dyn")
MESH = "mesh.inp"
# wheel and rail by the labels of their faces
SIDES = ("wheel", "rail")


def from_lsdyna(folder, deck=None, *, out, wheel=None, rail=None, unit="mm-ton-s", scales=None) -> Run:
    """Bring results of LS-DYNA into the layout of a run, for ``check``, ``figures`` and ``report``.

    Args:
        folder: what LS-DYNA wrote: binout with the databases ncforc and nodout.
        deck: the keyword file [default: the only one in the folder].
        out: a new folder, for contact.vtkhdf and case.toml.
        wheel, rail: the numbers of these sides on the card of the contact [default: the wheel is the upper one].
        unit: the deck's units of length, mass and time.
        scales: scales of the check by their names, in SI units, which go into case.toml.

    Returns:
        Run: the run in ``out``.
    """
    imported(folder, deck, out, {"wheel": wheel, "rail": rail, "unit": unit}, scales or {})
    return Run(out)


def imported(folder, deck, out, options, scales) -> dict:
    """Writes the run; returns what ``creepage from-lsdyna --json`` prints."""
    folder, out = Path(folder), Path(out)
    for name in (_NAMES["contact"], _NAMES["case"], MESH):
        if (out / name).exists():
            refuse(f"{out / name} is there already", "choose another folder with --out RUN")
    binout = _binout.opened(folder)
    deck = Path(deck) if deck is not None else only_deck(folder)
    sides, motion = _binout.ncforc(binout), _binout.nodout(binout)
    contact = execute(_creepage.interface_of_k, {"file": deck.absolute(), **options})[0]
    nodes = Nodes(contact, sides, motion)
    times, counts = common(sides, motion, contact["begins"] / contact["units"][2])
    out.mkdir(parents=True, exist_ok=True)
    try:
        lost, turned = write_contact(out / _NAMES["contact"], contact, nodes, sides, motion, times)
    except BaseException:
        (out / _NAMES["contact"]).unlink(missing_ok=True)
        raise
    notes = write_case(out, deck, options, contact, scales)
    notes += [f"the forces of {name} pull: they were taken as those on the other body" for name in turned]
    return {
        "run": str(out),
        "deck": str(deck),
        "nodes": [int(np.sum(nodes.body == body)) for body in range(2)],
        "records": len(times),
        "time": [since(contact, motion, t) for t in (times[0], times[-1])],
        **counts,
        "without_projection": lost,
        "notes": notes,
    }


def only_deck(folder):
    """The keyword file in a folder of results."""
    found = sorted(path for path in folder.glob("*") if path.suffix.lower() in DECKS)
    if len(found) != 1:
        names = ", ".join(path.name for path in found) or "none"
        refuse(f"{folder} should hold one keyword file ({', '.join(DECKS)}); it has: {names}", "give it: --deck FILE.k")
    return found[0]


class Nodes:
    """The nodes of the contact whose motion is recorded, and where they stand in the databases."""

    def __init__(self, contact, sides, motion):
        ids = np.array(contact["nodes"])
        recorded = np.isin(ids, motion.ids)
        faces = [np.array(faces) for faces in contact["faces"]]
        faces = [side[recorded[side].all(axis=1)] for side in faces]
        for name, side, every in zip(SIDES, faces, contact["faces"]):
            missing = ids[np.setdiff1d(np.ravel(every), np.flatnonzero(recorded))]
            if not len(side):
                refuse(f"nodout lacks the nodes of the {name}, such as {missing[0]}", f"add {_binout.CARDS['nodout']}")
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
                refuse(f"ncforc has no node of the {name}", f"add {_binout.CARDS['ncforc']}, and run the deck again")

    def mirrored(self, vectors):
        """Vectors of all nodes, those of the images turned over."""
        vectors[self.image, 1] *= -1
        return vectors


def since(contact, motion, time) -> float:
    """A time of the databases as that of the run (s), which begins with the initial velocities."""
    return max(0.0, motion.states[time][2] * contact["units"][2] - contact["begins"])


def places(there, wanted):
    """Which of the wanted numbers are there, and where those stand."""
    order = np.argsort(there, kind="stable")
    place = np.minimum(np.searchsorted(there, wanted, sorter=order), len(order) - 1)
    known = there[order[place]] == wanted
    return known, order[place][known]


def common(sides, motion, begins):
    """The times of both databases from ``begins`` on, and how many states are left out."""
    everywhere = set(motion.states).intersection(*(side.states for side in sides))
    anywhere = set(motion.states).union(*(side.states for side in sides))
    # to the digits of single precision
    times = sorted(t for t in everywhere if t >= begins * (1 - 1e-6))
    if not everywhere:
        refuse(
            "no state of ncforc and of nodout has the same time", "give both cards the same DT, and run the deck again"
        )
    if not times:
        refuse(f"no state is as late as STIME = {begins:g}, when the wheel begins to roll", "run the deck to its end")
    return times, {"unmatched": len(anywhere - everywhere), "earlier": len(everywhere) - len(times)}


def write_contact(path, contact, nodes, sides, motion, times):
    """Writes the history; returns how often a node with a force had no projection, and which sides were turned over."""
    length, mass, second = contact["units"]
    points, areas = np.array(contact["points"])[nodes.kept], np.array(contact["areas"])[nodes.kept]
    turn_over = senses(nodes, points, sides, motion, times, length)
    writer = _creepage.ContactWriter(path, points, areas, nodes.faces.tolist(), nodes.face_body.tolist())
    lost = 0
    for time in times:
        force = mass * length / second**2 * forces(nodes, sides, turn_over, time)
        velocity, displacement = moving(nodes, motion, time)
        lost += writer.append(
            since(contact, motion, time),
            force.ravel(),
            length / second * velocity.ravel(),
            length * displacement.ravel(),
        )
    return lost, [side.name for side, turned in zip(sides, turn_over) if turned < 0]


def moving(nodes, motion, time):
    """Velocities and displacements of all nodes at a time, in the units of the deck."""
    return [nodes.mirrored(of[nodes.of_motion]) for of in motion.vectors(time, "velocity", "displacement")]


def senses(nodes, points, sides, motion, times, length):
    """For each side 1, or -1 where its forces pull on the whole: then they are those on the other body."""
    found = np.zeros(len(sides))
    for time in reversed(times):
        at = points + length * moving(nodes, motion, time)[1]
        corners = at[nodes.faces]
        across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        normal = np.zeros_like(at)
        np.add.at(normal, nodes.faces.ravel(), np.repeat(across, 4, axis=0))
        for k in np.flatnonzero(found == 0):
            known, rows = nodes.of_sides[k]
            own = ~nodes.image[known]
            (force,) = sides[k].vectors(time, "force")
            found[k] = -np.sign(np.sum(force[rows][own] * normal[known][own]))
        if found.all():
            break
    if not found.any():
        refuse("all forces of ncforc are zero: the surfaces never touch", "name the contact with --wheel and --rail")
    return np.where(found < 0, -1, 1)


def forces(nodes, sides, turn_over, time):
    """The contact forces of all nodes at a time, in the units of the deck."""
    force = np.zeros((len(nodes.ids), 3))
    for side, turned, (known, rows), unrecorded in zip(sides, turn_over, nodes.of_sides, nodes.unrecorded):
        (found,) = side.vectors(time, "force")
        missing = side.ids[unrecorded & found.any(axis=1)]
        if len(missing):
            more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
            refuse(
                f"nodout lacks node {missing[0]}{more}, which bears a contact force", f"add {_binout.CARDS['nodout']}"
            )
        force[known] += turned * found[rows]
    force[nodes.on_plane] *= (2, 0, 2)
    return nodes.mirrored(force)


def write_case(out, deck, options, contact, scales) -> list[str]:
    """Writes the case: that of the keyword file where a disk on a bar says all of it, else what is known."""
    with tempfile.TemporaryDirectory() as scratch:
        try:
            made = {
                "file": deck.absolute(),
                "unit": options["unit"],
                "out": Path(scratch, "case"),
                "include_outside": True,
            }
            case = execute(_creepage.import_k, made)[0]
            text, notes = Path(case["case"]).read_text("utf-8"), ["case.toml is the case of the deck, as of import-k"]
            (out / MESH).write_bytes(Path(case["mesh"]).read_bytes())
        except CaseError as why:
            text = "\n".join([f"name = {toml_value(out.name)}", *friction(contact["friction"])]) + "\n"
            notes = [f"case.toml has the law of friction alone, since the deck is no disk on a bar: {why.message}"]
            if contact["friction"] is None:
                notes.append("FS of the contact stands for friction elsewhere: add [friction] to case.toml")
    if scales:
        text += "\n[scales]\n" + "".join(f"{name} = {float(value)!r}\n" for name, value in scales.items())
    (out / _NAMES["case"]).write_text(text, "utf-8")
    return notes


def friction(law) -> list[str]:
    """Lines of a case for FS, FD and DC: mu = FD + (FS - FD) exp(-DC v)."""
    if law is None:
        return []
    fs, fd, dc = law
    if dc == 0 or fs == fd:
        return ["", "[friction]", 'law = "coulomb"', f"static = {fs!r}"]
    return ["", "[friction]", 'law = "exponential"', f"static = {fs!r}", f"dynamic = {fd!r}", f"decay = {dc!r}"]
