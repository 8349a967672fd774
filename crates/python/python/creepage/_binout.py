"""The databases ``ncforc`` and ``nodout`` of LS-DYNA's binout files, and d3plot.

The places of values are those that ``l2a`` reads, LSTC's program to write binout as text: ``/nodout/metadata/ids`` and
``/nodout/dNNNNNN/x_velocity``; ``/ncforc/slave_N/metadata/ids`` and ``/ncforc/slave_N/dNNNNNN/x_force``, with a folder
``slave_N`` or ``master_N`` for each side of each contact.
"""

from __future__ import annotations

import re

import numpy as np

from ._errors import refuse
from ._foreign import Records
from ._optional import optional

# binout, binout0000, binout0000%001, JOB.binout0003
NAME = re.compile(r"(^|\.)binout\d*(%\d+)?$")
# numbers by the types of the format
TYPES = {1: "i1", 2: "i2", 3: "i4", 4: "i8", 5: "u1", 6: "u2", 7: "u4", 8: "u8", 9: "f4", 10: "f8"}
CARDS = {
    "ncforc": "*DATABASE_NCFORC with BINARY = 2, and SPR = MPR = 1 on the card of the contact",
    "nodout": "*DATABASE_NODOUT with BINARY = 2, and *DATABASE_HISTORY_NODE_SET of the nodes of both surfaces",
}

# what does not tell how the contact conditions are kept
WITHOUT_FORCES = {
    "d3plot": "has no contact forces, without which nothing of the contact is judged",
    "intfor": "cannot be read by lasso-python, and is no substitute for ncforc",
}


def opened(folder):
    """What the binout files of a folder hold together; the files are closed with the last reference to it."""
    files = sorted(str(path) for path in folder.iterdir() if NAME.search(path.name)) if folder.is_dir() else []
    if not files:
        help = f"give the folder of LS-DYNA's results; its deck needs {CARDS['ncforc']}, and {CARDS['nodout']}"
        there = sorted(path.name for path in folder.glob("*") if path.name in WITHOUT_FORCES)
        why = "".join(f"; {name} {WITHOUT_FORCES[name]}" for name in there)
        refuse(f"{folder} holds no binout{why}", help)
    lsda = optional("lasso.dyna.lsda_py3", "lsdyna", "lasso-python").Lsda
    lsda.fw = None  # its destructor asks for it, also where a file could not be opened
    try:
        return lsda(files)
    except Exception:  # of a damaged file anything may come
        for file in files:
            try:
                lsda([file])
            except Exception as problem:
                refuse(f"{file} is damaged or cut short: {problem or type(problem).__name__}", ANEW)
        raise


ANEW = "copy it again from where it is whole, or run the deck again"


def database(binout, name):
    """The folder of a database."""
    root = binout.root
    found = root.children.get(name)
    if found is None:
        there = ", ".join(sorted(root.children)) or "none"
        refuse(f"binout holds no {name}; it has: {there}", f"add {CARDS[name]}, and run the deck again")
    return found


def values(folder, name, where):
    """An array of a folder."""
    symbol = folder.children.get(name.encode())
    if symbol is None:
        refuse(f"binout holds no {name} of {where}", ANEW)
    kind = TYPES.get(symbol.type)
    try:
        raw = symbol.read_raw() if kind else b""
    except (OSError, OverflowError, MemoryError):
        raw = b""
    if kind is None or len(raw) != symbol.length * np.dtype(kind).itemsize:
        refuse(f"{symbol.file.name} is damaged or cut short at {name} of {where}", ANEW)
    return np.frombuffer(raw, symbol.file.ordercode + kind)


class Table(Records):
    """A database, or one side of one, with a row for each of its nodes."""

    def __init__(self, folder, name):
        metadata = folder.children.get("metadata")
        if metadata is None:
            refuse(f"binout holds no metadata of {name}", ANEW)
        super().__init__(name, values(metadata, "ids", name), f"add {CARDS[name.split('/')[0]]}, and run the deck again")
        for key, state in folder.children.items():
            if key != "metadata":
                self.add(values(state, "time", f"{name}/{key}")[0], (key, state))
        if not self.states or not len(self.ids):
            refuse(f"{name} of binout is empty", self.remedy)

    def vectors(self, time, *quantities):
        """Quantities such as velocity at a time: for each an array of rows x, y, z."""
        key, state = self.states[time][1]
        where = f"{self.name}/{key}"
        found = []
        for quantity in quantities:
            axes = [values(state, f"{axis}_{quantity}", where) for axis in "xyz"]
            wrong = [len(axis) for axis in axes if len(axis) != len(self.ids)]
            if wrong:
                refuse(f"{where} holds {quantity} of {wrong[0]} nodes, its metadata {len(self.ids)}", ANEW)
            found.append(np.stack(axes, axis=1).astype(float))
        return found


def motion(binout, folder):
    """The motion of nodes, of nodout or else of d3plot, and a note which."""
    if "nodout" in binout.root.children or not (folder / "d3plot").exists():
        return Table(database(binout, "nodout"), "nodout"), []
    found = d3plot(folder / "d3plot")
    times = [time for time, _ in found.states.values()]
    interval = f", one state in {max(np.diff(times)):.3g}" if len(times) > 1 else ""
    return found, [f"binout holds no nodout: the motion is that of d3plot{interval} of the deck's unit of time"]


def d3plot(path) -> Records:
    """The motion of all nodes of a d3plot and the files that continue it."""
    plots = optional("lasso.dyna", "lsdyna", "lasso-python")
    wanted = ["node_displacement", "node_velocity", "timesteps"]
    try:
        arrays = plots.D3plot(str(path), state_array_filter=wanted, buffered_reading=True).arrays
    except Exception as problem:  # of a damaged file anything may come
        refuse(f"{path} is damaged, cut short or no d3plot: {problem or type(problem).__name__}", ANEW)
    missing = [name for name in ("node_ids", *wanted) if name not in arrays]
    if missing:
        refuse(f"{path} holds no {missing[0]}", f"add {CARDS['nodout']}, and run the deck again")
    records = Records("d3plot", arrays["node_ids"], ANEW)
    start = arrays["node_coordinates"].astype(float)
    for time, moved, velocity in zip(*(arrays[name] for name in ("timesteps", *wanted[:2]))):
        # what lasso-python calls displacement is the place
        records.add(time, {"displacement": moved - start, "velocity": velocity.astype(float)})
    return records


def ncforc(binout) -> list[Table]:
    """The contact forces of nodes, for each side of each contact."""
    folder = database(binout, "ncforc")
    sides = {name: side for name, side in folder.children.items() if name != "metadata"}
    if not sides:
        refuse("ncforc of binout is empty", f"add {CARDS['ncforc']}, and run the deck again")
    return [Table(side, f"ncforc/{name}") for name, side in sides.items()]
