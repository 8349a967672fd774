"""Results of OpenRadioss, CalculiX and code_aster, and tables of any other program, as runs."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path

import numpy as np

from . import _mesh
from ._errors import CreepageError, refuse
from ._foreign import Records, between, case_of, fresh, normals, places, skin, written
from ._lsdyna import of_deck
from ._optional import optional
from ._run import _NAMES


ANEW = "copy it again from where it is whole, or run it again"


@contextmanager
def whole(path):
    """Refuses a file in which a reader finds something else than it must hold."""
    try:
        yield
    except CreepageError:
        raise
    except (OSError, KeyError, IndexError, ValueError, StopIteration) as problem:
        refuse(f"{path} cannot be read, is damaged or cut short: {problem or type(problem).__name__}", ANEW)


def openradioss(folder, deck, out, options, scales) -> dict:
    """The run of a keyword file in OpenRadioss, from its animation files as ``anim_to_vtk`` writes them."""
    folder, out = Path(folder), fresh(out)
    files = sorted(folder.glob("*.vtk"))
    if not files:
        refuse(f"{folder} holds no .vtk", "convert each animation file: anim_to_vtk_linux64_gf deckA001 > deckA001.vtk")

    def read(contact):
        ids, of = np.unique(contact["nodes"], return_index=True)
        start = np.array(contact["points"])[of] / contact["units"][0]
        records = None
        for path in files:
            found = vtk(path)
            missing = [name for name in OF_VTK if name not in found]
            if missing:
                refuse(f"{path} holds no {missing[0]}", "ask the engine for /ANIM/VECT/VEL and /ANIM/VECT/CONT")
            known, rows = places(found["NODE_ID"][:, 0].astype(int), ids)
            if records is None:
                records = Records("the animation files", ids[known], "write the nodes of both surfaces to them")
            if not np.array_equal(ids[known], records.ids):
                refuse(f"{path} has other nodes than {files[0].name}")
            points, velocity, force = (found[name][rows] for name in ("POINTS", "Velocity", "Contact_Forces"))
            vectors = {"displacement": points - start[known], "velocity": velocity, "force": force}
            records.add(found["TIME"].item(), vectors)
        return [records], records

    return of_deck(deck, out, options, scales, read)


OF_VTK = ("TIME", "NODE_ID", "POINTS", "Velocity", "Contact_Forces")


def vtk(path) -> dict:
    """Time, points and the fields over nodes of a legacy file of text."""
    found, count = {}, 0
    with open(path, encoding="utf-8") as file, whole(path):
        for line in file:
            kind, name = (*line.split(), "", "")[:2]
            if kind == "POINTS":
                name, count = kind, int(name)
            elif kind == "TIME":
                name = kind
            elif kind == "SCALARS" and name == "NODE_ID":
                next(file)  # the name of its table of colours
            elif kind != "VECTORS":
                continue
            rows = 1 if kind == "TIME" else count
            found[name] = np.loadtxt(file, ndmin=2, max_rows=rows)
            if len(found[name]) < rows:
                refuse(f"{path} is cut short at {name}", ANEW)
    return found


def calculix(file, inp, out, options, friction, scales) -> dict:
    """A run of CalculiX, from the displacements, velocities and contact stresses of its ``.frd``."""
    out = fresh(out)
    with whole(file):
        ids, points, bricks, states = frd(file)
    sets = node_sets(inp)
    chosen = [np.isin(ids, sets[one_of(sets, options[side], inp)]) for side in ("wheel", "rail")]
    contact = between(ids, points, [skin(points, bricks, side) for side in chosen], options["unit"])
    length = contact["units"][0]
    faces = np.concatenate(contact["faces"])
    records, rows = Records(Path(file).name, contact["nodes"]), places(ids, contact["nodes"])[1]
    for time, blocks in states.items():
        for name, card in OF_FRD.items():
            if name not in blocks:
                refuse(f"{file} holds no {name} at {time:g}", f"write {card}, and run it again")
        moved, velocity, stress = (blocks[name][rows] for name in OF_FRD)
        normal = normals(contact["points"] + length * moved, faces)
        area = contact["areas"][:, None] / length**2
        records.add(time, {"displacement": moved, "velocity": velocity, "force": area * traction(normal, stress)})
    return of_mesh(out, contact, [records], friction, scales)


# what is read of a .frd, and the cards that write it
OF_FRD = {
    "DISP": "*NODE FILE with U and V",
    "VELO": "*NODE FILE with U and V, in a step of *DYNAMIC",
    "CONTACT": "*CONTACT FILE with CDIS and CSTR",
}


def traction(normal, stress):
    """The traction on the dependent surface from CPRESS, CSHEAR1 and CSHEAR2. The first tangent is the projection of the
    x-axis, or of the z-axis where x is nearly normal, and the second is the independent surface's normal times it (its
    manual, ``*CONTACT FILE``); shear is along the slip of the dependent surface, and so opposite to what acts on it."""
    along = np.where(np.abs(normal[:, :1]) > 1 - 1e-10, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    first = along - np.sum(along * normal, axis=1)[:, None] * normal
    first /= np.linalg.norm(first, axis=1)[:, None]
    # the other surface's normal is opposite
    second = np.cross(-normal, first)
    _, _, _, pressure, shear, across = (column[:, None] for column in stress.T)
    return -(pressure * normal + shear * first + across * second)


def frd(path):
    """Numbers and places of nodes, bricks as places of their nodes, and for each time blocks by their names."""
    states, bricks, time = {}, [], None
    with open(path, encoding="utf-8", errors="replace") as lines:
        for line in lines:
            kind = line[:6].strip()
            if kind in ("2C", "3C", "100C") and line.split()[-1] != "1":
                refuse(f"{path} is no .frd of text in the long format", "write *NODE FILE and *CONTACT FILE, not OUTPUT")
            if kind == "2C":
                ids, points = rows_of(path, lines)
            elif kind == "3C":
                bricks = bricks_of(lines)
            elif kind == "100C":
                time = float(line[12:24])
            elif kind.startswith("-4") and line[5:13].strip() in OF_FRD:
                found, values = rows_of(path, lines)
                everywhere = np.zeros((len(ids), values.shape[1]))
                known, rows = places(found, ids)
                everywhere[known] = values[rows]
                states.setdefault(time, {})[line[5:13].strip()] = everywhere
    if not states:
        refuse(f"{path} holds no results", f"write {OF_FRD['VELO']}, and {OF_FRD['CONTACT']}")
    known, corners = places(ids, bricks.ravel())
    if not known.all():
        raise IndexError(f"no node {bricks.ravel()[~known][0]}")
    return ids, points, corners.reshape(-1, 8), states


def rows_of(path, lines):
    """The numbers and the values of a block of a ``.frd``: columns of 12 after 13."""
    numbers, values = [], []
    for line in lines:
        if line.startswith(" -3"):
            return np.array(numbers), np.array(values)
        if line.startswith(" -1"):
            numbers.append(int(line[3:13]))
            values.append([float(line[at : at + 12]) for at in range(13, len(line.rstrip()), 12)])
    refuse(f"{path} is cut short", ANEW)


def bricks_of(lines):
    """The nodes of the elements with eight nodes, of a block of a ``.frd``."""
    found, brick = [], False
    for line in lines:
        if line.startswith(" -3"):
            break
        if line.startswith(" -1"):
            brick = int(line[13:18]) == 1
        elif brick:
            found.append([int(word) for word in line.split()[1:]])
    return np.array(found, int).reshape(-1, 8)


def node_sets(inp) -> dict:
    """The sets of nodes of an input file of Abaqus or CalculiX: numbers by names in capitals."""
    sets, here = {}, None
    with whole(inp):
        for line in _mesh.with_whole_sets(_mesh.lines_of(Path(inp))).splitlines():
            keyword, given = _mesh.parameters(line)
            if keyword is not None:
                here = sets.setdefault(given["NSET"].upper(), []) if keyword == "NSET" else None
            elif here is not None:
                here.extend(map(int, line.split(",")))
    return sets


def one_of(sets, name, path):
    """The name of a set as it stands among ``sets``."""
    for wanted in (name, str(name).upper()):
        if wanted in sets:
            return wanted
    there = ", ".join(sorted(sets)) or "none"
    refuse(f"{path} has no set {name}; it has: {there}", "name the nodes of both surfaces with --wheel and --rail")


def aster(file, out, options, friction, scales) -> dict:
    """A run of code_aster, from the mesh and the fields DEPL, VITE and CONT_NOEU of its MED file."""
    out, h5py = fresh(out), optional("h5py", "mesh")
    with whole(file), h5py.File(file) as med:
        points, bricks, groups = med_mesh(med)
        chosen = [groups[one_of(groups, options[side], file)] for side in ("wheel", "rail")]
        faces = [skin(points, bricks, side) for side in chosen]
        contact = between(np.arange(len(points)), points, faces, options["unit"])
        found = [field(med, name, axes, len(points)) for name, axes in OF_MED.items()]
    records = Records(Path(file).name, contact["nodes"])
    for time in sorted(set.intersection(*map(set, found))):
        vectors = (of[time][contact["nodes"]] for of in found)
        records.add(time, dict(zip(("displacement", "velocity", "force"), vectors)))
    if not records.states:
        refuse(f"{file} has no time of all of {', '.join(OF_MED)}", "write them for the same times")
    return of_mesh(out, contact, [records], friction, scales)


# fields of a result of code_aster, and their components
OF_MED = {"DEPL": ("DX", "DY", "DZ"), "VITE": ("DX", "DY", "DZ"), "CONT_NOEU": ("RX", "RY", "RZ")}


def med_mesh(med):
    """Points, bricks, and masks of the nodes of each group, of nodes or of cells, of the only mesh of a MED file."""
    meshes = med.get("ENS_MAA", {})
    if len(meshes) != 1:
        refuse(f"{med.filename} should hold one mesh; it has: {', '.join(meshes) or 'none'}")
    ((name, mesh),) = meshes.items()
    mesh = mesh if "NOE" in mesh else next(iter(mesh.values()))
    points = mesh["NOE/COO"][()].reshape(3, -1).T
    # the family of each node and cell, and nodes of the latter
    parts = [(mesh["NOE"], np.arange(len(points)))]
    for cells in mesh["MAI"].values():
        parts.append((cells, cells["NOD"][()].reshape(-1, cells["NOD"].attrs["NBR"]) - 1))
    bricks = [nodes.T for (cells, nodes) in parts if cells.name.endswith("/HE8")]
    groups = {}
    for family in (of for kind in ("NOEUD", "ELEME") for of in med["FAS"][name].get(kind, {}).values()):
        for label in family["GRO/NOM"][()] if "GRO" in family else ():
            mask = groups.setdefault(label.tobytes().decode().strip("\0 "), np.zeros(len(points), bool))
            for part, nodes in parts:
                if "FAM" in part:
                    mask[nodes[..., part["FAM"][()] == family.attrs["NUM"]]] = True
    return points, np.concatenate([np.zeros((0, 8), int), *bricks]), groups


def field(med, name, axes, count) -> dict:
    """The vectors of a field over all nodes by times, zero where a node has none."""
    found = [key for key in med.get("CHA", ()) if key.endswith(name)]
    if len(found) != 1:
        there = ", ".join(found or med.get("CHA", ())) or "none"
        refuse(f"{med.filename} should hold one field {name}; it has: {there}",
               f"IMPR_RESU with NOM_CHAM = {tuple(OF_MED)} of one result of DYNA_NON_LINE")  # fmt: skip
    states = med["CHA"][found[0]]
    text = states.attrs["NOM"].decode()
    names = [text[at : at + 16].strip() for at in range(0, len(text), 16)]
    if not set(axes) <= set(names):
        refuse(f"{med.filename} has no {', '.join(axes)} in {found[0]}; it has: {', '.join(names)}")
    vectors = {}
    for state in states.values():
        profile = state["NOE"].attrs["PFL"].decode()
        values = state["NOE"][profile]["CO"][()].reshape(len(names), -1)
        rows = med["PROFILS"][profile]["PFL"][()] - 1 if profile in med.get("PROFILS", ()) else slice(None)
        everywhere = np.zeros((count, 3))
        everywhere[rows] = values[[names.index(axis) for axis in axes]].T
        vectors[float(state.attrs["PDT"])] = everywhere
    return vectors


def tables(folder, out, options, friction, scales) -> dict:
    """A run of any program, from the tables nodes.csv, faces.csv and values.csv."""
    out, folder = fresh(out), Path(folder)
    nodes = table(folder / "nodes.csv", ["node", "x", "y", "z"])
    nodes = nodes[np.argsort(nodes[:, 0])]
    faces = table(folder / "faces.csv", ["n0", "n1", "n2", "n3", "body"]).astype(int)
    vectors = [f"{name}_{axis}" for name in ("force", "velocity", "displacement") for axis in "xyz"]
    values = table(folder / "values.csv", ["time", "node", *vectors])
    known, corners = places(nodes[:, 0], faces[:, :4].ravel())
    if not known.all():
        refuse(f"nodes.csv lacks node {faces[:, :4].ravel()[~known][0]}, which faces.csv has")
    corners = corners.reshape(-1, 4)
    sides = [corners[faces[:, 4] == body] for body in (0, 1)]
    contact = between(nodes[:, 0].astype(int), nodes[:, 1:], sides, options["unit"])
    values = values[np.lexsort((values[:, 1], values[:, 0]))]
    states = np.split(values, np.flatnonzero(np.diff(values[:, 0])) + 1)
    records = Records("values.csv", np.unique(states[0][:, 1]))
    for state in states:
        if len(state) != len(records.ids) or not np.array_equal(state[:, 1], records.ids):
            times = f"{state[0, 0]:g} than at {states[0][0, 0]:g}"
            refuse(f"values.csv has other nodes at {times}", "write all nodes at each time")
        force, velocity, moved = (state[:, at : at + 3] for at in (2, 5, 8))
        records.add(state[0, 0], {"displacement": moved, "velocity": velocity, "force": force})
    return of_mesh(out, contact, [records], friction, scales)


def table(path, columns):
    """Columns of a csv with a head."""
    with open(path, encoding="utf-8") as file, whole(path):
        head = [word.strip() for word in file.readline().split(",")]
        missing = [name for name in columns if name not in head]
        if missing:
            refuse(f"{path} has no column {missing[0]}; it has: {', '.join(head)}")
        return np.loadtxt(file, delimiter=",", ndmin=2, usecols=[head.index(name) for name in columns])


def of_mesh(out, contact, sides, friction, scales) -> dict:
    """Writes the run of a mesh, and a case with friction and scales."""
    document = written(out, contact, sides, sides[0])
    notes = [] if friction else ["case.toml has no [friction]: add it, or give --friction"]
    (out / _NAMES["case"]).write_text(case_of(out, friction, scales), "utf-8")
    return {**document, "notes": notes + document["notes"]}
