"""Pictures and films of a run."""

import json
import os
import shutil
import subprocess
import sys

import creepage
import h5py
import numpy as np
import pytest
from creepage import _frames, _render_command

WITHOUT_PYVISTA = """
import sys
sys.modules["pyvista"] = None
from creepage.__main__ import main
main()
"""


@pytest.fixture
def copy(small, tmp_path):
    """A copy of the run, to be spoilt."""
    return creepage.Run(shutil.copytree(small.path, tmp_path / "copy"))


def pixels(path):
    """The picture as an array of the shape (height, width, 3)."""
    image = pytest.importorskip("PIL.Image")
    with image.open(path) as opened:
        return np.asarray(opened.convert("RGB")).astype(int)


def red(picture):
    """Share of the pixels with the colour of high pressure, above the colour bars."""
    r, g, b = np.moveaxis(picture[: int(0.85 * len(picture))], 2, 0)
    return np.mean((r > 180) & (g < 80) & (b < 80))


def refused(capsys, *words):
    """What the command says when it ends with the code of bad input."""
    assert _render_command.main([str(word) for word in words]) == 2
    said = capsys.readouterr()
    assert not said.out
    return said.err


def test_a_picture_shows_the_patch_and_is_as_wide_as_asked(small, copy, tmp_path):
    pytest.importorskip("pyvista")
    picture = pixels(small.render(tmp_path / "run.png", width=500))
    assert picture.shape[1] == 500
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 1000
    assert red(picture) > 2e-3
    (copy.path / "contact.vtkhdf").unlink()
    assert red(pixels(copy.render(tmp_path / "bodies.png", width=500))) == 0.0


def test_each_field_is_drawn_where_it_is_asked_for(small, tmp_path):
    pytest.importorskip("pyvista")
    asked = {"velocity": {"view": "whole"}, "deformation": {"view": "contact", "magnify": 0.0}}
    asked |= {"pressure": {"time": 5e-6}, "slip_velocity": {"span": 5e-3}}
    for field, options in asked.items():
        out = tmp_path / f"{field}.png"
        document = _render_command.render(small.path, out, field=field, width=300, **options)
        assert document["field"] == field and document["file"] == str(out)
        assert len(np.unique(pixels(out).reshape(-1, 3), axis=0)) > 200, field
    assert small.render(what="contact", width=200) == small.path / "render-contact.png"


def test_a_film_has_as_many_pictures_as_asked(small, tmp_path):
    pytest.importorskip("pyvista")
    image = pytest.importorskip("PIL.Image")
    film = small.render(tmp_path / "film.gif", frames=3, width=300)
    with image.open(film) as opened:
        assert opened.n_frames == 3 and opened.size[0] == 300
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    film = small.render(tmp_path / "film.mp4", frames=4, width=300)
    assert ffmpeg.count_frames_and_secs(str(film))[0] == 4
    # its own file may be replaced
    assert small.render(film, frames=2, width=300) == film


def test_the_pictures_of_a_film_show_different_records(small):
    pytest.importorskip("pyvista")
    from creepage._render import Scene

    source = _frames.Source(small.path, "fields")
    scene = Scene(source, None, {"field": "velocity", "view": "whole", "magnify": 1.0, "span": None, "width": 300}, "")
    scene.scale_to([0, source.records.steps - 1])
    first, last = (scene.picture(record) for record in (0, source.records.steps - 1))
    scene.close()
    body = slice(int(0.2 * len(first)), int(0.8 * len(first)))
    assert np.any(first[body] != last[body])


def test_the_command_prints_a_line_or_a_document(small, tmp_path, capsys):
    pytest.importorskip("pyvista")
    words = [str(small.path), "--width", "300", "--out", str(tmp_path / "a.png")]
    assert _render_command.main(words) == 0
    said = capsys.readouterr()
    assert said.out.startswith(f"{tmp_path / 'a.png'}: von Mises stress (MPa) at t = 0.0") and not said.err
    words = [sys.executable, "-m", "creepage", "render", *words, "--json"]
    environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    done = subprocess.run(words, capture_output=True, text=True, encoding="utf-8", env=environment)
    assert done.returncode == 0 and done.stderr == ""
    document = json.loads(done.stdout)
    assert document["times"] == [small.fields.times[-1]] and document["records"] == small.fields.steps
    assert document["label"] == "von Mises stress (MPa)" and len(document["magnifications"]) == 2


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["--field", "temperature"], "one of von_mises, velocity, deformation"),
        (["--view", "wide"], "both, whole or contact is needed"),
        (["--width", "1"], "a whole number of pixels from 200 to 8000 is needed"),
        (["--width", "3e2"], "a whole number of pixels from 200 to 8000 is needed"),
        (["--magnify", "nan"], "a number of at least 0 is needed"),
        (["--span", "0"], "a number greater than 0 is needed"),
        (["--frames", "0", "--out", "a.gif"], "a whole number from 1 to 100000 is needed"),
        (["--frames", "3"], "--frames cannot be used with a picture"),
        (["--time", "0", "--out", "a.gif"], "--time cannot be used with a film"),
        (["--what", "contact", "--field", "velocity"], "--what contact does not have it\n  help: it has pressure"),
        (["--field", "pressure", "--view", "whole"], "--view cannot be used with contact surfaces"),
        (["--out", "a.avi"], "must end in .png, .gif or .mp4"),
        (["--out", "no-such-folder/a.png"], "there is no folder no-such-folder"),
        (["--colour"], "unrecognized arguments: --colour"),
    ],
)
def test_bad_options_are_refused(small, capsys, monkeypatch, tmp_path, words, line):
    monkeypatch.chdir(tmp_path)
    assert line in refused(capsys, small.path, *words)
    assert not any(tmp_path.glob("*.*"))


def test_a_file_of_another_program_is_not_written_over(small, capsys, tmp_path):
    theirs = tmp_path / "theirs.png"
    theirs.write_bytes(b"\x89PNG\r\n\x1a\n of a camera")
    assert "is not a figure that this program wrote" in refused(capsys, small.path, "--out", theirs)
    assert theirs.read_bytes().endswith(b"of a camera")


def test_what_cannot_be_drawn_is_refused_with_a_remedy(copy, capsys, tmp_path):
    assert "there is no such file or folder" in refused(capsys, tmp_path / "nothing")
    assert "is a case or a sweep, and no run" in refused(capsys, copy.path / "case.toml")
    with h5py.File(copy.path / "fields.vtkhdf", "r+") as file:
        del file["VTKHDF/CellData/von_mises"]
    assert _render_command.main([str(copy.path), "--width", "300", "--out", str(tmp_path / "tensor.png")]) == 0
    capsys.readouterr()
    with h5py.File(copy.path / "fields.vtkhdf", "r+") as file:
        del file["VTKHDF/CellData/stress"]
    assert "holds no field stress" in (said := refused(capsys, copy.path, "--field", "von_mises"))
    assert "help: run the case with output.stress = true" in said
    with h5py.File(copy.path / "fields.vtkhdf", "r+") as file:
        file["VTKHDF/PointData/velocity"][...] = np.nan
    assert "velocity is not a number at node 0" in refused(capsys, copy.path, "--out", tmp_path / "a.png")
    with h5py.File(copy.path / "fields.vtkhdf", "r+") as file:
        file["VTKHDF/Steps"].attrs["NSteps"] = 0
        file["VTKHDF/Steps/Values"].resize(0, axis=0)
    assert "holds no record yet\n  help: wait until the run rolls" in refused(capsys, copy.path)
    (copy.path / "fields.vtkhdf").write_bytes(b"nothing")
    assert "help: copy it again" in refused(capsys, copy.path)
    (copy.path / "fields.vtkhdf").unlink()
    assert "holds no fields.vtkhdf\n  help: give the folder of a run" in refused(capsys, copy.path)
    assert not (tmp_path / "a.png").exists()


def test_a_refusal_is_a_document_too(small, capsys):
    assert _render_command.main([str(small.path), "--width", "1", "--json"]) == 2
    document = json.loads(capsys.readouterr().out)
    assert document["exit_code"] == 2 and document["status"] == "failed" and "--width" in document["error"]


def test_without_pyvista_a_line_says_what_to_install(small, monkeypatch, tmp_path):
    words = [sys.executable, "-c", WITHOUT_PYVISTA, "render", small.path, "--out", tmp_path / "a.png"]
    done = subprocess.run(words, capture_output=True, text=True, encoding="utf-8")
    assert done.returncode == 2 and 'pip install "creepage[render]"' in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match=r"creepage\[render\]"):
        small.render(tmp_path / "a.png")


def test_without_ffmpeg_a_film_as_gif_is_advised(small, capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", "")
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    said = refused(capsys, small.path, "--out", tmp_path / "film.mp4")
    assert "ffmpeg, which is not on the path" in said and "ends in .gif" in said


def test_a_wheel_that_only_rolled_has_no_deformation():
    angles = np.arange(24) * 0.2618
    ring = np.column_stack([np.cos(angles), 0.1 * angles, np.sin(angles)])
    wheel = np.vstack([r * ring for r in (0.1, 0.46)]) + (0.0, 0.0, 0.46)
    turn = -3.0 / 0.46
    x, z = wheel[:, 0], wheel[:, 2] - 0.46
    after = np.column_stack(
        [np.cos(turn) * x - np.sin(turn) * z + 3.0, wheel[:, 1], np.sin(turn) * x + np.cos(turn) * z + 0.46]
    )
    assert np.allclose(_frames.fit(wheel, after)(wheel), after, atol=1e-12)


def test_what_a_zone_that_follows_the_contact_moves_is_no_deformation():
    bar = np.array([3e-6, -2e-6, 1e-6])
    assert _frames.moved_on(bar) == 0.0
    assert _frames.moved_on(bar[:0]) == 0.0
    assert np.allclose(bar + 0.12 - _frames.moved_on(bar + 0.12), bar - np.median(bar), atol=1e-15)


def test_von_mises_of_pull_of_shear_and_of_pressure():
    stress = np.array([[-3.0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 2.0, 0], [7.0, 7.0, 7.0, 0, 0, 0]])
    assert np.allclose(_frames.von_mises(stress), [3.0, np.sqrt(12.0), 0.0])


def test_records_are_spread_from_the_first_to_the_last():
    assert _render_command.spread(5) == [0, 1, 2, 3, 4]
    assert _render_command.spread(41, 3) == [0, 20, 40]
    assert _render_command.spread(4, 1) == [3] and _render_command.spread(1, 9) == [0]
