"""Progress bars."""

from __future__ import annotations

import json
import sys
import time
import warnings


class Bar:
    """A bar over the share of a run or sweep that is done: tqdm's where it is installed, lines elsewhere."""

    def __init__(self):
        try:
            with warnings.catch_warnings():
                # a notebook without ipywidgets has a bar of text
                warnings.simplefilter("ignore")
                from tqdm.auto import tqdm
        except ImportError:
            self.bar = None
        else:
            form = "{desc} {percentage:3.0f}%|{bar}| {elapsed}, {remaining} left{postfix}"
            self.bar = tqdm(total=1.0, bar_format=form, **self.pace(tqdm))
        self.told = time.monotonic()

    @staticmethod
    def pace(tqdm) -> dict:
        """How often a bar is drawn: where every drawing stays, in a file or an executed notebook, about twenty times."""
        widget = any(kind.__module__ == "tqdm.notebook" for kind in tqdm.__mro__)
        return {} if widget or sys.stderr.isatty() else {"mininterval": 1.0, "miniters": 0.05}

    def __call__(self, progress: dict) -> None:
        if "stage" in progress:
            name, rolls = progress["stage"], progress["stage"] == "roll"
            share = progress["step"] / max(progress["steps"], 1) if rolls else 0.0
            note = f"{1e3 * progress['time']:.3f} ms, N {progress['normal_force'] / 1e3:.1f} kN" if rolls else ""
        else:
            name, share = "sweep", progress["fraction"]
            note = f"{progress['completed']} of {progress['runs']} runs"
        self.show(name, share, note)

    def show(self, name, share, note):
        if self.bar is not None:
            self.bar.set_description_str(name, refresh=False)
            self.bar.set_postfix_str(note, refresh=False)
            self.bar.update(share - self.bar.n)
        elif time.monotonic() - self.told > 5.0:
            self.told = time.monotonic()
            print(f"{name} {100 * share:3.0f} %  {note}", file=sys.stderr, flush=True)

    def close(self):
        if self.bar is not None:
            self.bar.close()


def listener(progress, messages):
    """What hears a command, ``progress`` its progress and ``messages`` its remarks; and its end."""
    bar = Bar() if progress is True else None
    hear = bar or progress

    def listen(kind, told):
        what = json.loads(told)
        if kind == "said":
            messages(what)
        elif hear:
            hear(what)

    return listen, bar.close if bar else lambda: None
