#!/usr/bin/env python3
"""Checks the JSON Schema of case files against the project's cases, and against bad ones.

Usage: check_schema.py SCHEMA.json CASES_FOLDER

Ends with 1 where the schema refuses a case of the project, or accepts a bad one.
"""

import json
import sys
import tomllib
from pathlib import Path

from jsonschema import Draft202012Validator

GOOD = """
[load]
normal = 100e3
[drive]
speed = 38.89
creepage = 2.4e-3
[friction]
static = 0.5
"""
BAD = {
    "unknown section": "[wheel]\nradius = 0.46\n",
    "unknown key": "[disk]\nradios = 0.46\n",
    "wrong type": "[disk]\nradius = 'large'\n",
    "below its range": "[disk]\nradius = -0.46\n",
    "at an open end of its range": "[material]\npoisson = 0.5\n",
    "above its range": "[time]\nfactor = 3.0\n",
    "no such word": "[bar]\nends = 'open'\n",
    "no whole number": "[output]\nhistory_interval = 1.5\n",
    "no crown": "[bar]\ncrown_radius = 'round'\n",
    "no stiffness": "[contact.penalty]\nnormal = { soft = 1.0 }\n",
    "window without end": "[[output.window]]\nfrom = 0.0\n",
}


def main():
    schema = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    failures = 0
    cases = sorted(Path(sys.argv[2]).rglob("*.toml"))
    for case in cases:
        table = tomllib.loads(case.read_text(encoding="utf-8"))
        if "axis" in table:  # a sweep file, whose base is among the cases
            continue
        for error in validator.iter_errors(table):
            failures += 1
            print(f"{case}: {error.json_path}: {error.message}")
    if not validator.is_valid(tomllib.loads(GOOD)):
        failures += 1
        print("the shortest case is refused")
    bad = {name: GOOD + text for name, text in BAD.items()}
    bad["nothing at all"] = ""
    bad["no load"] = GOOD.replace("normal = 100e3", "")
    for name, text in bad.items():
        if validator.is_valid(tomllib.loads(text)):
            failures += 1
            print(f"accepted though it is bad: {name}")
    print(f"{len(cases)} cases and {len(bad)} bad ones: {failures} failures")
    sys.exit(1 if failures or not cases else 0)


if __name__ == "__main__":
    main()
