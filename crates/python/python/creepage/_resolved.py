"""A case as resolved: every default written out."""

from __future__ import annotations

import functools
import json

from . import _creepage, _html


class Case(dict):
    """The keys of a case, in sections; a notebook shows them with their units."""

    @property
    def units(self) -> dict:
        """Units of the keys that have one, by their dotted names."""
        return {key: known_units()[key] for key, _ in flat(self) if key in known_units()}

    def _repr_html_(self):
        units = known_units()
        rows = [(key, value, _html.unit(units.get(key, ""))) for key, value in flat(self)]
        return _html.page(f"case {self.get('name', '')}", ("key", "value", "unit"), rows)


def flat(table, prefix=""):
    """The keys of a table and of the sections in it, dotted, with their values."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from flat(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


@functools.cache
def known_units() -> dict:
    """Units of all keys of a case by their dotted names, as the schema has them."""
    return dict(_units(json.loads(_creepage.schema()), ""))


def _units(schema, prefix):
    for choice in [schema, *schema.get("anyOf", [])]:
        for name, inner in choice.get("properties", {}).items():
            if "x-unit" in inner:
                yield prefix + name, inner["x-unit"]
            yield from _units(inner, f"{prefix}{name}.")
