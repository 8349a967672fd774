"""``creepage from-lsdyna`` and the others that read results of other programs, the commands."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

from . import _lsdyna, _readers
from ._errors import CreepageError, refuse
from ._render_command import Parser, failed, of_command


@dataclass
class Format:
    """What a command reads.

    Attributes:
        program: whose results.
        read: from the words of the command, options, friction and scales to what ``--json`` prints.
        positional: name and help of what is read.
        more: another option with its name and help: the keyword file or the file of the sets.
        example: words of an example.
        epilog: what the other program must record.
    """

    program: str
    read: Callable
    positional: tuple[str, str]
    more: tuple[str, str, str] | None
    example: str
    epilog: str

    @property
    def by_deck(self):
        """Whether a keyword file gives surfaces and friction."""
        return self.more is not None and self.more[0] == "--deck"


FORMATS = {
    "from-lsdyna": Format(
        "LS-DYNA",
        lambda given, options, _, scales: _lsdyna.imported(given.of, given.more, given.out, options, scales),
        ("FOLDER", "folder of the results"),
        ("--deck", "FILE.k", "the keyword file [default: the only one in FOLDER]"),
        "results",
        """The folder holds binout with the databases ncforc and nodout (or d3plot), and the keyword file. They are read by
lasso-python: pip install 'creepage[lsdyna]'. What the deck needs: docs/ls-dyna.md.""",
    ),
    "from-openradioss": Format(
        "OpenRadioss",
        lambda given, options, _, scales: _readers.openradioss(given.of, given.more, given.out, options, scales),
        ("FOLDER", "folder of the animation files, converted by anim_to_vtk"),
        ("--deck", "FILE.k", "the keyword file of export-k, unchanged"),
        "results --deck deck.k",
        "The animation files hold /ANIM/VECT/VEL and /ANIM/VECT/CONT: docs/two-codes.md.",
    ),
    "from-calculix": Format(
        "CalculiX",
        lambda given, *rest: _readers.calculix(given.of, given.more, given.out, *rest),
        ("JOB.frd", "the results, as text"),
        ("--sets", "JOB.inp", "the input file, which has the sets of nodes"),
        "job.frd --sets job.inp --wheel TREAD --rail TOP --friction 0.3",
        "*NODE FILE writes U and V, *CONTACT FILE writes CDIS and CSTR: docs/two-codes.md.",
    ),
    "from-aster": Format(
        "code_aster",
        lambda given, *rest: _readers.aster(given.of, given.out, *rest),
        ("FILE.med", "the results, with their mesh"),
        None,
        "job.med --wheel TREAD --rail TOP --friction 0.3",
        "It is read by h5py: pip install 'creepage[mesh]'. What it holds: docs/two-codes.md.",
    ),
    "from-tables": Format(
        "any program's",
        lambda given, *rest: _readers.tables(given.of, given.out, *rest),
        ("FOLDER", "folder of nodes.csv, faces.csv and values.csv"),
        None,
        "results --friction 0.3",
        "The columns, and a script that writes them from Abaqus: docs/two-codes.md.",
    ),
}


def parser(name) -> Parser:
    """The options of a command."""
    of = FORMATS[name]
    about = f"Bring the contact of {of.program} results into the layout of a run, for check, plot, report and compare"
    examples = f"examples:\n  creepage {name} {of.example} --out runs/theirs\n  creepage check runs/theirs\n\n"
    made = Parser(f"creepage {name}", description=about, epilog=examples + of.epilog, allow_abbrev=False)
    add = made.add_argument
    add("of", metavar=of.positional[0], help=of.positional[1])
    if of.more:
        option, metavar, help = of.more
        add(option, metavar=metavar, help=help, dest="more", required=name != "from-lsdyna")
    if of.by_deck:
        add("--wheel", metavar="SET", type=int, help="number of the wheel's side on the card of the contact [default: "
            "the upper]")  # fmt: skip
        add("--rail", metavar="SET", type=int, help="number of the rail's side")
    elif name != "from-tables":
        for side in ("wheel", "rail"):
            add(f"--{side}", metavar="SET", required=True, help=f"set of the nodes of the {side}'s surface")
    if not of.by_deck:
        add("--friction", metavar="STATIC[,DYNAMIC,DECAY]", help="the law for case.toml: mu = DYNAMIC + (STATIC - "
            "DYNAMIC) exp(-DECAY v), DECAY in s/m")  # fmt: skip
    add("--unit", metavar="mm-ton-s", default="mm-ton-s", help="units of the files: length (m, cm, mm, in), mass (kg, "
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


def law(word):
    """The three numbers of ``STATIC[,DYNAMIC,DECAY]``, or None."""
    if word is None:
        return None
    try:
        static, dynamic, decay = (*map(float, word.split(",")), None, None)[:3]
        return (static, static, 0.0) if dynamic is None else (static, dynamic, float(decay))
    except (TypeError, ValueError):
        refuse(f"invalid value {word!r} for '--friction': STATIC or STATIC,DYNAMIC,DECAY is needed, for example 0.3")


def taken(words) -> list[str] | None:
    """The words of one of these commands, its name first."""
    for name in FORMATS:
        rest = of_command(name, words)
        if rest is not None:
            return [name, *rest]
    return None


def main(words) -> int:
    """One of these commands with these words, its name first; returns its exit code."""
    name, *rest = words
    try:
        given = parser(name).parse_args(rest)
        options = {side: getattr(given, side, None) for side in ("wheel", "rail")} | {"unit": given.unit}
        friction = law(getattr(given, "friction", None))
        document = FORMATS[name].read(given, options, friction, dict(map(scale, given.scale)))
    except (CreepageError, ImportError, OSError) as error:
        return failed(error, "--json" in rest)
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
        ("unmatched", "states have forces or motion alone, and were left out"),
        ("without_projection", "times a node with a force had no projection on the other surface, and was left out"),
    ]:
        if document[key]:
            lines.append(f"{document[key]} {what}")
    return "\n".join([*lines, *document["notes"], f"go on with: creepage check {Path(document['run'])}"])
