"""Files of pictures: PNG, and films as GIF or MP4, each with the mark of this program."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

from . import _creepage
from ._errors import RunError, refuse
from ._optional import optional

# how files of this program begin, and what stands in them near the beginning
KINDS = {
    ".png": ("figure", b"\x89PNG\r\n\x1a\n", b"Software\0Creepage"),
    ".gif": ("film", b"GIF89a", b"Creepage "),
    ".mp4": ("film", b"", b"Creepage "),
}
MARK = f"Creepage {_creepage.__version__}"
HEAD = 64 << 10
# pictures in a second
RATE = 10
INSTALL = "install imageio-ffmpeg or ffmpeg with libx264, or write a film whose name ends in .gif"


def kind(path: Path) -> str:
    """The ending of the file's name, in lower case."""
    ending = path.suffix.lower()
    if ending not in KINDS:
        problem = f"--out {path}: the name of a picture must end in .png, .gif or .mp4"
        refuse(problem, ".png is one picture, .gif and .mp4 are films")
    return ending


def check(path: Path):
    """Refuses a file that cannot be written, or that is there and not of this program."""
    ending = kind(path)
    what, start, mark = KINDS[ending]
    if not path.parent.is_dir():
        problem = f"--out {path}: cannot write the {what}: there is no folder {path.parent}"
        refuse(problem, "make it, or choose a file in a folder that is there")
    if path.exists():
        if not path.is_file():
            refuse(f"--out {path}: is a {'folder' if path.is_dir() else 'device'}, not a file", "choose another file")
        with path.open("rb") as file:
            head = file.read(HEAD)
        if head and not (head.startswith(start) and mark in head):
            problem = f"--out {path}: is there already, and is not a {what} that this program wrote"
            refuse(problem, "choose another name, or move that file away")
    if ending == ".mp4":
        encoder(path)


def encoder(path: Path) -> str:
    """The program ffmpeg: that on PATH, or the one that comes with imageio-ffmpeg."""
    found = shutil.which("ffmpeg")
    if found is None:
        try:
            return optional("imageio_ffmpeg", "render").get_ffmpeg_exe()
        except (ImportError, RuntimeError):
            problem = f"--out {path}: .mp4 is written by the program ffmpeg, which is not on the path"
            refuse(problem, f"pip install 'creepage[render]', or {INSTALL}")
    return found


def write(path: Path, pictures):
    """Writes pictures, arrays of the shape (height, width, 3), into a file that gets its name once it is whole."""
    partial = path.with_name(f".{os.getpid()}.partial.{path.name}")
    writers = {".png": write_png, ".gif": write_gif, ".mp4": write_mp4}
    try:
        writers[kind(path)](partial, pictures)
        partial.replace(path)
    except OSError as error:
        problem = f"cannot write {path}: {error}"
        raise RunError(problem, message=problem, help="check that the disk has room") from error
    finally:
        partial.unlink(missing_ok=True)


def write_png(path, pictures):
    """Writes one picture."""
    optional("PIL.Image", "render")
    info = optional("PIL.PngImagePlugin", "render").PngInfo()
    info.add_text("Software", MARK)
    (picture,) = pictures
    image(picture).save(path, "PNG", pnginfo=info)


def write_gif(path, pictures):
    """Writes a film with the 256 colours of each picture."""
    frames = (image(picture).quantize(256, method=2, dither=0) for picture in pictures)
    next(frames).save(
        path, "GIF", save_all=True, append_images=frames, duration=1000 // RATE, loop=0, comment=MARK.encode()
    )


def write_mp4(path, pictures):
    """Writes a film in all colours by ffmpeg."""
    process = None
    try:
        for picture in pictures:
            process = process or encoding(path, picture)
            process.stdin.write(picture.tobytes())
    except BrokenPipeError:  # what ffmpeg says tells more
        pass
    finally:
        _, said = process.communicate() if process else (b"", b"")
    if process.returncode:
        last = said.decode(errors="replace").strip().splitlines()
        refuse(f"--out {path}: ffmpeg failed: {last[-1] if last else process.returncode}", INSTALL)


def encoding(path, picture):
    """Starts ffmpeg for pictures of the size of this one."""
    height, width = picture.shape[:2]
    raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(RATE), "-i", "-"]
    coded = ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "18", "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2"]
    marked = ["-metadata", f"comment={MARK}", "-movflags", "+faststart", "-f", "mp4"]
    words = [encoder(path), "-loglevel", "error", "-y", *raw, *coded, *marked, os.fspath(path)]
    return subprocess.Popen(words, stdin=subprocess.PIPE, stderr=subprocess.PIPE)


def image(picture):
    """A picture for Pillow."""
    return optional("PIL.Image", "render").fromarray(picture)
