"""Explicit finite elements for rolling contact: an elastic disk rolls on an elastic bar."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._results import CheckResult, StressProfile, Summary, SweepResult

_Path = str | PathLike[str]
_Case = _Path | Mapping[str, Any]
_Floats = NDArray[np.float64]
# slip velocities (m/s, shape (n,)) to coefficients of friction (shape (n,))
_Law = Callable[[_Floats], ArrayLike]
_Progress = bool | Callable[[dict[str, Any]], object] | None
_Window = tuple[float | None, float | None]

class CreepageError(Exception):
    code: int
    message: str
    help: str | None
    run: Run | None
    def __init__(
        self,
        text: str,
        *,
        code: int | None = None,
        message: str | None = None,
        help: str | None = None,
        run: Run | None = None,
    ) -> None: ...

class LimitError(CreepageError, RuntimeError): ...
class CaseError(CreepageError, ValueError): ...
class RunError(CreepageError, RuntimeError): ...

class Interrupted(KeyboardInterrupt):
    code: int
    run: Run | None
    def __init__(self, text: str = "", *, run: Run | None = None) -> None: ...

__version__: str

class Case(dict[str, Any]):
    @property
    def units(self) -> dict[str, str]: ...
    def _repr_html_(self) -> str: ...

class Field:
    name: str
    units: str
    on_cells: bool
    constant: bool
    dtype: np.dtype[Any]
    shape: tuple[int, ...]
    @property
    def ndim(self) -> int: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: Any) -> NDArray[Any]: ...
    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]: ...
    def at(self, time: float) -> NDArray[Any]: ...
    def window(self, start: float | None = None, stop: float | None = None) -> NDArray[Any]: ...

class Side(Mapping[str, Field]):
    points: _Floats
    quads: NDArray[np.uint32]
    @property
    def times(self) -> _Floats: ...
    def line(self, y: float = 0.0) -> NDArray[np.intp]: ...
    def __getitem__(self, name: str) -> Field: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...

class Records(Mapping[str, Field]):
    path: Path
    points: _Floats
    cells: NDArray[np.uint32]
    steps: int
    times: _Floats
    def __init__(self, path: _Path) -> None: ...
    @property
    def disk(self) -> Side: ...
    @property
    def bar(self) -> Side: ...
    def nearest(self, time: float) -> int: ...
    def between(
        self, start: float | None = None, stop: float | None = None, step: int | None = None
    ) -> slice: ...
    def to_pyvista(self, step: int = -1) -> Any: ...
    def to_xarray(
        self,
        fields: Sequence[str] | None = None,
        records: slice = ...,
        side: Side | None = None,
    ) -> Any: ...
    def __getitem__(self, name: str) -> Field: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...

class History(Mapping[str, _Floats]):
    path: Path
    def __init__(self, path: _Path) -> None: ...
    @property
    def units(self) -> dict[str, str]: ...
    def to_pandas(self) -> Any: ...
    def to_xarray(self) -> Any: ...
    def __getitem__(self, name: str) -> _Floats: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...

class Run:
    path: Path
    def __init__(self, path: _Path) -> None: ...
    def __fspath__(self) -> str: ...
    def reload(self) -> Run: ...
    @property
    def fields(self) -> Records: ...
    @property
    def contact(self) -> Records: ...
    @property
    def history(self) -> History: ...
    @property
    def probes(self) -> History: ...
    @property
    def summary(self) -> Summary: ...  # empty while the run goes on
    @property
    def case(self) -> Case: ...
    def check(
        self,
        window: _Window | None = None,
        limits: Mapping[str, float] | None = None,
        *,
        pairing: Literal["stricter", "before", "after"] | None = None,
        strict: bool = False,
    ) -> CheckResult: ...
    def figures(
        self,
        out: _Path | None = None,
        format: str | Sequence[str] = ("svg", "png"),
        window: _Window | None = None,
        *,
        width: float | None = None,
        font_size: float | None = None,
        caption: bool = True,
        at: Sequence[float] = (),
        probes: Sequence[int] = (),
        reference: Literal["half-space"] | None = None,
    ) -> dict[str, list[Path]]: ...
    def render(
        self,
        out: _Path | None = None,
        *,
        time: float | None = None,
        field: Literal["von_mises", "velocity", "deformation", "pressure", "shear", "slip_velocity"]
        | None = None,
        what: Literal["fields", "contact"] | None = None,
        view: Literal["whole", "contact", "both"] | None = None,
        magnify: float | None = None,
        span: float | None = None,
        width: int | None = None,
        frames: int | None = None,
    ) -> Path: ...
    def stress_profile(self) -> dict[Literal["disk", "bar"], StressProfile]: ...
    def view(self, out: _Path | None = None) -> Path: ...
    def report(
        self, out: _Path | None = None, *, window: _Window | None = None, reference: Literal["half-space"] | None = None
    ) -> Path: ...
    def to_pyvista(self, step: int = -1, what: Literal["fields", "contact"] = "fields") -> Any: ...
    def to_xarray(self, what: Literal["history", "contact", "fields"] = "history", **chosen: Any) -> Any: ...
    def _repr_html_(self) -> str: ...

class Sweep(Sequence[Run | None]):
    path: Path
    columns: list[str]
    units: dict[str, str]
    meanings: dict[str, str]
    document: SweepResult
    def __init__(self, path: _Path) -> None: ...
    def reload(self) -> Sweep: ...
    @property
    def parameters(self) -> list[str]: ...
    @property
    def names(self) -> list[str]: ...
    def __len__(self) -> int: ...
    def __getitem__(self, which: Any) -> Any: ...
    def to_pandas(self, means: bool = False) -> Any: ...
    def to_xarray(self) -> Any: ...
    def _repr_html_(self) -> str: ...

def run(
    case: _Case,
    out: _Path | None = None,
    *,
    threads: int | None = None,
    resume: bool = False,
    force: bool = False,
    preload_cache: _Path | None = None,
    progress: _Progress = None,
    friction: Mapping[str, Any] | _Law | None = None,
    **overrides: Any,
) -> Run: ...
def sweep(
    file: _Path,
    out: _Path | None = None,
    *,
    jobs: int | None = None,
    threads: int | None = None,
    memory: float | None = None,
    resume: bool = False,
    force: bool = False,
    progress: _Progress = None,
) -> SweepResult: ...
def slider(**settings: Any) -> dict[str, Any]: ...
def verify(
    *names: str,
    quick: bool = False,
    list: bool = False,
    plot: _Path | None = None,
) -> dict[str, Any]: ...
def from_lsdyna(
    folder: _Path,
    deck: _Path | None = None,
    *,
    out: _Path,
    wheel: int | None = None,
    rail: int | None = None,
    unit: str = "mm-ton-s",
    scales: Mapping[str, float] | None = None,
) -> Run: ...
def layout() -> dict[str, list[tuple[str, str, str, str]]]: ...
def schema() -> dict[str, Any]: ...

class _Mesh:
    def __call__(self, case: _Case, out: _Path | None = None, **overrides: Any) -> dict[str, Any]: ...
    @staticmethod
    def from_meshio(
        mesh: Any,
        sets: Mapping[str, str | ArrayLike] | None = None,
        *,
        out: _Path,
        unit: Literal["m", "cm", "mm", "in"] = "m",
    ) -> dict[str, str]: ...

mesh: _Mesh
