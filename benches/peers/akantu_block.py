"""A free block of hexahedra in Akantu and in Creepage: the same problem, side by side.

    python -m venv peers && peers/bin/pip install akantu numpy
    peers/bin/python benches/peers/akantu_block.py [--n 40] [--creepage target/release/creepage]

n^3 hexahedra of 1 mm, steel, all faces free, row-sum mass, start velocity v_z = -z/L, steps of 0.1 us, one thread
each. After 20 steps both print u_z of the corner (L, L, L), which must agree to 1e-4 (Akantu's strain
is small, Creepage's finite, and there are strains of 1e-4); then steps are timed, the median of seven samples. Akantu's element has eight points;
Creepage's is timed with eight and with one, which it rolls with.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

os.environ["OMP_NUM_THREADS"] = "1"

import akantu as aka  # noqa: E402
import numpy as np  # noqa: E402

EDGE, STEP, COMPARED, SAMPLES = 1e-3, 1e-7, 20, 7
MATERIAL = "material elastic [\n name = steel\n rho = 7800\n E = 210e9\n nu = 0.3\n]\n"


def akantu_block(n):
    """The model of the block, and its number of elements."""
    with tempfile.NamedTemporaryFile("w", suffix=".dat") as file:
        file.write(MATERIAL)
        file.flush()
        aka.parseInput(file.name)
    mesh = aka.Mesh(3)
    accessor = aka.MeshAccessor(mesh)
    m = n + 1
    k, j, i = np.meshgrid(range(m), range(m), range(m), indexing="ij")
    accessor.resizeNodes(m**3)
    mesh.getNodes()[:] = EDGE * np.stack([i.ravel(), j.ravel(), k.ravel()], 1)
    mesh.addConnectivityType(aka._hexahedron_8)
    accessor.resizeConnectivity(n**3, aka._hexahedron_8)
    k, j, i = np.meshgrid(range(n), range(n), range(n), indexing="ij")
    first = (i + m * (j + m * k)).ravel()
    layer = [0, 1, 1 + m, m]
    corners = [first + c for c in layer] + [first + c + m * m for c in layer]
    mesh.getConnectivity(aka._hexahedron_8)[:] = np.stack(corners, 1)
    accessor.makeReady()
    model = aka.SolidMechanicsModel(mesh)
    model.initFull(aka._explicit_lumped_mass)
    model.setTimeStep(STEP)
    model.getVelocity()[:, 2] = -mesh.getNodes()[:, 2] / (n * EDGE)
    return mesh, model


def akantu_speed(n):
    """u_z of the corner after the compared steps (m), and nanoseconds per element and step."""
    mesh, model = akantu_block(n)
    for _ in range(COMPARED):
        model.solveStep()
    corner = float(model.getDisplacement()[-1, 2])
    repeats = max(1, 100_000 // n**3)

    def sample():
        begin = time.perf_counter()
        for _ in range(repeats):
            model.solveStep()
        return (time.perf_counter() - begin) / repeats / n**3 * 1e9

    return corner, statistics.median(sample() for _ in range(SAMPLES))


def creepage_speed(binary, n, element):
    command = [binary, "bench", "--block", str(n), "--element", element, "--threads", "1", "--json"]
    found = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return found["corner_after_20_steps"], found["step_ns_per_element"]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--n", type=int, default=40)
    parser.add_argument("--creepage", default="target/release/creepage")
    options = parser.parse_args()
    corner, peer = akantu_speed(options.n)
    print(f"Akantu, eight points: u_z {corner:.6e} m, {peer:.0f} ns per element and step")
    for element in ("full", "one-point"):
        own_corner, own = creepage_speed(options.creepage, options.n, element)
        print(
            f"Creepage, {element}: u_z {own_corner:.6e} m, {own:.1f} ns per element and step:"
            f" {peer / own:.0f} times as fast"
        )
        if element == "full" and abs(own_corner / corner - 1) > 1e-4:
            sys.exit("the corners disagree: this is not the same problem")


if __name__ == "__main__":
    main()
