"""A Python function as the friction law."""

from functools import partial

import creepage
import numpy as np
import pytest

from conftest import SHORT, SMALL
from creepage._case import recorded
from test_run import assert_same_bits


def steady(mu, s, shape):
    return mu * shape(0 * s)


def falling(s):
    return 0.2 + 0.1 * np.exp(-6 * s)


def test_a_constant_law_has_the_bits_of_coulomb(small, tmp_path):
    run = creepage.run(SMALL, tmp_path / "run", friction=lambda s: np.full_like(s, 0.3), **SHORT)
    assert_same_bits(small.path, run.path)
    assert run.case["friction"]["source"] == "lambda s: np.full_like(s, 0.3)"


@pytest.mark.parametrize(
    "more",
    [{}, {"friction.memory": {"distance": 1e-6}}, {"contact.enforcement": "exact"}],
    ids=["penalty", "memory", "exact"],
)
def test_a_falling_law_is_the_built_in_one_up_to_the_rounding_of_exp(tmp_path, more):
    built = {"friction.law": "exponential", "friction.static": 0.3, "friction.dynamic": 0.2}
    a = creepage.run(SMALL, tmp_path / "a", **SHORT, **built, **more)
    b = creepage.run(SMALL, tmp_path / "b", friction=falling, threads=2, **SHORT, **more)
    for name in ("mu", "shear", "slip"):
        ours, theirs = a.contact[name][:], b.contact[name][:]
        # where all nodes stick, slip is round-off, far below that of a coordinate (m)
        least = 1e-17 if name == "slip" else 0.0
        assert np.abs(ours - theirs).max() <= 1e-9 * np.abs(ours).max() + least, name


def test_a_law_at_the_same_instant_is_asked_at_every_trial(tmp_path):
    short = {**SHORT, "time.roll": 0.1e-3}
    exact = {"contact.enforcement": "exact", "friction.mode": "exact"}
    built = {"friction.law": "exponential", "friction.static": 0.3, "friction.dynamic": 0.2}
    a = creepage.run(SMALL, tmp_path / "a", **short, **built, **exact)
    b = creepage.run(SMALL, tmp_path / "b", friction=falling, **short, **exact)
    ours, theirs = a.contact["shear"][:], b.contact["shear"][:]
    # its slope is by difference
    assert np.abs(ours - theirs).max() <= 1e-6 * np.abs(ours).max()


def test_a_check_judges_a_run_by_its_own_law(tmp_path):
    run = creepage.run(SMALL, tmp_path / "run", friction=falling, **SHORT)
    metrics = run.check()["metrics"]
    assert metrics["law_error"]["value"] > 0
    assert metrics["mu_error_uncertain"]["pass"], metrics["mu_error_uncertain"]
    # what needs the graph of Eq (8) has no value, and says so where it is asked for
    with pytest.raises(creepage.LimitError, match="law_scatter"):
        run.check(limits={"law_scatter": 1.0}, strict=True)


def test_the_bits_do_not_depend_on_threads(tmp_path):
    a, b = (creepage.run(SMALL, tmp_path / f"{n}", friction=falling, threads=n, **SHORT) for n in (1, 2))
    assert_same_bits(a.path, b.path)


@pytest.mark.parametrize(
    "law, said",
    [
        (lambda s: 0.3, "one coefficient each"),
        (lambda s: np.zeros(3), r"shape \(3,\) for 242 slip velocities"),
        (lambda s: np.zeros((len(s), 1)), r"\(242, 1\)"),
        (lambda s: 0.3 - s, "mu = -.* at the slip velocity"),
        (lambda s: 0.3 / s, "at the slip velocity 0 m/s; it must be finite"),
        (lambda s: np.random.default_rng().random(len(s)), "the same whenever it is asked"),
        (lambda s: 0.3 + 0.1 * s / s.max(), "its own slip velocity alone"),
        ("0.3", "callable"),
    ],
)
def test_what_is_no_law_is_refused_before_anything_runs(tmp_path, law, said):
    with np.errstate(all="ignore"):
        with pytest.raises(creepage.CaseError, match=said):
            creepage.run(SMALL, tmp_path / "run", friction=law, **SHORT)
    assert not (tmp_path / "run").exists()


def test_what_is_recorded_of_a_law_is_the_law_alone():
    def inner(s):
        return 0.3 + 0 * s

    assert recorded(inner) == "def inner(s):\n    return 0.3 + 0 * s"
    laws = dict(one=lambda s: {"a": (0.3, 0)}["a"][0] + 0 * s, force=True)
    assert recorded(laws["one"]) == "lambda s: {'a': (0.3, 0)}['a'][0] + 0 * s"
    assert recorded(Tiring(1)).startswith("class Tiring:")
    assert recorded(np.sqrt) == "numpy.sqrt (no source)"
    scaled = partial(steady, 0.3, shape=np.exp)
    said = "functools.partial of 0.3, shape=numpy.exp (no source):\ndef steady(mu, s, shape):"
    assert recorded(scaled).startswith(said), recorded(scaled)


class Tiring:
    """A law that fails after so many calls."""

    def __init__(self, calls):
        self.calls = calls

    def __call__(self, s):
        self.calls -= 1
        if self.calls < 0:
            raise ArithmeticError("tired")
        return np.full_like(s, 0.3)


def test_an_exception_in_the_law_ends_the_run_with_it_and_leaves_what_was_computed(small, tmp_path):
    with pytest.raises(ArithmeticError, match="tired"):
        creepage.run(SMALL, tmp_path / "run", friction=Tiring(300), **SHORT)
    run = creepage.Run(tmp_path / "run")
    assert run.summary["status"] == "failed"
    assert "friction law failed at step" in run.summary["diagnosis"]
    rows = len(run.history["time"])
    assert 0 < rows < len(small.history["time"])
    assert np.array_equal(run.history["normal_force"], small.history["normal_force"][:rows])


def test_a_law_that_turns_bad_ends_the_run(tmp_path):
    calls = 0

    def law(s):
        nonlocal calls
        calls += 1
        return np.full_like(s, 0.3 if calls < 200 else np.nan)

    with pytest.raises(ValueError, match="mu = NaN"):
        creepage.run(SMALL, tmp_path / "run", friction=law, **SHORT)


def test_a_run_goes_on_with_its_law_alone(tmp_path):
    out = tmp_path / "run"

    def enough(told):
        if told["stage"] == "roll" and told["step"] > 100:
            raise LookupError

    with pytest.raises(LookupError):
        creepage.run(SMALL, out, friction=falling, progress=enough, **SHORT)
    with pytest.raises(creepage.CaseError, match="needs the function of its friction law"):
        creepage.run(out / "case.toml", out, resume=True)
    with pytest.raises(creepage.CaseError, match="friction.source differs"):
        creepage.run(SMALL, out, friction=lambda s: 0.2 + 0 * s, resume=True, **SHORT)
    run = creepage.run(SMALL, out, friction=falling, resume=True, **SHORT)
    whole = creepage.run(SMALL, tmp_path / "whole", friction=falling, **SHORT)
    assert_same_bits(run.path, whole.path)
    assert "def falling(s):" in run.case["friction"]["source"]
