"""Runs, sweeps, the slider, the verification problems."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Mapping

from . import _case, _creepage
from ._errors import CaseError, CreepageError, RunError
from ._execute import execute
from ._run import Run


def run(
    case,
    out=None,
    *,
    threads=None,
    resume=False,
    force=False,
    preload_cache=None,
    progress=None,
    friction=None,
    **overrides,
):
    """Run a case and return its results.

    Args:
        case: path of a case file, name of a reference case (``creepage cases``), or a dict of keys (sections as dicts, or
            dotted keys).
        out: folder of the run [default: runs/NAME].
        threads: number of threads [default: one per core]. The bits do not depend on it.
        resume: go on from the run's last checkpoint; a complete run is left alone.
        force: replace the run that is in the folder.
        preload_cache: folder in which preloads are kept for other runs with the same.
        progress: True for a bar (tqdm's if installed), or a callable that is given a dict: stage
            ("mesh", "preload", "roll"), step, steps, time and end_time (s), normal_force and
            tangential_force (N), element_steps_per_s.
        friction: keys of [friction] as a dict, or a friction law: a callable ``law(s)`` that is given
            the slip velocities of all nodes in contact (m/s, shape (n,), each >= 0) and returns their
            coefficients of friction (shape (n,), finite, >= 0). Its source is recorded in the case; to
            resume, hand it over again.
        overrides: keys of the case, as sections (``mesh={"zone": {"size": 2e-3}}``) or dotted
            (``**{"mesh.zone.size": 2e-3}``).

    Returns:
        The :class:`Run`.

    Raises:
        CaseError: bad input.
        RunError: the run was stopped by its own guards; what it computed is in the error's ``run``.
        Interrupted: Ctrl-C, after a checkpoint was written (a KeyboardInterrupt).
        Exception: what ``friction`` or ``progress`` raised, after the run has ended in order.
    """
    law = None
    if friction is not None and not isinstance(friction, Mapping):
        if not callable(friction):
            raise CaseError("friction must be a callable law(s) or a dict of the keys of [friction]")
        law = friction
        overrides = {**_case.law(law), **overrides}
    elif friction is not None:
        overrides = {"friction": friction, **overrides}
    options = {"out": out, "threads": threads, "resume": resume, "force": force}
    options |= {"case": _case.source(case, overrides), "preload_cache": preload_cache}
    summary, folder = execute(_creepage.run, options, law, progress=progress)
    result = Run(folder)
    if summary["status"] == "failed":
        diagnosis = summary.get("diagnosis", "the run failed")
        raise RunError(diagnosis, run=result)
    return result


def sweep(
    file, out=None, *, jobs=None, threads=None, memory=None, resume=False, force=False, progress=None
):
    """Run a case over a grid of parameters, each run in a process of its own.

    Args:
        file: the sweep file.
        out: folder of the sweep [default: runs/NAME].
        jobs: runs at a time [default: one per core].
        threads: threads of each run [default: cores over jobs].
        memory: what the runs may take together (MB).
        resume: keep the runs that are done.
        force: replace the sweep that is in the folder.
        progress: True for a bar, or a callable that is given a dict: runs, completed, failed,
            running, fraction.

    Returns:
        dict: ``parameters`` and ``runs`` (parameters, status, run, summary, check). A run that
        failed has that status and its reason; none is raised.
    """
    options = {"sweep": file, "out": out, "jobs": jobs, "threads": threads, "memory": memory}
    options |= {"resume": resume, "force": force}
    return execute(_creepage.sweep, options, progress=progress)[0]


def slider(**settings):
    """The 1-D slider of the paper: a block on a belt with falling friction.

    Args:
        settings: options of ``creepage slider`` with ``_`` for ``-``: method ("implicit",
            "explicit", "penalty", "exact", "memory"), dt, t_end, belt, normal_force, mass, spring,
            damping, law, mu_static, expression, table, csv, plot, ...; ``tables=True`` for Tables 2
            to 4 of the paper, ``thresholds=True`` for the time steps above which the explicit method
            fails.

    Returns:
        dict: x_min, x_max (m), v_max (m/s) and more; with ``tables`` or ``thresholds`` those.
    """
    others = ("config", "csv", "plot", "thresholds", "tables")
    options = {name: settings.pop(name) for name in others if name in settings}
    given = {name: value for name, value in settings.items() if value is not False}
    return execute(_creepage.slider, {**options, "settings": given})[0]


def verify(*names, quick=False, list=False, plot=None):
    """Run verification problems, each beside its reference.

    Args:
        names: problems [default: all].
        quick: coarse meshes.
        list: name all problems and run none.
        plot: folder for figures of the errors.

    Returns:
        dict: ``results`` (name, quantity, reference, computed, error, limit, pass, source) and
        ``pass``; with ``list`` the ``problems``.
    """
    program = shutil.which("creepage-verify")
    if program is None:
        problem = "creepage-verify, the program of the verification problems, is not on PATH"
        raise CaseError(f"{problem}: `cargo install --path verification` in the sources installs it")
    flags = {"--quick": quick, "--list": list}
    words = [flag for flag, given in flags.items() if given]
    words += ["--plot", os.fspath(plot)] if plot is not None else []
    done = subprocess.run([program, "--json", "--quiet", *words, "--", *names], capture_output=True, text=True)
    document = json.loads(done.stdout or "{}")
    if done.returncode > 1:
        raise (CaseError if done.returncode == 2 else CreepageError)(document.get("error", done.stderr))
    return document


def schema() -> dict:
    """JSON Schema of a case: every key with its unit, default and range."""
    return json.loads(_creepage.schema())
