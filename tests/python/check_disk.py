"""What a run does on a full disk and on one that may not be written to, with real (small) file systems.

    python tests/python/check_disk.py target/release/creepage .

Mounts a tmpfs of several sizes in turn, which needs root; where mounting is refused it says so and ends with 0.
Ends with 1 where the exit code or the message is wrong, or where h5py cannot read every file, complete
steps only.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

MEGABYTES = [2, 3, 5, 8, 13, 21, 34]
BUSY = ["output.contact_interval=2e-7", "output.history_interval=1"]


def mount(place, options):
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", options, "creepage", str(place)],
                          capture_output=True, text=True)
    return done.returncode == 0, done.stderr.strip()


def run(program, case, out, *more):
    sets = [word for key in BUSY for word in ("--set", key)]
    return subprocess.run([program, "run", case, "--quiet", "--threads", "1", "--out", out, *sets, *more],
                          capture_output=True, text=True)


def need(fine, problem):
    if not fine:
        sys.exit(f"error: {problem}")


def steps(path):
    """How many steps a file holds, every number of them read."""
    with h5py.File(path) as file:
        if "VTKHDF" not in file:
            data = [d for d in file.values() if isinstance(d, h5py.Dataset)]
            if path.name.startswith("checkpoint"):
                return 1
            lengths = {len(d[...]) for d in data}
            need(len(lengths) == 1, f"{path}: columns of {lengths} rows")
            return lengths.pop()
        grid = file["VTKHDF"]
        count = int(grid["Steps"].attrs["NSteps"])
        need(len(grid["Steps/Values"][...]) == count, f"{path}: {count} steps, other times")
        for kind, rows in (("PointData", "NumberOfPoints"), ("CellData", "NumberOfCells")):
            rows = int(grid[rows][0])
            for name, data in grid[kind].items():
                found = len(data[...])
                need(found in (rows, count * rows), f"{path}: {name} has {found} rows, {count} steps")
        return count


def main():
    program, root = sys.argv[1:]
    case = str(Path(root, "tests/small.toml"))
    with tempfile.TemporaryDirectory() as place:
        for size in MEGABYTES:
            mounted, why = mount(place, f"size={size}m")
            if not mounted:
                print(f"skipped: no file system can be mounted here: {why}")
                return
            try:
                out = Path(place, "run")
                done = run(program, case, str(out))
                need(done.returncode == 3, f"{size} MB: exit code {done.returncode}\n{done.stderr}")
                for words in ("No space left", "0.0 MB are free", "--resume"):
                    need(words in done.stderr, f"{size} MB: {words!r} is not in\n{done.stderr}")
                files = sorted(p for p in out.iterdir() if p.suffix in (".h5", ".vtkhdf"))
                held = {path.name: steps(path) for path in files}
                need(not (out / "summary.json").exists(), f"{size} MB: there is a summary")
                print(f"{size} MB: {done.stderr.split('free there')[0].split('×')[-1].strip()}")
                print(f"    {held}")
                subprocess.run(["mount", "-o", "remount,ro", place], check=True)
                for more in ("--resume", "--force"):
                    done = run(program, case, str(out), more)
                    need(done.returncode == 2, f"read-only, {more}: exit code {done.returncode}")
                    need("is not writable" in done.stderr, done.stderr)
                done = run(program, case, str(Path(place, "other")))
                need(done.returncode == 2 and "is not writable" in done.stderr, done.stderr)
            finally:
                subprocess.run(["umount", place], check=True)
    print("full and read-only disks: every run ended as it should, every file is readable")


main()
