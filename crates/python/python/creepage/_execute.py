"""Calls of the native functions: what they say while they work, and how they fail."""

from __future__ import annotations

import json
import logging
import warnings
from pathlib import Path

from . import _case
from ._errors import CaseError, Interrupted, RunError
from ._progress import listener


def execute(function, options, *more, progress=None):
    """Call a native function; returns its document and folder, or raises what it fails with."""
    listen, close = listener(progress, said)
    try:
        answer = function(_case.options(options), *more, listen)
    finally:
        close()
    folder = answer["folder"]
    if answer["interrupted"] or answer["code"] == 130:
        run = begun(folder)
        raise Interrupted("interrupted; resume=True goes on" if run else "interrupted", run=run)
    if "error" in answer:
        kind = CaseError if answer["code"] == 2 else RunError
        raise kind(
            answer["text"],
            code=answer["code"],
            message=answer["error"],
            help=answer["help"],
            run=begun(folder) if kind is RunError else None,
        )
    return json.loads(answer["document"]), folder


def begun(folder):
    """The run in a folder, if there is one."""
    from ._run import Run  # which itself runs commands

    if folder is None or not (Path(folder) / "case.toml").is_file():
        return None
    return Run(folder)


def said(line):
    """Passes a warning on to whoever called the package, and other remarks to its log."""
    if line.startswith("warning: "):
        warnings.warn(line.removeprefix("warning: "), stacklevel=5)
    else:
        logging.getLogger("creepage").info(line)
