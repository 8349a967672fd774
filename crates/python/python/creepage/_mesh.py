"""Meshes: of a case, and of other programs."""

from __future__ import annotations

import contextlib
import io
import os
import tempfile
from pathlib import Path

import numpy as np

from . import _case, _creepage
from ._errors import CaseError
from ._execute import execute
from ._optional import optional

# what the solver asks for, in [mesh.sets]
NEEDED = ("disk", "bar", "hub", "tread", "top", "clamp")
# kinds of cells that a mesh may have beside its bricks: they carry sets or nothing
BESIDE = ("quad", "line", "vertex")
# arrays of meshio over cells, of the numbers of their sets
NUMBERS = ("avsucd:material", "medit:ref", "nastran:ref", "netgen:index", "su2:tag", "ugrid:ref")
# stands near the beginning of every .vtu file that Creepage writes
MARK = b"<!-- Creepage"


class Mesh:
    """``creepage.mesh(case)``, and ``creepage.mesh.from_meshio``."""

    def __call__(self, case, out=None, **overrides) -> dict:
        """Build the mesh of a case.

        Args:
            case: path of a case file, or a dict of its keys.
            out: write the mesh here, .vtu, .vtkhdf or .msh.
            overrides: keys of the case, as of :func:`creepage.run`.

        Returns:
            dict: elements, nodes, bodies (with their sets), quality, stable_dt (s), estimate of
            memory (MB), steps and run time (s).
        """
        options = {"out": out, "case": _case.source(case, overrides)}
        return execute(_creepage.mesh, options)[0]

    @staticmethod
    def from_meshio(mesh, sets=None, *, out, unit="m") -> dict:
        """A mesh of any format that meshio reads, for ``mesh.file`` of a case.

        Args:
            mesh: a ``meshio.Mesh``, or the path of a file.
            sets: what "disk", "bar", "hub", "tread", "top" and "clamp" are: the name of a set of the
                mesh, or indices (or a mask) of nodes, of bricks for "disk" and "bar". What is left out
                is the set of that name.
            out: the .vtu file to write, a new one or one that Creepage wrote. Its sets are arrays of zeros
                and ones.
            unit: length of the coordinates: "m", "cm", "mm" or "in".

        Returns:
            dict: the keys of [mesh]: ``creepage.run(case, mesh=creepage.mesh.from_meshio(...))``.
        """
        meshio = optional("meshio", "mesh")
        out = Path(out)
        if out.suffix != ".vtu":
            raise CaseError(f"out = {out}: the file's name must end in .vtu")
        if not isinstance(mesh, meshio.Mesh):
            if out.exists() and os.path.exists(mesh) and out.samefile(mesh):
                raise CaseError(f"out = {out}: it is what is read, and is not replaced")
            mesh = read(meshio, mesh)
        refuse_foreign(out)
        refuse_other_cells(mesh)
        nodes, cells = named(mesh)
        for name, given in (sets or {}).items():
            if name not in NEEDED:
                raise CaseError(f"sets has {name!r}; it may have {', '.join(NEEDED)}")
            take(name, given, mesh, nodes, cells)
        missing = [name for name in NEEDED if name not in nodes and name not in cells]
        if missing:
            there = ", ".join(sorted({*nodes, *cells})) or "none"
            raise CaseError(f"the mesh has no set {', '.join(missing)}; it has: {there}. Name them by sets")
        kept = [k for k, block in enumerate(mesh.cells) if block.type in ("hexahedron", "quad")]
        made = with_arrays(meshio, mesh, kept, nodes, cells)
        with tempfile.TemporaryDirectory() as folder:
            copy = Path(folder, "mesh.vtu")
            made.write(copy)
            head, line, body = copy.read_bytes().partition(b"\n")
            out.write_bytes(head + line + MARK + b" -->\n" + body)
        return {"file": os.path.abspath(out), "unit": unit}


def refuse_foreign(out):
    """A file that Creepage did not write is not replaced."""
    if not out.exists():
        return
    if out.is_file():
        with out.open("rb") as file:
            if MARK in file.read(1 << 16):
                return
    raise CaseError(f"out = {out}: it exists, and Creepage did not write it; choose another name, or move it away")


def read(meshio, path):
    """A file by meshio, whose many ways to fail are one here."""
    printed = io.StringIO()
    ending = Path(path).suffix.lower()
    try:
        with contextlib.redirect_stdout(printed):
            if ending == ".inp":
                with tempfile.TemporaryDirectory() as folder:
                    copy = Path(folder, "mesh.inp")
                    copy.write_text(with_whole_sets(lines_of(Path(path))), "utf-8")
                    return meshio.read(copy)
            mesh = meshio.read(path)
            if ending in (".e", ".ex2", ".exo"):
                mesh.cell_sets |= blocks(path, mesh)
            return mesh
    except ImportError as missing:
        if missing.name:
            optional(missing.name, "mesh")
        raise
    except (Exception, SystemExit) as problem:  # meshio prints why it cannot read a file, and ends the interpreter
        why = printed.getvalue() if isinstance(problem, SystemExit) else str(problem)
        why = " ".join(why.split()) or type(problem).__name__
        raise CaseError(f"{path}: meshio cannot read it: {why}") from problem


def blocks(path, mesh):
    """The element blocks of an Exodus file by their names, or else numbers, neither of which meshio keeps."""
    netcdf = optional("netCDF4", "mesh")
    with netcdf.Dataset(path) as file:
        file.set_auto_mask(False)
        variables = file.variables
        names = [str(number) for number in variables["eb_prop1"][:]]
        if "eb_names" in variables:
            given = netcdf.chartostring(variables["eb_names"][:])
            names = [str(name).strip() or number for name, number in zip(given, names)]
    return {
        name: [range(len(block.data)) if block is own else [] for block in mesh.cells]
        for name, own in zip(names, mesh.cells)
    }


def lines_of(path):
    """The lines of an Abaqus file, with those of the files that it includes in their places."""
    for line in path.read_text("utf-8", errors="replace").splitlines():
        keyword, given = parameters(line)
        if keyword == "INCLUDE" and "INPUT" in given:
            yield from lines_of(path.parent / given["INPUT"])
        else:
            yield line


def parameters(line):
    """The keyword of a line in capitals, and its parameters by their names in capitals; None for a line of data."""
    if not line.startswith("*") or line.startswith("**"):
        return None, {}
    keyword, *given = line[1:].split(",")
    pairs = (word.partition("=") for word in given)
    return keyword.strip().upper(), {name.strip().upper(): value.strip() for name, _, value in pairs}


def with_whole_sets(lines):
    """An Abaqus file whose sets stand at its end, each in one piece and by its numbers. meshio keeps only the last
    piece of a set, reads one line of ``GENERATE``, no set of nodes by the names of others or at ``*NODE``, only
    elements that stand before a set, and of ``*ELEMENT`` with one ``ELSET`` several times the last."""
    rest, sets = [], {}
    of, here, generate, goes_on = None, None, False, False
    for line in lines:
        keyword, given = parameters(line)
        if keyword is not None:
            of = {"NODE": "NSET", "ELEMENT": "ELSET"}.get(keyword, keyword)
            name = given.get(of) if of in ("NSET", "ELSET") else None
            here = sets.setdefault((of, name.upper()), (name, [])) if name else None
            in_place = keyword != of
            generate, goes_on = "GENERATE" in given, False
            if here is None or in_place:
                words = line.split(",") if here else []
                named = (word for word in words if word.partition("=")[0].strip().upper() != of)
                rest.append(",".join(named) or line)
            continue
        if here is None or in_place or line.startswith("**"):
            rest.append(line)
        fields = [field.strip() for field in line.split(",") if field.strip()]
        if here is None or not fields or line.startswith("**"):
            continue
        if in_place:  # the number comes first; an element that ends in a comma goes on in the next line
            here[1].extend([] if goes_on else fields[:1])
            goes_on = of == "ELSET" and line.rstrip().endswith(",")
        elif generate:
            first, last, step = (*map(int, fields), 1)[:3]
            here[1].extend(map(str, range(first, last + 1, step)))
        else:
            for field in fields:
                here[1].extend([field] if field.isnumeric() else sets[of, field.upper()][1])
    for (kind, _), (name, numbers) in sets.items():
        rest.append(f"*{kind}, {kind}={name}")
        rest.extend(",".join(numbers[k : k + 16]) for k in range(0, len(numbers), 16))
    return "\n".join(rest) + "\n"


def refuse_other_cells(mesh):
    """Cells that are no bricks with eight nodes are refused by their kind and number."""
    for block in mesh.cells:
        if block.type != "hexahedron" and block.type not in BESIDE:
            raise CaseError(
                f"the mesh has {len(block.data)} cells of the type {block.type}: bricks with eight nodes "
                "(hexahedron) are needed"
            )
    if not any(block.type == "hexahedron" for block in mesh.cells):
        raise CaseError("the mesh has no bricks (hexahedron)")


def named(mesh):
    """The sets of a mesh: masks of nodes by name, and of the cells of each block."""
    nodes, cells = {}, {}
    for name, chosen in mesh.point_sets.items():
        nodes[name] = masked(chosen, len(mesh.points))
    for name, chosen in mesh.cell_sets.items():
        if name.startswith("gmsh:"):  # entities, not cells
            continue
        parts = zip(chosen, mesh.cells)
        cells[name] = [masked([] if part is None else part, len(block.data)) for part, block in parts]
    groups = mesh.cell_data.get("gmsh:physical")
    for name, (tag, dimension) in mesh.field_data.items() if groups is not None else ():
        cells[name] = [
            (np.asarray(group) == tag) & (block.dim == dimension)
            for group, block in zip(groups, mesh.cells)
        ]
    for name in groups_of(mesh, "point_tags"):
        families = mesh.point_data["point_tags"]
        nodes[name] = members(mesh.point_tags, name, families)
    for name in groups_of(mesh, "cell_tags"):
        cells[name] = [members(mesh.cell_tags, name, families) for families in mesh.cell_data["cell_tags"]]
    for parts in (mesh.cell_data[key] for key in NUMBERS if key in mesh.cell_data):
        for number in np.unique(np.concatenate(parts)):
            cells.setdefault(f"{number:.0f}", [np.asarray(part) == number for part in parts])
    # this package's own way, in any format that keeps data
    for name, values in mesh.point_data.items():
        if is_set([values]):
            nodes.setdefault(name, np.asarray(values) == 1)
    for name, parts in mesh.cell_data.items():
        if is_set(parts):
            cells.setdefault(name, [np.asarray(part) == 1 for part in parts])
    return nodes, cells


def groups_of(mesh, key):
    """The names of the groups of nodes or cells of a MED file."""
    return sorted({name for groups in getattr(mesh, key, {}).values() for name in groups})


def members(groups_of_family, name, families):
    """Which nodes or cells belong to a group, by their families."""
    return np.isin(families, [family for family, groups in groups_of_family.items() if name in groups])


def is_set(parts):
    """Whether an array, in parts, is of zeros and ones, some of which are ones."""
    parts = [np.asarray(part) for part in parts]
    return all(part.ndim == 1 and np.isin(part, (0, 1)).all() for part in parts) and any(map(np.any, parts))


def with_arrays(meshio, mesh, kept, nodes, cells):
    """The blocks ``kept`` of a mesh, with its sets as arrays of zeros and ones, all in the order of bytes of this
    machine."""
    points = np.zeros((len(mesh.points), 3))
    points[:, : mesh.points.shape[1]] = mesh.points
    return meshio.Mesh(
        points,
        [(mesh.cells[k].type, np.asarray(mesh.cells[k].data, np.int64)) for k in kept],
        point_data={name: mask.astype(np.uint8) for name, mask in nodes.items()},
        cell_data={name: [masks[k].astype(np.uint8) for k in kept] for name, masks in cells.items()},
    )


def take(name, given, mesh, nodes, cells):
    """Makes the set ``name`` what ``given`` says."""
    if isinstance(given, str):
        if given not in nodes and given not in cells:
            there = ", ".join(sorted({*nodes, *cells})) or "none"
            raise CaseError(f"sets: {name} = {given!r}, but the mesh has no such set; it has: {there}")
        found = nodes.get(given), cells.get(given)
        nodes.pop(name, None), cells.pop(name, None)
        for mine, theirs in zip((nodes, cells), found):
            if theirs is not None:
                mine[name] = theirs
    elif name in ("disk", "bar"):
        sizes = [len(block.data) if block.type == "hexahedron" else 0 for block in mesh.cells]
        mask = masked(given, sum(sizes), f"sets: {name}")
        parts = np.split(mask, np.cumsum(sizes)[:-1])
        blocks = zip(parts, mesh.cells)
        nodes.pop(name, None)
        cells[name] = [
            part if block.type == "hexahedron" else np.zeros(len(block.data), bool)
            for part, block in blocks
        ]
    else:
        cells.pop(name, None)
        nodes[name] = masked(given, len(mesh.points), f"sets: {name}")


def masked(chosen, count, what="a set"):
    """Indices or a mask as a mask."""
    chosen = np.asarray(chosen)
    if chosen.dtype == bool:
        if chosen.shape != (count,):
            raise CaseError(f"{what} is a mask of the shape {chosen.shape}; ({count},) is needed")
        return chosen
    mask = np.zeros(count, bool)
    if chosen.size and chosen.dtype.kind not in "iu":
        raise CaseError(f"{what} holds {chosen.dtype} numbers; indices or a mask are needed")
    chosen = chosen.astype(np.int64)
    outside = chosen[(chosen < 0) | (chosen >= count)]
    if outside.size:
        raise CaseError(f"{what} has the index {outside[0]}; there are {count}, counted from 0")
    mask[chosen] = True
    return mask


mesh = Mesh()
