"""From the project's root: `python crates/python/examples/own_law.py` runs the quick case with a friction law in
Python and draws the pressure along the centre line of the bar."""

import creepage, matplotlib.pyplot as plt, numpy as np

run = creepage.run("cases/quick.toml", out="runs/own-law", force=True, friction=lambda s: 0.32 + 0.18 * np.exp(-6 * s))
bar, line = run.contact.bar, run.contact.bar.line()
plt.plot(1e3 * bar.points[line, 0], 1e-6 * bar["pressure"][-1, line])
plt.xlabel("x (mm)"), plt.ylabel("pressure (MPa)")
plt.savefig("own-law.png")
