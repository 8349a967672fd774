"""``python -m creepage._through_meshio FILE``: a mesh of any format that meshio reads, as VTU on standard output.

Creepage starts it for ``mesh.file``. It ends with 2 where meshio cannot read the file, with 1 where a package is missing,
and with 130 after Ctrl-C; why is the last line on standard error.
"""

import sys
import tempfile
from pathlib import Path

from . import _mesh
from ._errors import CaseError
from ._optional import optional


def main(path) -> int:
    """Writes the mesh of a file to standard output and returns the exit code."""
    try:
        meshio = optional("meshio", "mesh")
        mesh = _mesh.read(meshio, path)
        nodes, cells = _mesh.named(mesh)
        made = _mesh.with_arrays(meshio, mesh, range(len(mesh.cells)), nodes, cells)
        with tempfile.TemporaryDirectory() as folder:
            vtu = Path(folder, "mesh.vtu")  # meshio writes no VTU to a stream
            meshio.vtu.write(vtu, made, compression=None)
            sys.stdout.buffer.write(vtu.read_bytes())
    except ImportError as missing:
        print(missing, file=sys.stderr)
        return 1
    except CaseError as refused:
        print(str(refused).removeprefix(f"{path}: "), file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
