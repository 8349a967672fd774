"""Results of LS-DYNA as a run: forces and motion of nodes from binout or d3plot, the surfaces from the deck."""

from __future__ import annotations

import tempfile
from pathlib import Path

from . import _binout, _creepage
from ._errors import CaseError, refuse
from ._execute import execute
from ._foreign import MESH, case_of, fresh, scales_of, since, written
from ._run import _NAMES, Run

DECKS = (".k", ".key", ".dyn")


def from_lsdyna(folder, deck=None, *, out, wheel=None, rail=None, unit="mm-ton-s", scales=None) -> Run:
    """Bring results of LS-DYNA into the layout of a run, for ``check``, ``figures`` and ``report``.

    Args:
        folder: what LS-DYNA wrote: binout with the databases ncforc and nodout; d3plot stands in for nodout.
        deck: the keyword file [default: the only one in the folder].
        out: a new folder, for contact.vtkhdf and case.toml.
        wheel, rail: the numbers of these sides on the card of the contact [default: the wheel is the upper one].
        unit: the deck's units of length, mass and time.
        scales: scales of the check by their names, in SI units, which go into case.toml.

    Returns:
        Run: the run in ``out``.
    """
    imported(folder, deck, out, {"wheel": wheel, "rail": rail, "unit": unit}, scales or {})
    return Run(out)


def imported(folder, deck, out, options, scales) -> dict:
    """Writes the run; returns what ``creepage from-lsdyna --json`` prints."""
    folder, out = Path(folder), fresh(out)
    binout = _binout.opened(folder)
    sides = _binout.ncforc(binout)
    motion, notes = _binout.motion(binout, folder)
    document = of_deck(deck or only_deck(folder), out, options, scales, lambda _: (sides, motion))
    return {**document, "notes": notes + document["notes"]}


def of_deck(deck, out, options, scales, read) -> dict:
    """Writes the run of a keyword file; ``read`` gives forces and motion for its contact."""
    deck = Path(deck)
    contact = execute(_creepage.interface_of_k, {"file": deck.absolute(), **options})[0]
    document = written(out, contact, *read(contact))
    notes = write_case(out, deck, options, contact, scales) + document["notes"]
    return {"deck": str(deck), **document, "notes": notes}


def only_deck(folder):
    """The keyword file in a folder of results."""
    found = sorted(path for path in folder.glob("*") if path.suffix.lower() in DECKS)
    if len(found) != 1:
        names = ", ".join(path.name for path in found) or "none"
        refuse(f"{folder} should hold one keyword file ({', '.join(DECKS)}); it has: {names}", "give it: --deck FILE.k")
    return found[0]


def write_case(out, deck, options, contact, scales) -> list[str]:
    """Writes the case: that of the keyword file where a disk on a bar says all of it, else what is known."""
    with tempfile.TemporaryDirectory() as scratch:
        try:
            made = {
                "file": deck.absolute(),
                "unit": options["unit"],
                "out": Path(scratch, "case"),
                "include_outside": True,
            }
            case = execute(_creepage.import_k, made)[0]
            text, notes = Path(case["case"]).read_text("utf-8"), ["case.toml is the case of the deck, as of import-k"]
            (out / MESH).write_bytes(Path(case["mesh"]).read_bytes())
        except CaseError as why:
            text = case_of(out, contact["friction"], {})
            notes = [f"case.toml has the law of friction alone, since the deck is no disk on a bar: {why.message}"]
            if contact["friction"] is None:
                notes.append("FS of the contact stands for friction elsewhere: add [friction] to case.toml")
    (out / _NAMES["case"]).write_text(text + scales_of(scales), "utf-8")
    return notes
