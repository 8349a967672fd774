"""Commands of the command line, held by Python."""

from __future__ import annotations

import json
import logging
import os
import sys
import warnings
from pathlib import Path

from . import _creepage
from ._errors import CaseError, Interrupted, RunError
from ._progress import listener

# what does the runs of a sweep
PROGRAM = [sys.executable, "-m", "creepage"]


def execute(words, *, case=None, law=None, progress=None):
    """Run a command; returns its exit code, document and folder, or raises what it fails with."""
    listen, close = listener(progress, said)
    try:
        answer = _creepage.command(
            [os.fspath(word) for word in words], case=case, law=law, program=PROGRAM, listen=listen
        )
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
    document = answer["document"]
    return answer["code"], None if document is None else json.loads(document), folder


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


def options(**given):
    """Options of the command line: None and False are left out, True is a flag."""
    words = []
    for name, value in given.items():
        if value is None or value is False:
            continue
        words.append("--" + name.replace("_", "-"))
        if value is not True:
            words.append(os.fspath(value) if isinstance(value, os.PathLike) else str(value))
    return words
