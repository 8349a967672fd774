"""The results of a sweep."""

from __future__ import annotations

import itertools
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from . import _creepage, _html
from ._errors import CaseError
from ._optional import optional
from ._run import Run


class Sweep(Sequence):
    """The results of a sweep: a sequence of its runs, each a :class:`Run` (None where it has not begun).

    ``sweep[i]`` is the run i, ``sweep["name"]`` the run of that name.

    Attributes:
        path: its folder.
        columns: names of the columns of its table, which are those of ``sweep.csv``.
        units: units of the columns by name: "1" for ratios and counts, "" for texts.
        meanings: what the columns are, by name, where the name does not say it.
        document: what ``creepage sweep --json`` prints.
    """

    def __init__(self, path):
        self.path = Path(path)
        if not self.path.exists():
            raise CaseError(f"{self.path}: there is no such folder")
        if not (self.path / "sweep.json").is_file():
            raise CaseError(f"{self.path} holds no sweep: there is no sweep.json in it")
        self._load()

    def _load(self):
        columns, table, document = _creepage.sweep_table(self.path)
        table = json.loads(table)
        self.document = json.loads(document)
        self.columns = [name for name, _, _ in columns]
        self.units = {name: units for name, units, _ in columns}
        self.meanings = {name: meaning for name, _, meaning in columns if meaning}
        self._runs, self._points = table["runs"], table["points"]

    def reload(self):
        """Read again, to see what a sweep under way has done since."""
        self._load()
        return self

    @property
    def parameters(self) -> list:
        """Keys of the case over which the sweep goes."""
        return list(self.document["parameters"])

    @property
    def names(self) -> list:
        """Names of the runs."""
        return [run["name"] for run in self.document["runs"]]

    def __len__(self):
        return len(self._runs)

    def __getitem__(self, which):
        if isinstance(which, slice):
            return [self[i] for i in range(*which.indices(len(self)))]
        if isinstance(which, str):
            if which not in self.names:
                raise KeyError(f"{which!r}; there are {', '.join(self.names)}")
            which = self.names.index(which)
        folder = self.path / self.document["runs"][which]["run"]
        return Run(folder) if (folder / "case.toml").is_file() else None

    def to_pandas(self, means=False):
        """The table as a ``pandas.DataFrame``, one row for each run, its name the index.

        Units are in ``attrs["units"]``. The column ``run`` holds the :class:`Run` of each row.

        Args:
            means: the means over the members of an ensemble in place of its runs, one row for each point.
        """
        pandas = optional("pandas")
        rows = self._points if means else self._runs
        data = {name: pandas.Series([row[i] for row in rows], dtype=object) for i, name in enumerate(self.columns)}
        for name in self.columns:
            if self._is_number(name, rows):
                data[name] = pandas.to_numeric(data[name])
        if not means:
            data["run"] = pandas.Series(list(self), dtype=object)
        frame = pandas.DataFrame(data).set_index("name")
        frame.attrs["units"] = {name: self.units[name] for name in self.columns if self.units[name]}
        return frame

    def to_xarray(self):
        """The numbers of the table as an ``xarray.Dataset`` over the parameters.

        Each variable has the attribute ``units``. ``run`` holds the names of the runs: ``sweep[str(data.run[0].item())]``
        opens one. Runs that are no full grid of the parameters' values lie along one dimension, ``run``.
        """
        xarray = optional("xarray")
        names = self.parameters
        chosen = [tuple(_label(row[self.columns.index(name)]) for name in names) for row in self._runs]
        values = [list(dict.fromkeys(at[k] for at in chosen)) for k in range(len(names))]
        shape = [len(one) for one in values]
        grid = bool(names) and sorted(map(str, chosen)) == sorted(map(str, itertools.product(*values)))
        if grid:
            dims = tuple(names)
            order = [tuple(values[k].index(at[k]) for k in range(len(names))) for at in chosen]
            coordinates = {name: (name, values[k], self._attributes(name)) for k, name in enumerate(names)}
        else:
            dims, shape, order = ("run",), [len(chosen)], [(i,) for i in range(len(chosen))]
            coordinates = {
                name: ("run", [at[k] for at in chosen], self._attributes(name)) for k, name in enumerate(names)
            }

        def laid_out(column, empty, kind):
            array = np.full(shape, empty, dtype=kind)
            for place, row in zip(order, self._runs, strict=True):
                value = row[self.columns.index(column)]
                array[place] = empty if value is None else value
            return array

        coordinates["run"] = (dims, laid_out("name", "", object).astype(str))
        variables = {
            name: (dims, laid_out(name, np.nan, float), self._attributes(name))
            for name in self.columns
            if name not in names and self._is_number(name, self._runs)
        }
        attributes = {"name": self.document["name"], "creepage_version": self.document["creepage_version"]}
        return xarray.Dataset(variables, coordinates, attributes)

    def _is_number(self, name, rows):
        """Whether a column holds numbers; one without any value does where it has a unit."""
        place = self.columns.index(name)
        found = [row[place] for row in rows if row[place] is not None]
        numbers = all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in found)
        return numbers and (bool(found) or bool(self.units[name]))

    def _attributes(self, name):
        attributes = {"units": self.units[name]} if self.units[name] else {}
        return attributes | ({"long_name": self.meanings[name]} if name in self.meanings else {})

    def _repr_html_(self):
        shown = ["name", *self.parameters, "status", "normal_force", "traction_coefficient", "peak_pressure", "reason"]
        places = [self.columns.index(name) for name in shown]
        heads = [f"{name} {_html.unit(self.units[name])}".strip() for name in shown]
        rows = [[row[place] for place in places] for row in self._runs]
        return _html.page(f"sweep {self.path}: {len(self)} runs", heads, rows)

    def __repr__(self):
        done = sum(run["status"] == "completed" for run in self.document["runs"])
        return f"<sweep {self.path}: {done} of {len(self)} runs completed over {', '.join(self.parameters)}>"


def _label(value):
    """A value of a parameter as a coordinate: tables, such as a stiffness, as text."""
    return json.dumps(value) if isinstance(value, (dict, list)) else value
