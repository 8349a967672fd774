"""The results of a run, read when they are asked for."""

from __future__ import annotations

import json
import math
import numbers
import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from . import _creepage, _html
from ._errors import CaseError, LimitError
from ._execute import execute
from ._optional import optional
from ._resolved import Case

_NAMES, _LAYOUT = _creepage.layout()


def layout() -> dict:
    """What each file of a run holds: for each dataset its name, units, shape and meaning, by the name of the file."""
    return {file: [tuple(row) for row in rows] for file, rows in _LAYOUT.items()}


class Field:
    """A field over the records of a file, read when it is indexed.

    ``field[i]`` is record i (negative from the end), ``field[i:j]`` an array of records, and
    ``field[i, nodes]`` a part of them; bounds that are floats are times in seconds, both included:
    ``field[1.2e-3:1.3e-3]``. Only the records asked for are read.

    Attributes:
        name, units: as in the file.
        shape: (records, nodes or cells[, components]); without records for a field that is
            constant in time.
    """

    def __init__(self, records, name, units, components, integer, on_cells, constant, part):
        self._records = records
        self._part = part
        self.name, self.units = name, units
        self.on_cells, self.constant = on_cells, constant
        self.dtype = np.dtype(np.uint8 if integer else np.float64)
        self._components = components
        count = part.stop - part.start
        self.shape = (count,) if components == 1 else (count, components)
        if not constant:
            self.shape = (records.steps, *self.shape)

    def __len__(self):
        return self.shape[0]

    @property
    def ndim(self):
        return len(self.shape)

    def _read(self, start, stop):
        """Records ``start`` up to ``stop``, always with the axis of records."""
        file = self._records._file
        count = file.cells() if self.on_cells else len(self._records.points)
        flat = file.read(self.name, self.on_cells, start, stop)
        values = flat.reshape((-1, count, self._components))[:, self._part]
        if self._components == 1:
            values = values[..., 0]
        return np.ascontiguousarray(values, self.dtype)

    def __getitem__(self, index):
        first, *rest = index if isinstance(index, tuple) else (index,)
        if self.constant:
            return self._read(0, 1)[0][index]
        if first is Ellipsis:
            return self._read(0, len(self))[index]
        if isinstance(first, slice):
            if any(isinstance(x, (float, np.floating)) for x in (first.start, first.stop)):
                first = self._records.between(first.start, first.stop, first.step)
            start, stop, step = first.indices(len(self))
            chosen = range(start, stop, step)
            if not chosen:
                return np.empty((0, *self.shape[1:]), self.dtype)[(slice(None), *rest)]
            low, high = min(chosen), max(chosen)
            values = self._read(low, high + 1)
            values = values[::step] if step > 0 else values[::-1][::-step]
            return values[(slice(None), *rest)]
        if isinstance(first, numbers.Integral):
            step = self._records._index(first)
            values = self._read(step, step + 1)[0]
            return values[tuple(rest)] if rest else values
        chosen = np.arange(len(self))[np.asarray(first)]
        values = np.stack([self[int(i)] for i in chosen]) if chosen.size else self[0:0]
        return values[(slice(None), *rest)]

    def at(self, time):
        """The record nearest to ``time`` (s)."""
        return self[self._records.nearest(time)]

    def window(self, start=None, stop=None):
        """The records from ``start`` to ``stop`` (s), both included."""
        return self[self._records.between(start, stop)]

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self[...], dtype)

    def __repr__(self):
        return f"<{self.name} in {self.units}, shape {self.shape}>"


class Side(Mapping):
    """One surface of the contact: a mapping of its fields, with ``points`` (m, shape (n, 3)) and
    ``quads`` (corners of its faces, shape (m, 4))."""

    def __init__(self, records, part, cells):
        self._records, self._part, self._cells = records, part, cells
        self.points = records.points[part]
        self.quads = records.cells[cells] - part.start

    def __getitem__(self, name):
        return self._records._field(name, self._part, self._cells)

    def __iter__(self):
        return iter(self._records)

    def __len__(self):
        return len(self._records)

    @property
    def times(self):
        """Times of the records (s)."""
        return self._records.times

    def line(self, y=0.0):
        """Nodes of the row along the rolling direction that is nearest to ``y`` (m), by rising x."""
        off = np.abs(self.points[:, 1] - y)
        row = np.flatnonzero(off <= off.min() + 1e-6 * np.ptp(self.points[:, 0]))
        return row[np.argsort(self.points[row, 0])]


class Records(Mapping):
    """A VTKHDF file over time: a mapping of names to :class:`Field`.

    Attributes:
        points: reference coordinates (m), shape (n, 3).
        cells: nodes of the cells, shape (m, 8) for bricks or (m, 4) for faces.
        steps: number of records.
        times: times of the records (s), shape (steps,).

    It shows what was complete when it was opened; :meth:`Run.reload` shows what has come since.
    """

    def __init__(self, path):
        self.path = Path(path)
        self._file = _creepage.Grid(self.path)
        self._fields = {row[0]: row for row in self._file.fields()}
        self.points = self._file.points().reshape(-1, 3)
        self.cells = self._file.connectivity().reshape(self._file.cells(), -1)
        self.times = self._file.times()
        self.steps = len(self.times)
        self._sides = None

    def __getitem__(self, name):
        return self._field(name, slice(0, len(self.points)), slice(0, len(self.cells)))

    def _field(self, name, points, cells):
        try:
            name, units, components, integer, on_cells, constant = self._fields[name]
        except KeyError:
            raise KeyError(f"{name!r}; there are {', '.join(self._fields)}") from None
        part = cells if on_cells else points
        return Field(self, name, units, components, integer, on_cells, constant, part)

    def __iter__(self):
        return iter(self._fields)

    def __len__(self):
        return len(self._fields)

    def _side(self, body):
        if self._sides is None:
            bodies = self[_NAMES["body"]][:]
            self._sides = []
            for k in (0, 1):
                mine = np.flatnonzero(bodies == k)
                nodes = np.unique(self.cells[mine])
                part = slice(int(nodes[0]), int(nodes[-1]) + 1)
                self._sides.append(Side(self, part, slice(int(mine[0]), int(mine[-1]) + 1)))
        return self._sides[body]

    @property
    def disk(self):
        """The disk's part."""
        return self._side(0)

    @property
    def bar(self):
        """The bar's part."""
        return self._side(1)

    def _index(self, step):
        count = self.steps
        if not -count <= step < count:
            raise IndexError(f"record {step} of {count}")
        return int(step) % count

    def nearest(self, time):
        """Index of the record nearest to ``time`` (s)."""
        return int(np.argmin(np.abs(self.times - time)))

    def between(self, start=None, stop=None, step=None):
        """Slice of the records from ``start`` to ``stop`` (s), both included."""
        low = 0 if start is None else int(np.searchsorted(self.times, start, "left"))
        high = self.steps if stop is None else int(np.searchsorted(self.times, stop, "right"))
        return slice(low, high, step)

    def to_pyvista(self, step=-1):
        """The record ``step`` as a ``pyvista.UnstructuredGrid`` with all fields."""
        pyvista = optional("pyvista")
        corners = self.cells.shape[1]
        kind = {8: pyvista.CellType.HEXAHEDRON, 4: pyvista.CellType.QUAD}[corners]
        cells = np.insert(self.cells.astype(np.int64), 0, corners, axis=1)
        grid = pyvista.UnstructuredGrid(cells.ravel(), np.full(len(cells), kind), self.points)
        for name, field in self.items():
            values = field[:] if field.constant else field[step]
            (grid.cell_data if field.on_cells else grid.point_data)[name] = values
        grid.field_data["time"] = [self.times[self._index(step)]]
        return grid

    def to_xarray(self, fields=None, records=slice(None), side=None):
        """Fields as an ``xarray.Dataset`` over ``time``, ``node`` (with its place x, y, z in m) or ``cell``, and
        ``component``.

        Args:
            fields: names of fields [default: all].
            records: a slice of the records, by number or, with floats, by time (s) [default: all].
            side: a :class:`Side`, for one surface alone [default: both bodies].
        """
        xarray = optional("xarray")
        source = self if side is None else side
        meanings = {name: meaning for name, _, _, meaning in _LAYOUT.get(self.path.name, [])}
        if any(isinstance(end, float) for end in (records.start, records.stop)):
            records = self.between(records.start, records.stop, records.step)
        variables = {}
        for name in source if fields is None else fields:
            field = source[name]
            place = ("cell" if field.on_cells else "node",)
            values = field[:] if field.constant else field[records]
            dims = place if field.constant else ("time", *place)
            if values.ndim > len(dims):
                dims += ({3: "component", 6: "tensor"}[values.shape[-1]],)
            attributes = {"units": field.units}
            if name in meanings:
                attributes["long_name"] = meanings[name]
            variables[name] = (dims, values, attributes)
        used = {dim for dims, _, _ in variables.values() for dim in dims}
        coordinates = {
            "time": ("time", self.times[records], {"units": "s"}),
            **{axis: ("node", source.points[:, k], {"units": "m"}) for k, axis in enumerate("xyz")},
            "component": ("component", list("xyz")),
            "tensor": ("tensor", ["xx", "yy", "zz", "xy", "yz", "xz"]),
        }
        kept = {name: value for name, value in coordinates.items() if value[0] in used}
        return xarray.Dataset(variables, kept)

    def __repr__(self):
        return f"<{self.path.name}: {self.steps} records of {', '.join(self._fields)}>"


class History(Mapping):
    """Scalars over time: a mapping of names to arrays of the shape (rows,)."""

    def __init__(self, path):
        self.path = Path(path)
        self._file = _creepage.History(self.path)
        self._units = dict(self._file.columns())

    def __getitem__(self, name):
        if name not in self._units:
            raise KeyError(f"{name!r}; there are {', '.join(self._units)}")
        return self._file.read(name)

    def __iter__(self):
        return iter(self._units)

    def __len__(self):
        return len(self._units)

    @property
    def units(self) -> dict:
        """Units of the columns, by name."""
        return dict(self._units)

    def to_pandas(self):
        """A ``pandas.DataFrame`` over the time (s); units are in its ``attrs["units"]``."""
        pandas = optional("pandas")
        time = _NAMES["time"]
        columns = {name: self[name] for name in self if name != time}
        frame = pandas.DataFrame(columns, index=pandas.Index(self[time], name=time))
        frame.attrs["units"] = self.units
        return frame

    def to_xarray(self):
        """An ``xarray.Dataset`` over the time (s); each variable has the attributes ``units`` and ``long_name``."""
        xarray = optional("xarray")
        time = _NAMES["time"]
        meanings = {name: meaning for name, _, _, meaning in _LAYOUT[_NAMES["history"]]}

        def described(name):
            attributes = {"units": self._units[name]}
            return attributes | ({"long_name": meanings[name]} if name in meanings else {})

        columns = {name: (time, self[name], described(name)) for name in self if name != time}
        return xarray.Dataset(columns, {time: (time, self[time], described(time))})

    def __repr__(self):
        return f"<{self.path.name}: {self._file.rows()} rows of {', '.join(self)}>"


class Run:
    """The results of a run, also of one that is under way or was made by the command line.

    Files are opened when they are first asked for, and read as far as they are asked for.

    Attributes:
        path: its folder.
    """

    def __init__(self, path):
        self.path = Path(path)
        if not self.path.exists():
            raise CaseError(f"{self.path}: there is no such folder")
        if not (self.path / _NAMES["case"]).is_file():
            raise CaseError(f"{self.path} holds no run: there is no {_NAMES['case']} in it")
        self._open = {}

    def _file(self, name, kind):
        if name not in self._open:
            path = self.path / name
            if not path.is_file():
                raise CaseError(f"{path} does not exist: the run has not come so far, or does not write it")
            self._open[name] = kind(path)
        return self._open[name]

    def reload(self):
        """Forget what was opened, to see what a run under way has written since."""
        self._open.clear()
        return self

    @property
    def fields(self) -> Records:
        """Both bodies over time; the fields are those of ``creepage.layout()["fields.vtkhdf"]``."""
        return self._file(_NAMES["fields"], Records)

    @property
    def contact(self) -> Records:
        """Both contact surfaces over time; the fields are those of ``creepage.layout()["contact.vtkhdf"]``. One
        surface by ``contact.disk`` and ``contact.bar``."""
        return self._file(_NAMES["contact"], Records)

    @property
    def history(self) -> History:
        """Scalars over time; the columns are those of ``creepage.layout()["history.h5"]``."""
        return self._file(_NAMES["history"], History)

    @property
    def probes(self) -> History:
        """Chosen nodes at every step, of a case with output.probes."""
        return self._file(_NAMES["probes"], History)

    @property
    def summary(self) -> dict:
        """What ``creepage run --json`` prints; empty while the run goes on."""
        path = self.path / _NAMES["summary"]
        return json.loads(path.read_text("utf-8")) if path.is_file() else {}

    @property
    def case(self) -> Case:
        """The case as resolved, every default written out; a dict."""
        return Case(json.loads(_creepage.from_toml((self.path / _NAMES["case"]).read_text("utf-8"))))

    def check(self, window=None, limits=None, *, pairing=None, strict=False) -> dict:
        """Where and by how much the run violates the contact conditions.

        Args:
            window: (from, to) in seconds, either None [default: the run's evaluation window].
            limits: limits of measures by name.
            pairing: "stricter", "before" or "after": slip of which step goes with a traction.
            strict: raise LimitError where a limit is exceeded.

        Returns:
            dict: window, steps, nodes, limits, metrics (value, limit, pass, where each), pass.
        """
        options = {"run": self.path, "span": _span(window), "pairing": pairing}
        options["limits"] = [(name, float(value)) for name, value in (limits or {}).items()]
        document = execute(_creepage.check, options)[0]
        if strict and not document["pass"]:
            broken = {}  # by their definitions, which aliases share
            for name, metric in document["metrics"].items():
                if metric.get("pass") is False:
                    value, note = metric["value"], metric.get("note", "not known")
                    text = f"{name} ({note})" if value is None else f"{name} = {value} (limit {metric['limit']})"
                    broken.setdefault(metric["about"], text)
            raise LimitError("beyond a limit: " + ", ".join(broken.values()), run=self)
        return document

    def figures(
        self,
        out=None,
        format=("svg", "png"),
        window=None,
        *,
        width=None,
        font_size=None,
        caption=True,
        at=(),
        probes=(),
        reference=None,
    ) -> dict:
        """Draw the figures of the run.

        Args:
            out: their folder [default: figures in the run's].
            format: "svg", "pdf", "png" or several of them.
            window: (from, to) in seconds [default: the run's evaluation window].
            width: on paper (mm), of PNG with 300 pixels per inch [default: as on a screen].
            font_size: of letters (points of 1/72 inch).
            caption: whether it stands below the panels.
            at: times (s) of lines and maps, four at most [default: the last three records].
            probes: numbers of those whose spectra are drawn [default: the first six].
            reference: "half-space": draw the tractions beside steady rolling of half-spaces, computed in seconds.

        Returns:
            dict: lists of files by the name of the figure.
        """
        formats = format.split(",") if isinstance(format, str) else format
        options = {
            "run": self.path,
            "out": out,
            "format": list(formats),
            "span": _span(window),
            "width": width,
            "font_size": font_size,
            "no_caption": not caption,
            "at": list(at),
            "probes": list(probes),
            "reference": reference,
        }
        document = execute(_creepage.plot, options)[0]
        return {each["name"]: [Path(file) for file in each["files"]] for each in document["figures"]}

    def render(
        self,
        out=None,
        *,
        time=None,
        field=None,
        what=None,
        view=None,
        magnify=None,
        span=None,
        width=None,
        frames=None,
    ) -> Path:
        """Draw the run in three dimensions, deformation magnified: a picture, or a film.

        Args:
            out: the file, .png, .gif or .mp4 [default: in the run's folder render.png, of contact surfaces
                render-contact.png].
            time: draw the record nearest to this time (s) [default: the last]; a film shows all.
            field: "von_mises", "velocity" or "deformation" of the bodies, "pressure", "shear" or
                "slip_velocity" of the contact surfaces.
            what: "fields" (both bodies) or "contact" (both surfaces) [default: that which ``field`` is of].
            view: "whole", "contact" or "both", of the bodies.
            magnify: how many times larger deformation is drawn [default: a round number that shows it].
            span: height of what a view of the contact shows (m).
            width: width in pixels [default: 1600, of a GIF 1000].
            frames: at most so many pictures in a film.

        Returns:
            Path: the file.

        Raises:
            CaseError: bad input.
            ImportError: PyVista is not installed; ``pip install 'creepage[render]'`` installs it.
        """
        from ._render_command import render  # which itself reads runs

        options = {"time": time, "field": field, "what": what, "view": view}
        options |= {"magnify": magnify, "span": span, "width": width, "frames": frames}
        return Path(render(self.path, out, **options)["file"])

    def stress_profile(self) -> dict:
        """The stress over the depth on the axis of the patch, at the last record of ``fields``.

        Needs the tensor ``stress`` in ``fields.vtkhdf`` (output.stress = true).

        Returns:
            dict: by the body, "disk" and "bar", a dict: ``depth`` (m, shape (n,)), the centroids of the elements;
            ``elements``, ``half_space`` (under the pressure and shear of the run) and ``hertz`` (under Hertz's pressure
            alone), each a dict of arrays of the same shape (Pa, tension positive): ``von_mises``, ``max_shear``,
            ``hydrostatic``, ``xx``, ``yy``, ``zz``, ``xz``; and ``half_length``, ``peak_pressure``, ``time``, ``x``.
        """
        profiles = execute(_creepage.stress_profile, {"run": self.path})[0]
        return {profile["body"]: _arrays(profile) for profile in profiles}

    def view(self, out=None) -> Path:
        """Write a page with the interactive scene of the run [default: scene.html in its folder]; returns its path."""
        return Path(execute(_creepage.view, {"run": self.path, "out": out})[0]["page"])

    def report(self, out=None, *, window=None, reference=None) -> Path:
        """Write one self-contained HTML page [default: report.html in the run's folder]; returns its path. ``window`` and
        ``reference`` are as of :meth:`figures`."""
        options = {"run": self.path, "out": out, "span": _span(window), "reference": reference}
        return Path(execute(_creepage.report, options)[0]["page"])

    def to_pyvista(self, step=-1, what="fields"):
        """A record as a ``pyvista.UnstructuredGrid``.

        Args:
            step: index of the record.
            what: "fields" (both bodies) or "contact" (both surfaces).
        """
        if what not in ("fields", "contact"):
            raise ValueError(f'what = {what!r}; "fields" or "contact" is needed')
        return getattr(self, what).to_pyvista(step)

    def to_xarray(self, what="history", **chosen):
        """The history, or records of the contact surfaces or the bodies, as an ``xarray.Dataset`` with units.

        Args:
            what: "history", "contact" or "fields".
            chosen: of contact and fields, what :meth:`Records.to_xarray` takes; ``side`` also as "disk" or "bar".
        """
        if what == "history":
            return self.history.to_xarray(**chosen)
        if what not in ("contact", "fields"):
            raise ValueError(f'what = {what!r}; "history", "contact" or "fields" is needed')
        records = getattr(self, what)
        if isinstance(chosen.get("side"), str):
            if chosen["side"] not in ("disk", "bar"):
                raise ValueError(f'side = {chosen["side"]!r}; "disk" or "bar" is needed')
            chosen["side"] = getattr(records, chosen["side"])
        return records.to_xarray(**chosen)

    def _repr_html_(self):
        summary = self.summary
        units, names = summary.get("units", {}), summary.get("names", {})
        keys = ["steps", "dt", "t_end", "elements", "wall_s", "energy.balance_error"]
        keys += [f"contact.{key}" for key in summary.get("contact", {})]
        rows = []
        for key in keys if summary else []:
            section, _, last = key.rpartition(".")
            value = (summary[section] if section else summary)[last]
            rows.append((key, value, _html.unit(units.get(key, "")), names.get(key, "")))
        heading = f"run {self.path}: {summary.get('status', 'under way')}"
        if "diagnosis" in summary:
            heading += f", {summary['diagnosis']}"
        return _html.page(heading, ("quantity", "value", "unit", "meaning"), rows)

    def __fspath__(self):
        return os.fspath(self.path)

    def __repr__(self):
        return f"<run {self.path}: {self.summary.get('status', 'under way')}>"


def _arrays(document):
    """The document with arrays in the place of its lists."""
    if isinstance(document, dict):
        return {key: _arrays(value) for key, value in document.items()}
    return np.array(document, float) if isinstance(document, list) else document


def _span(window):
    """The span of a window, either end of which may be open."""
    if window is None:
        return {}
    start, stop = window
    ends = (-math.inf if start is None else start, math.inf if stop is None else stop)
    return {"window": [float(t) for t in ends]}
