"""Runs notebooks in their folder; one that fails or warns is refused. ``--keep`` writes what they print and draw into them.

    python tests/python/notebooks.py [--keep] NOTEBOOK.ipynb...

With CREEPAGE_SAMPLE=K/N in the environment every Nth of them from the Kth on, counted round.
"""

import os
import sys
from pathlib import Path

import nbclient
import nbformat

# Pictures make a notebook large, and every version of it stays in the repository.
LARGEST = 250_000  # bytes


def run(path: Path):
    """The notebook after a run."""
    notebook = nbformat.read(path, as_version=4)
    # times would change the file with every run
    client = nbclient.NotebookClient(
        notebook, record_timing=False, coalesce_streams=True, resources={"metadata": {"path": path.parent}}
    )
    return client.execute()


def refuse_warnings(path: Path, notebook):
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            if output.get("name") == "stderr":
                sys.exit(f"{path}: a cell prints a warning:\n{output.text}\n{cell.source}")


keep, files = "--keep" in sys.argv, [Path(word).resolve() for word in sys.argv[1:] if word != "--keep"]
first, step = map(int, os.environ.get("CREEPAGE_SAMPLE", "0/1").split("/"))
for path in files[first % max(len(files), 1) :: step]:
    kept = nbformat.read(path, as_version=4)
    if not keep and not all(cell.execution_count for cell in kept.cells if cell.cell_type == "code"):
        sys.exit(f"{path}: a cell is without its outputs: --keep writes them")
    notebook = run(path)
    refuse_warnings(path, notebook)
    if keep:
        notebook.metadata.pop("language_info", None)  # the version of this Python
        nbformat.write(notebook, path)
    if path.stat().st_size > LARGEST:
        sys.exit(f"{path}: {path.stat().st_size} bytes, more than {LARGEST}: draw smaller pictures")
    print(f"{path.name}: no warning, {path.stat().st_size} bytes")
