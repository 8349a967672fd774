"""Options of a picture or film, and ``creepage render``, the command that takes them."""

from __future__ import annotations

import argparse
import json
import math
import sys
from pathlib import Path

import numpy as np

from . import _creepage, _film
from ._errors import CaseError, CreepageError, refuse
from ._frames import BAR, QUANTITIES, Source
from ._optional import optional
from ._run import _NAMES

ABOUT = "Draw a run in three dimensions, deformation magnified: a picture, or a film"
EPILOG = """examples:
  creepage render runs/quick
  creepage render runs/quick --field pressure --time 1e-3
  creepage render runs/quick --view contact --magnify 100 --out contact.png
  creepage render runs/quick --out quick.gif

A PNG shows one record, a GIF or MP4 all. It is drawn by PyVista: pip install 'creepage[render]'. The rigid motion
of the disk is not magnified. What the views show: docs/python.md."""
BY_NAME = {
    "what": (("fields", "contact"), "fields or contact is needed"),
    "view": (("both", "whole", "contact"), "both, whole or contact is needed"),
    "field": (
        tuple(QUANTITIES),
        "one of von_mises, velocity, deformation (of fields), pressure, shear, slip_velocity (of contact) is needed",
    ),
}
BY_VALUE = {
    "time": (float, math.isfinite, "a number of seconds is needed"),
    "magnify": (float, lambda n: math.isfinite(n) and n >= 0, "a number of at least 0 is needed"),
    "span": (float, lambda n: math.isfinite(n) and n > 0, "a number greater than 0 is needed"),
    "width": (int, lambda n: 200 <= n <= 8000, "a whole number of pixels from 200 to 8000 is needed"),
    "frames": (int, lambda n: 1 <= n <= 100_000, "a whole number from 1 to 100000 is needed"),
}


def render(folder, out=None, **given) -> dict:
    """Draws the run in ``folder``; returns what ``creepage render --json`` prints.

    Args:
        folder: folder of the run.
        out, given: as of ``Run.render``.
    """
    options = checked(given)
    what = options["what"] or (QUANTITIES[options["field"]][0] if options["field"] else "fields")
    folder = Path(folder)
    if out is None:
        out = folder / ("render-contact.png" if what == "contact" else "render.png")
    out = Path(out)
    film = _film.kind(out) != ".png"
    exclude(options, what, film)
    try:
        source = opened(folder, what, options)
        contact = surfaces(folder, source, options)
    except OSError as error:
        refuse(str(error), "copy it again from where it is whole, or run it again")
    _film.check(out)
    optional("pyvista", "render")
    from ._render import Scene  # pictures are drawn by few, and PyVista takes a second to load

    options["width"] = options["width"] or (1000 if out.suffix.lower() == ".gif" else 1600)
    scene = Scene(source, contact, options, title(folder))
    records = spread(source.records.steps, options["frames"]) if film else [chosen(source, options["time"])]
    try:
        scene.scale_to(records)
        _film.write(out, (scene.picture(record) for record in records))
    finally:
        scene.close()
    return {
        "field": options["field"],
        "file": str(out),
        "label": QUANTITIES[options["field"]][2],
        "magnifications": [float(pane.magnify) for pane in scene.panes],
        "records": source.records.steps,
        "times": [float(source.times[record]) for record in records],
        "top": float(scene.top),
    }


def checked(given) -> dict:
    """The options, each refused where it is not what it must be."""
    options = {}
    for name in (*BY_NAME, *BY_VALUE):
        value = given.get(name)
        if value is not None and name in BY_NAME:
            allowed, wanted = BY_NAME[name]
            if value not in allowed:
                refuse(f"invalid value {value!r} for '--{name}': {wanted}")
        elif value is not None:
            read, holds, wanted = BY_VALUE[name]
            try:
                number = read(value)
                fine = holds(number) and (isinstance(value, str) or number == value)
            except (TypeError, ValueError, OverflowError):
                fine = False
            if not fine:
                refuse(f"invalid value {str(value)!r} for '--{name}': {wanted}")
            value = number
        options[name] = value
    return options


def exclude(options, what, film):
    """Refuses options that do not go together."""
    if film and options["time"] is not None:
        refuse("--time cannot be used with a film, which shows all records")
    if not film and options["frames"] is not None:
        refuse("--frames cannot be used with a picture (.png)")
    if options["field"] and QUANTITIES[options["field"]][0] != what:
        names = [name for name, row in QUANTITIES.items() if row[0] == what]
        refuse(f"--field {options['field']}: --what {what} does not have it", f"it has {', '.join(names)}")
    if options["view"] and what == "contact":
        refuse("--view cannot be used with contact surfaces, which have one")


def opened(folder, what, options) -> Source:
    """The records that are drawn; the field that the colours show is put into ``options`` where it is not given."""
    if not folder.exists():
        refuse(f"{folder}: there is no such file or folder")
    if folder.is_file():
        kind = "is a case or a sweep, and no run: run it first, then" if folder.suffix == ".toml" else "is a file:"
        refuse(f"{folder} {kind} give the folder of the run")
    name = _NAMES[what]
    if not (folder / name).is_file():
        half_space = 'but one of half-spaces (model = "half-space") has no bodies to draw: --what contact draws its'
        writes = {
            "fields": f"a run writes {name} every output.fields_interval, {half_space} surfaces",
            "contact": "its contact surfaces are written every output.contact_interval",
        }
        refuse(f"{folder} holds no {name}", f"give the folder of a run; {writes[what]}")
    source = Source(folder, what)
    if not source.records.steps:
        refuse(f"{folder / name} holds no record yet", "wait until the run rolls")
    shown = [quantity for quantity, row in QUANTITIES.items() if row[0] == what and source.shows(quantity)]
    options["field"] = options["field"] or (shown[0] if shown else "pressure")
    if options["field"] not in shown:
        missing = QUANTITIES[options["field"]][1]
        stress = "run the case with output.stress = true, or choose --field velocity"
        help = stress if options["field"] == "von_mises" else "choose another --field"
        refuse(f"{folder / name} holds no field {missing}, of which {options['field']} is made", help)
    return source


def surfaces(folder, source, options):
    """The records of the contact surfaces, where a view shows them and the run has written them."""
    if source.what == "contact":
        return source
    if options["view"] == "whole" or not (folder / _NAMES["contact"]).is_file():
        return None
    contact = Source(folder, "contact")
    return contact if contact.records.steps and contact.shows("pressure") and np.any(contact.body == BAR) else None


def title(folder) -> str:
    """The title of the case, if there is one."""
    path = folder / _NAMES["case"]
    case = json.loads(_creepage.from_toml(path.read_text("utf-8"))) if path.is_file() else {}
    return case.get("title") or ""


def chosen(source, time):
    """The record nearest to ``time`` (s), or the last."""
    return source.records.steps - 1 if time is None else source.records.nearest(time)


def spread(count, most=None) -> list[int]:
    """At most ``most`` of ``count`` records, evenly spread, with the last and, of several, the first."""
    taken = min(count if most is None else most, count)
    return [i * (count - 1) // (taken - 1) for i in range(taken)] if taken > 1 else [count - 1]


class Parser(argparse.ArgumentParser):
    """Raises what is wrong with the words of a command line."""

    def __init__(self, *words, **options):
        super().__init__(*words, formatter_class=argparse.RawDescriptionHelpFormatter, **options)

    def error(self, message):
        refuse(message, f"for more information, try '{self.prog} --help'")


def parser() -> Parser:
    """The options of the command."""
    made = Parser("creepage render", description=ABOUT, epilog=EPILOG, allow_abbrev=False)
    made.add_argument("run", metavar="RUN", help="folder of a run")
    add = made.add_argument
    add("--json", action="store_true", help="print exactly one JSON document on standard output, everything else on "
        "standard error")  # fmt: skip
    add("--time", metavar="S", help="draw the record nearest to this time (s) [default: the last]; a film shows all")
    add("--field", help="what the colours show: von_mises, velocity or deformation of the bodies, pressure, shear or "
        "slip_velocity of the contact surfaces [default: the first that the run has]")  # fmt: skip
    add("-q", "--quiet", action="store_true", help="say nothing but errors")
    add("-v", "--verbose", action="count", help="say more (-vv still more)")
    add("--what", metavar="fields|contact", help="the bodies (fields) or the contact surfaces (contact) [default: that "
        "which --field is of, or fields]")  # fmt: skip
    add("--view", metavar="whole|contact|both", help="view of the bodies [default: both, side by side]")
    add("--out", metavar="FILE.png|FILE.gif|FILE.mp4", help="the picture, or the film [default: render.png in that "
        "folder, of contact surfaces render-contact.png]")  # fmt: skip
    add("--magnify", metavar="TIMES", help="how many times larger deformation is drawn [default: a round number that "
        "shows it]")  # fmt: skip
    add("--span", metavar="M", help="height of what a view of the contact shows (m) [default: some patches]")
    add("--width", metavar="PIXELS", help="width (pixels) [default: 1600, of a GIF 1000]")
    add("--frames", metavar="N", help="at most so many pictures in a film, evenly spread over the records [default: "
        "all]")  # fmt: skip
    return made


def taken(words) -> list[str] | None:
    """The words after ``render`` where that is the command, with flags that stood before it."""
    return of_command("render", words)


def of_command(name, words) -> list[str] | None:
    """The words after the command ``name`` where that is the command, with flags that stood before it."""
    for place, word in enumerate(words):
        if word == "help" and words[place + 1 : place + 2] == [name]:
            return ["--help"]
        if word == name:
            return [*words[:place], *words[place + 1 :]]
        if not word.startswith("-"):
            break
    return None


def main(words) -> int:
    """``creepage render`` with these words; returns its exit code."""
    try:
        given = vars(parser().parse_args(words))
        as_json, quiet = given.pop("json"), given.pop("quiet")
        given.pop("verbose")
        document = render(given.pop("run"), given.pop("out"), **given)
    except (CreepageError, ImportError) as error:
        return failed(error, "--json" in words)
    except KeyboardInterrupt:
        return failed(CaseError("interrupted", code=130), "--json" in words)
    if as_json:
        print(json.dumps(document, indent=2, ensure_ascii=False))
    elif not quiet:
        print(said(document))
    return 0


def failed(error, as_json) -> int:
    """Says what went wrong, and returns the exit code."""
    code = getattr(error, "code", 2)
    message, help = getattr(error, "message", str(error)), getattr(error, "help", None)
    if as_json:
        document = {"error": message, "exit_code": code, "help": help, "others": [], "status": "failed"}
        print(json.dumps(document, indent=2, ensure_ascii=False))
    print(f"  × {message}" + (f"\n  help: {help}" if help else ""), file=sys.stderr)
    return code


def said(document) -> str:
    """The line about a picture or film."""
    times = document["times"]
    when = f"in {len(times)} pictures of {document['records']} records"
    if len(times) == 1:
        when = f"at t = {1e3 * times[0]:.3f} ms"
    magnified = " and ".join(f"× {times:g}" for times in document["magnifications"])
    return f"{document['file']}: {document['label']} {when}, deformation {magnified}"
