#!/usr/bin/env python3
"""Reads every dataset of a run's HDF5 files with h5py and compares them with those of another run.

Usage: check_same.py RUN [REFERENCE]

Ends with 1 where a file cannot be read, where counted records are missing, or, with REFERENCE, where
any dataset or attribute differs in a bit, apart from the attribute `created`.
"""

import sys
from pathlib import Path

import h5py

RESULTS = ("fields.vtkhdf", "contact.vtkhdf", "history.h5", "probes.h5")
CHECKPOINTS = ("checkpoint.h5", "checkpoint-1.h5")


def content(path):
    """All datasets and attributes, as bytes with type and shape."""
    found = {}
    with h5py.File(path, "r", locking=False) as file:

        def visit(name, item):
            for key, value in item.attrs.items():
                if key != "created":
                    found[f"{name}@{key}"] = repr(value)
            if isinstance(item, h5py.Dataset):
                data = item[()]
                found[name] = (str(data.dtype), data.shape, data.tobytes())

        visit("", file)
        file.visititems(visit)
        steps = file.get("VTKHDF/Steps")
        if steps is not None and len(steps["Values"]) < steps.attrs["NSteps"]:
            raise ValueError(f"{path}: fewer times than NSteps")
    return found


def main():
    run = Path(sys.argv[1])
    reference = Path(sys.argv[2]) if len(sys.argv) > 2 else None
    problems = []
    for name in RESULTS + CHECKPOINTS:
        path = run / name
        if not path.exists():
            if reference and name in RESULTS and (reference / name).exists():
                problems.append(f"{name} is missing")
            continue
        try:
            mine = content(path)
        except Exception as error:  # whatever h5py raises is what this looks for
            problems.append(f"{name} cannot be read: {error!r}")
            continue
        if reference:
            theirs = content(reference / name)
            for key in sorted(set(mine) | set(theirs)):
                if mine.get(key) != theirs.get(key):
                    problems.append(f"{name}: {key} differs")
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
