#!/usr/bin/env python3
"""Kills a writing process at random instants and checks with h5py what it leaves.

Usage: check_kill.py WRITER [--kills N] [--live N] [--pause MS] [--seed S] [--swmr]

WRITER is the example `endless` of the crate creepage-output:
`cargo build --release -p creepage-output --example endless`.
Every number of every counted snapshot is compared with what the writer must have written. Before
each kill the files are also opened and read while they are being written. An opening that meets
the rewriting of a header, or stalls between its first reads, can fail, about one in a thousand at
full speed; a reader then opens again, and so does this one. With --swmr it opens with `swmr=True`, with which libhdf5 itself reads again
what does not match its checksum and does not insist on the end of the file that it saw first.
"""

import argparse
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np


OPENINGS = 20


def value(step, place):
    """The same formula as in the writer."""
    return (step * 7919 + place * 104729) % 1000003 + step * 1048576.0


def read(path, thorough, **mode):
    """Reads the counted steps and rows; raises where something is not as it must be."""
    with h5py.File(path / "strip.vtkhdf", "r", locking=False, **mode) as file:
        grid = file["VTKHDF"]
        steps = int(grid["Steps"].attrs["NSteps"])
        count = {"PointData": int(grid["NumberOfPoints"][0]), "CellData": int(grid["NumberOfCells"][0])}
        if not np.array_equal(grid["Steps/Values"][:steps], np.arange(steps)):
            raise ValueError(f"times of {steps} steps")
        for group, name in (
            ("PointData", "scalar"),
            ("PointData", "vector"),
            ("PointData", "label"),
            ("CellData", "tensor"),
        ):
            data, rows = grid[f"{group}/{name}"], count[group]
            excess = len(data) - steps * rows
            if excess < 0 or (thorough and excess not in (0, rows)):
                raise ValueError(f"{name} has {len(data)} rows, {steps} steps of {rows}")
            for step in range(steps) if thorough else range(max(steps - 1, 0), steps):
                array = data[step * rows : (step + 1) * rows].ravel()
                expected = value(step, np.arange(len(array)))
                if name == "label":
                    expected = expected.astype(np.int64) % 256
                if not np.array_equal(array, expected):
                    raise ValueError(f"{name} differs at step {step} of {steps}")
    with h5py.File(path / "history.h5", "r", locking=False, **mode) as file:
        total = int(file.attrs["rows"])
        for place, name in enumerate(("time", "force", "energy")):
            if not np.array_equal(file[name][:total], value(np.arange(total), place)):
                raise ValueError(f"{name} differs within {total} rows")
    return steps, total


def read_while_written(folder, swmr):
    """Reads, opening again where an opening met a closing; returns the number of openings."""
    for opening in range(1, OPENINGS):
        try:
            read(folder, thorough=False, swmr=swmr)
            return opening
        except (OSError, KeyError, RuntimeError, ValueError):
            time.sleep(0.001)
    read(folder, thorough=False, swmr=swmr)
    return OPENINGS


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("writer", type=Path)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--live", type=int, default=3, help="readings before each kill")
    parser.add_argument("--pause", type=int, default=0, help="of the writer between snapshots (ms)")
    parser.add_argument("--swmr", action="store_true", help="how the written files are opened")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    chance = random.Random(arguments.seed)
    broken, openings, steps_seen = [], [], []
    for kill in range(arguments.kills):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            process = subprocess.Popen([arguments.writer, folder, str(arguments.pause)])
            while not (folder / "history.h5").exists():
                time.sleep(0.001)
            time.sleep(0.02)
            try:
                for _ in range(arguments.live):
                    time.sleep(chance.uniform(0.0, 0.01))
                    openings.append(read_while_written(folder, arguments.swmr))
                time.sleep(chance.uniform(0.0, 0.1))
            finally:
                process.kill()
                process.wait()
            try:
                steps_seen.append(read(folder, thorough=True))
            except Exception as error:
                broken.append(f"{kill}: {error}")
    print(f"after a kill: {len(steps_seen)} of {arguments.kills} whole")
    print(f"(steps, rows) found: {steps_seen[:8]}...")
    first = openings.count(1)
    print(f"while writing: {first} of {len(openings)} readings whole at the first opening,")
    print(f"the others after up to {max(openings, default=0)} openings")
    for message in broken:
        print(f"  {message}")
    sys.exit(1 if broken else 0)


if __name__ == "__main__":
    main()
