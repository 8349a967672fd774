"""What notebooks show of an object: a heading and a table."""

from html import escape


def page(heading, columns, rows) -> str:
    """A table under a heading; ``rows`` hold one cell for each of ``columns``."""
    head = "".join(f"<th>{escape(str(column))}</th>" for column in columns)
    body = "".join("<tr>" + "".join(f"<td>{cell(value)}</td>" for value in row) + "</tr>" for row in rows)
    return f"<div><b>{escape(heading)}</b><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"


def cell(value) -> str:
    """A value as a person reads it: numbers with five digits, nothing where there is none."""
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.5g}"
    text = str(value)
    return escape(text if len(text) <= 80 else text[:77] + "...")


def unit(text) -> str:
    """A unit as it stands behind a number: nothing for a ratio."""
    return "" if text in ("1", "-") else text
