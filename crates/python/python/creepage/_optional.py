"""Packages that only some functions need."""

import importlib


def optional(package, extra=None, project=None):
    """The imported package; where it is missing the error names the extra that installs it, and its project."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        extra = extra or package
        name = project or package
        text = f'{name} is needed for this: pip install "creepage[{extra}]", or pip install {name}'
        raise ImportError(text, name=package) from error
