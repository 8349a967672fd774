"""Cases and the options laid over them, as TOML."""

from __future__ import annotations

import ast
import functools
import inspect
import json
import os
import re
import textwrap
from collections.abc import Mapping

from . import _creepage
from ._errors import CaseError


def plain(value):
    """A value as JSON knows it: NumPy's numbers and arrays, paths and tuples made plain."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items() if item is not None}
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "tolist"):  # NumPy
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, (str, bool, int, float)):
        return value
    raise CaseError(f"a value of the type {type(value).__name__} cannot stand in a case: {value!r}")


def toml_value(value) -> str:
    """A value as TOML writes it in a line."""
    if isinstance(value, dict):
        items = ", ".join(f"{json.dumps(key)} = {toml_value(item)}" for key, item in value.items())
        return "{ " + items + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, float):
        return repr(value)  # inf and nan as TOML has them
    # what JSON escapes, TOML's basic strings escape alike; it allows no DEL
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def options(given) -> str:
    """Options of a function, one a line; those that are None or False are left out."""
    lines = ((name, value) for name, value in plain(given).items() if value is not False)
    return "".join(f"{name} = {toml_value(value)}\n" for name, value in lines)


def sets(overrides) -> list[str]:
    """``KEY=VALUE`` for keys that may be dotted or sections."""
    lines = []

    def add(prefix, value):
        if isinstance(value, dict):
            for key, item in value.items():
                add(f"{prefix}.{key}" if prefix else key, item)
        else:
            lines.append(f"{prefix}={toml_value(value)}")

    add("", plain(overrides))
    return lines


def source(case, overrides) -> dict:
    """A case, a file or a dict, and the keys laid over it."""
    over = sets(overrides)
    if isinstance(case, Mapping):
        text = _creepage.toml(json.dumps(plain(unfolded(case))))
        return {"path": f"{case.get('name', 'case')}.toml", "text": text, "sets": over}
    return {"path": os.fspath(case), "sets": over}


def unfolded(case):
    """A case with its dotted keys as sections."""
    tree = {}
    for key, value in case.items():
        *sections, last = str(key).split(".")
        place = tree
        for section in sections:
            place = place.setdefault(section, {})
            if not isinstance(place, dict):
                raise CaseError(f"the case gives {key!r} and {section!r}, which is no section")
        lay_over(place, {last: unfolded(value) if isinstance(value, Mapping) else value})
    return tree


def lay_over(tree, above):
    """Lays a tree of sections over another as ``extends`` does: sections merge key by key, all else is replaced."""
    for key, value in above.items():
        if isinstance(value, dict) and isinstance(tree.get(key), dict):
            lay_over(tree[key], value)
        else:
            tree[key] = value


def law(friction):
    """A callable as a friction law: the keys that record it in the case."""
    complaint = _creepage.check_law(friction)
    if complaint:
        raise CaseError(complaint)
    return {"friction.law": "python", "friction.source": recorded(friction)}


def recorded(function) -> str:
    """Where a function comes from: its source, or its name where there is none, with the arguments of a partial one."""
    if isinstance(function, functools.partial):
        given = [*map(argument, function.args)]
        given += (f"{key}={argument(value)}" for key, value in function.keywords.items())
        return f"functools.partial of {', '.join(given)}:\n{recorded(function.func)}"
    for candidate in (function, type(function)):
        try:
            source = textwrap.dedent(inspect.getsource(candidate)).strip()
        except (OSError, TypeError):
            continue
        return the_lambda(source, function) or source
    name = getattr(function, "__qualname__", type(function).__qualname__)
    return f"{getattr(function, '__module__', '')}.{name} (no source)"


def argument(value) -> str:
    """An argument of a partial function. What Python shows of a function is another in every process."""
    return recorded(value) if callable(value) else repr(value)


def the_lambda(lines, function):
    """A lambda out of the lines in which it stands, so that what is beside it, such as the options of a run,
    is not recorded; None where it is no lambda, or one of several."""
    if getattr(function, "__name__", None) != "<lambda>":
        return None
    found = []
    for start in (match.start() for match in re.finditer(r"\blambda\b", lines)):
        for end in range(len(lines), start, -1):
            try:
                tree = ast.parse(f"({lines[start:end]}\n)", mode="eval").body
            except (SyntaxError, ValueError):
                continue
            if isinstance(tree, ast.Lambda):
                found.append(ast.unparse(tree))
                break
    return found[0] if len(found) == 1 else None
