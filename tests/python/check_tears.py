#!/usr/bin/env python3
"""Replays every write of a run and opens each state that a kill could have left, with h5py.

Usage: check_tears.py [--openings FROM:TO] LOG NAME [NAME...]

LOG is what strace saw of a run (Linux):
`strace -f -y -xx -s 16777216 -e trace=pwrite64,write,openat,ftruncate,rename -o LOG creepage run ...`
NAME is a result file such as contact.vtkhdf. States between two system calls are counted apart from
those within one: a kill can end a call between two pages, but only in the time in which the system
copies a page. Ends with 1 where a state between two calls cannot be read. A snapshot takes two openings of its file;
--openings looks at states between two of them alone, since states of a long file take long to read.
"""

import argparse
import re
import sys
import tempfile
from pathlib import Path

import h5py

PAGE = 4096


def events(log, name):
    """The calls on a file: (call, offset or length, data)."""
    code, partial = ("".join(f"\\x{ord(c):02x}" for c in text) for text in (name, ".partial"))
    position = {}
    with open(log, errors="replace") as lines:
        for line in lines:
            match = re.match(r"^\d+ +(\w+)\((.*)$", line)
            if code not in line or not match:
                continue
            call, rest = match.groups()
            if call == "rename":
                yield "rename", 0, b""
                continue
            if call == "openat":
                opened = re.search(r"= (\d+)<", line)
                if opened:
                    position[opened.group(1)] = 0
                if opened and "O_RDWR" in line:
                    yield "open", 0, b""
                continue
            at = re.match(r"(\d+)<([^>]*)>", rest)
            if not at or not at.group(2).endswith((code, code + partial)):
                continue
            if call == "ftruncate":
                yield "cut", int(re.search(r", (\d+)\)", rest).group(1)), b""
                continue
            data = bytes.fromhex(re.search(r'"([^"]*)"', rest).group(1).replace("\\x", ""))
            if call == "pwrite64":
                yield "write", int(re.search(r'", \d+, (\d+)\)', rest).group(1)), data
            else:  # the superblock, at the start
                yield "write", 0, data


def readable(path):
    def visit(group):
        for item in group.values():
            if isinstance(item, h5py.Group):
                visit(item)
            elif len(item):
                item[...]

    try:
        with h5py.File(path, "r", locking=False) as file:
            dict(file.attrs)
            visit(file)
    except Exception as error:
        return repr(error)
    return None


def replay(log, name, path, openings):
    image, live, opened = bytearray(), False, 0
    states, between, within = 0, [], []

    def check(found, what):
        nonlocal states
        if opened not in openings:
            return
        states += 1
        path.write_bytes(image)
        error = readable(path)
        if error:
            found.append((opened, what, error[:100]))

    for call, at, data in events(log, name):
        if call == "rename":
            live = True
        elif call == "open":
            opened += live
        elif call == "cut":
            image = image[:at] + bytearray(max(0, at - len(image)))
            if live:
                check(between, f"cut to {at}")
        else:
            start, end = at, at + len(data)
            while start < end:
                stop = min((start // PAGE + 1) * PAGE, end)
                image.extend(bytes(max(0, stop - len(image))))
                part = data[start - at : stop - at]
                same = image[start:stop] == part
                image[start:stop] = part
                if live and not same:
                    check(between if stop == end else within, f"{len(data)} bytes at {at}, to {stop}")
                start = stop
    print(
        f"{name}: {opened} openings, {states} states; unreadable between calls: {len(between)}, "
        f"within a call: {len(within)}"
    )
    for problem in between[:20] + within[:5]:
        print("  opening %d, %s: %s" % problem)
    return between


def main():
    def span(text):
        first, end = text.split(":")
        return range(int(first), int(end))

    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--openings", type=span, default=range(sys.maxsize), metavar="FROM:TO")
    parser.add_argument("log")
    parser.add_argument("names", nargs="+")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        state = Path(folder) / "state.h5"
        problems = [replay(given.log, name, state, given.openings) for name in given.names]
    return 1 if any(problems) else 0


if __name__ == "__main__":
    sys.exit(main())
