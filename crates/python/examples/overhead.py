"""What a friction law in Python costs: processor time of the quick case with Eq (8) built in and as a function.

From the project's root: `python crates/python/examples/overhead.py [ROUNDS]`; of three rounds the best counts.
"""

import sys
import tempfile
import time
from pathlib import Path

import creepage
import numpy as np

BUILT_IN = {"law": "exponential", "static": 0.5, "dynamic": 0.32, "decay": 6.0}


class Counted:
    """Eq (8), which counts its calls and the time in them."""

    calls, nodes, seconds = 0, 0, 0.0

    def __call__(self, s):
        begun = time.perf_counter()
        mu = 0.32 + 0.18 * np.exp(-6 * s)
        self.seconds += time.perf_counter() - begun
        self.calls, self.nodes = self.calls + 1, self.nodes + len(s)
        return mu


def plain(s):
    return 0.32 + 0.18 * np.exp(-6 * s)


def measured(friction):
    with tempfile.TemporaryDirectory() as folder:
        begun = time.process_time()
        run = creepage.run("cases/quick.toml", Path(folder) / "run", threads=1, friction=friction)
        return time.process_time() - begun, run.summary


rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
counted = Counted()
measured(counted)
best = {}
for _ in range(rounds):
    for name, law in (("built in", BUILT_IN), ("Python", plain)):
        seconds, summary = measured(law)
        best[name] = min(best.get(name, (seconds, summary)), (seconds, summary), key=lambda x: x[0])
for name, (seconds, summary) in best.items():
    print(f"{name:<9}{seconds:7.2f} s of processor time, {summary['stages']['contact']:6.2f} s in contact")
# the law is asked within contact alone, whose time varies less from run to run than that of all else
seconds = {name: summary["stages"]["contact"] for name, (_, summary) in best.items()}
extra = seconds["Python"] - seconds["built in"]
print(f"{100 * extra / best['built in'][0]:.1f} % more: {1e6 * extra / counted.calls:.1f} us a call")
print(f"{counted.calls} calls for {counted.nodes / counted.calls:.0f} nodes each; {counted.seconds:.2f} s in the function")
