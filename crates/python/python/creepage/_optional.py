"""Packages that only some functions need."""

import importlib


def optional(package, extra=None):
    """The imported package; where it is missing the error names the extra that installs it."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        extra = extra or package
        text = f'{package} is needed for this: pip install "creepage[{extra}]", or pip install {package}'
        raise ImportError(text, name=package) from error
