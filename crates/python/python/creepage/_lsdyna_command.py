"""``creepage from-lsdyna``, the command."""

from __future__ import annotations

import json
from pathlib import Path

from ._errors import CreepageError, refuse
from ._lsdyna import imported
from ._render_command import Parser, failed, of_command

ABOUT = "Bring the contact of LS-DYNA results into the layout of a run, for check, plot, report and compare"
EPILOG = """examples:
  creepage from-lsdyna results --out runs/theirs
  creepage check runs/theirs

The folder holds binout with the databases ncforc and nodout, and the keyword file. They are read by lasso-python:
pip install 'creepage[lsdyna]'. What the deck needs: docs/ls-dyna.md."""


def parser() -> Parser:
    """The options of the command."""
    made = Parser("creepage from-lsdyna", description=ABOUT, epilog=EPILOG, allow_abbrev=False)
    add = made.add_argument
    add("folder", metavar="FOLDER", help="folder of the results")
    add("--deck", metavar="FILE.k", help="the keyword file [default: the only one in FOLDER]")
    add(
        "--wheel",
        metavar="SET",
        type=int,
        help="number of the wheel's side on the card of the contact [default: the upper]",
    )
    add("--rail", metavar="SET", type=int, help="number of the rail's side")
    add("--unit", metavar="mm-ton-s", default="mm-ton-s", help="units of the deck: length (m, cm, mm, in), mass (kg, "
        "ton, g), time (s, ms, us)")  # fmt: skip
    add("--scale", metavar="NAME=VALUE", action="append", default=[], help="a scale of the check for case.toml, for "
        "example slip_speed=0.1; may be repeated")  # fmt: skip
    add("--out", metavar="RUN", required=True, help="new folder for contact.vtkhdf and case.toml")
    add("--json", action="store_true", help="print exactly one JSON document on standard output")
    add("-q", "--quiet", action="store_true", help="say nothing but errors")
    return made


def scale(word):
    """A name and a number of ``NAME=VALUE``."""
    name, _, value = word.partition("=")
    try:
        return name, float(value)
    except ValueError:
        refuse(f"invalid value {word!r} for '--scale': NAME=VALUE is needed, for example slip_speed=0.1")


def taken(words) -> list[str] | None:
    """The words after ``from-lsdyna`` where that is the command."""
    return of_command("from-lsdyna", words)


def main(words) -> int:
    """``creepage from-lsdyna`` with these words; returns its exit code."""
    try:
        given = parser().parse_args(words)
        options = {"wheel": given.wheel, "rail": given.rail, "unit": given.unit}
        document = imported(given.folder, given.deck, given.out, options, dict(map(scale, given.scale)))
    except (CreepageError, ImportError, OSError) as error:
        return failed(error, "--json" in words)
    if given.json:
        print(json.dumps(document, indent=2, ensure_ascii=False))
    elif not given.quiet:
        print(said(document))
    return 0


def said(document) -> str:
    """The lines about what was read."""
    (first, last), (wheel, rail) = document["time"], document["nodes"]
    span = f"from {1e3 * first:.4f} to {1e3 * last:.4f} ms"
    sides = f"{wheel} nodes of the wheel and {rail} of the rail"
    lines = [f"{document['run']}: {document['records']} records {span}, {sides}"]
    for key, what in [
        ("earlier", "states before the wheel rolls were left out"),
        ("unmatched", "states stand in one of ncforc and nodout alone, and were left out"),
        ("without_projection", "times a node with a force had no projection on the other surface, and was left out"),
    ]:
        if document[key]:
            lines.append(f"{document[key]} {what}")
    return "\n".join([*lines, *document["notes"], f"go on with: creepage check {Path(document['run'])}"])
