"""Explicit finite elements for rolling contact: an elastic disk rolls on an elastic bar.

    import creepage
    run = creepage.run("cases/quick.toml", friction=lambda s: 0.3 + 0.2 * np.exp(-6 * s))
    run.contact.bar["pressure"][-1]     # Pa, one number per node

SI units everywhere; x rolling direction, y lateral, z up; the undeformed disk touches the bar's
apex at the origin.
"""

from ._commands import run, schema, slider, sweep, verify
from ._creepage import __version__
from ._errors import CaseError, CreepageError, Interrupted, LimitError, RunError
from ._lsdyna import from_lsdyna
from ._mesh import mesh
from ._resolved import Case
from ._run import Field, History, Records, Run, Side, layout
from ._sweep import Sweep

__all__ = [
    "Case",
    "CaseError",
    "CreepageError",
    "Field",
    "History",
    "Interrupted",
    "LimitError",
    "Records",
    "Run",
    "RunError",
    "Side",
    "Sweep",
    "from_lsdyna",
    "layout",
    "mesh",
    "run",
    "schema",
    "slider",
    "sweep",
    "verify",
]
