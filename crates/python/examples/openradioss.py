"""A keyword file of `creepage export-k` for OpenRadioss: deck.k, and two engine files in place of the starter's.

    python openradioss.py DECK.k FOLDER [INTERVAL]

INTERVAL (s) is that of the records, by default the deck's of `*DATABASE_BINARY_INTFOR`.

OpenRadioss passes over `*INITIAL_VELOCITY_GENERATION_START_TIME`; the second engine file gives the velocity instead. Its damping
relative to a rigid body slows the disk's rotation down: it is left out, so that the case should be exported with
`--set damping.mass=0`. Units of the deck: mm-ton-s.
"""

import re
import sys
from pathlib import Path

# the parts of the disk
DISK = (1, 3)


class Deck:
    """The cards that are needed here."""

    def __init__(self, path):
        text = Path(path).read_text()
        if "$ units: mm-ton-s" not in text:
            sys.exit(f"{path}: export it in mm-ton-s")
        self.cards = re.split(r"(?m)^(?=\*)", text)

    def lines(self, keyword):
        """The data lines of each card of a keyword."""
        for card in self.cards:
            name, *lines = card.splitlines()
            if name == f"*{keyword}":
                yield [line for line in lines if not line.startswith("$")]

    def field(self, keyword, line, i):
        """Field i of a data line of the first card of a keyword."""
        return float(next(self.lines(keyword))[line][10 * i : 10 * i + 10])

    def disk(self):
        """First and last number of the disk's nodes."""
        (lines,) = self.lines("ELEMENT_SOLID")
        rows = (tuple(int(e[i : i + 8]) for i in range(0, 80, 8)) for e in lines)
        nodes = {n for _, part, *corners in rows if part in DISK for n in corners}
        if len(nodes) != max(nodes) - min(nodes) + 1:
            sys.exit("the numbers of the disk's nodes have gaps")
        return min(nodes), max(nodes)


def prepare(path, folder, interval=None):
    deck, folder = Deck(path), Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    left_out = (
        "*INITIAL_VELOCITY_GENERATION",
        "*DAMPING_RELATIVE",
        "*DATABASE_HISTORY",
    )
    kept = [card for card in deck.cards if not card.startswith(left_out)]
    (folder / "deck.k").write_text("".join(kept))
    begins = deck.field("INITIAL_VELOCITY_GENERATION_START_TIME", 0, 0)
    end = deck.field("CONTROL_TERMINATION", 0, 0)
    interval = interval or deck.field("DATABASE_BINARY_INTFOR", 0, 0)
    omega, speed = (deck.field("INITIAL_VELOCITY_GENERATION", 0, i) for i in (2, 3))
    height = deck.field("INITIAL_VELOCITY_GENERATION", 1, 2)
    factor = deck.field("CONTROL_TIMESTEP", 0, 1)
    first, last = deck.disk()
    for run, stop in ((1, begins), (2, end)):
        records = 2 * stop if run == 1 else begins
        text = (
            f"/RUN/deck/{run}/\n{stop!r}\n/TFILE/4\n{interval / 4!r}\n"
            f"/ANIM/DT\n{records!r} {interval!r}\n/ANIM/VECT/DISP\n/ANIM/VECT/VEL\n/ANIM/VECT/CONT\n"
            f"/PRINT/-1000\n/DT\n{factor!r} 0\n/PARITH/OFF\n"
        )
        if run == 2:
            # a turn about the y axis of the origin and a translation: free rolling about the disk's centre
            along = speed - omega * height
            text += f"/INIV/AXIS/Y/1\n0\n{along!r} 0 0 {omega!r}\n{first} {last}\n"
        # the starter writes a deck_0001.rad of its own
        (folder / f"engine_000{run}.rad").write_text(text)


if __name__ == "__main__":
    match sys.argv[1:]:
        case [deck, folder]:
            prepare(deck, folder)
        case [deck, folder, interval]:
            prepare(deck, folder, float(interval))
        case _:
            sys.exit(__doc__)
