"""Exceptions, with the messages and exit codes of the command line."""

from __future__ import annotations


class CreepageError(Exception):
    """Something that the command line ends with an exit code for.

    Attributes:
        code: exit code of the command line: 1 a check failed, 2 bad input, 3 stopped by guards.
        message: what is wrong, in one sentence.
        help: what to do, or None.
        run: the run that was begun, or None.
    """

    code = 3

    def __init__(self, text, *, code=None, message=None, help=None, run=None):
        super().__init__(text)
        self.code = self.code if code is None else code
        self.message = text if message is None else message
        self.help = help
        self.run = run


class LimitError(CreepageError, RuntimeError):
    """A check exceeds a limit (exit code 1)."""

    code = 1


class CaseError(CreepageError, ValueError):
    """Bad input: a case, a mesh, an option, an unreadable run (exit code 2)."""

    code = 2


class RunError(CreepageError, RuntimeError):
    """A run was stopped by its own guards (exit code 3); what it computed until then is readable in ``run``."""

    code = 3


class Interrupted(KeyboardInterrupt):
    """Ctrl-C (exit code 130). A run has written a checkpoint: ``creepage.run(..., resume=True)`` goes on.

    Attributes:
        run: the run that was interrupted, or None.
    """

    code = 130

    def __init__(self, text="", *, run=None):
        super().__init__(text)
        self.run = run


def refuse(problem, help=None):
    """Raises the refusal of bad input."""
    raise CaseError(problem if help is None else f"{problem}\n{help}", message=problem, help=help)
