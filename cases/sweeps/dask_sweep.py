#!/usr/bin/env python3
"""Runs the plan of a sweep on a Dask cluster, one task a run.

    creepage sweep cases/sweeps/kt-large.toml --out runs/kt-large --plan runs.sh
    python cases/sweeps/dask_sweep.py runs.sh --scheduler tcp://head:8786
    creepage sweep cases/sweeps/kt-large.toml --out runs/kt-large --collect

Without --scheduler a cluster of --workers processes is started on this machine. Workers must see
the folder of the plan under the path from which this script is started. CREEPAGE names the program
where it is not on the path. Exit code 1 if a run failed. Needs dask.distributed.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

from dask.distributed import Client, LocalCluster, as_completed


def run(line: str, folder: str, program: str | None) -> tuple[int, str]:
    """Runs a line of the plan; the exit code and the end of what it said."""
    environment = dict(os.environ)
    if program:
        environment["CREEPAGE"] = program
    done = subprocess.run(
        ["bash", "-c", line], cwd=folder, env=environment, capture_output=True, text=True
    )
    return done.returncode, done.stderr[-2000:]


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("plan", type=Path, help="file that `creepage sweep --plan` wrote")
    parser.add_argument("--scheduler", help="address of a Dask scheduler")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="local workers")
    options = parser.parse_args()
    lines = options.plan.read_text().splitlines()
    cluster = None
    if options.scheduler:
        client = Client(options.scheduler)
    else:
        # Processes with one thread each: a run has threads of its own.
        cluster = LocalCluster(
            n_workers=options.workers, threads_per_worker=1, dashboard_address=None
        )
        client = Client(cluster)
    program = os.environ.get("CREEPAGE")
    # Impure: the same line must run again where its results were lost. One try: a run that was
    # stopped by its guards would be stopped again.
    futures = client.map(
        run, lines, folder=os.getcwd(), program=program, pure=False, retries=0
    )
    number = {future.key: i + 1 for i, future in enumerate(futures)}
    failed = 0
    for done, future in enumerate(as_completed(futures), start=1):
        code, said = future.result()
        print(f"{done} of {len(lines)}: line {number[future.key]} ended with {code}", flush=True)
        if code != 0:
            failed += 1
            print(said, file=sys.stderr)
    client.close()
    if cluster:
        cluster.close()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
