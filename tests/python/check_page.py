"""Renders a page of `creepage report` in a headless Chromium and looks at it.

    python tests/python/check_page.py PAGE.html [PICTURE.png]

Fails where the browser's console says anything, where the page asks for an address, or where a
figure has no size or a row of a table is squeezed. Needs the program `chromium` (Debian: apt-get install chromium).
"""

import html
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PROBE = """<script>window.addEventListener('load', () => {
  const sizes = [...document.querySelectorAll('svg')].map(s => s.getBoundingClientRect());
  const empty = sizes.filter(r => r.width < 100 || r.height < 100).length;
  const wide = document.documentElement.scrollWidth > window.innerWidth + 1;
  const tall = [...document.querySelectorAll('tr')].filter(r => r.getBoundingClientRect().height > 300).length;
  parent.document.title = `figures ${sizes.length} empty ${empty} wide ${wide} tall rows ${tall} ` +
    `resources ${performance.getEntriesByType('resource').filter(e => !e.name.startsWith('data:')).length}`;
});</script></body>"""


FRAME = """<!DOCTYPE html><html><head><title>none</title></head><body style="margin:0">
<iframe style="border:0;width:{width}px;height:6900px" srcdoc="{page}"></iframe></body></html>"""


def chromium(*arguments):
    names = ("chromium", "chromium-browser", "google-chrome")
    program = next(filter(None, map(shutil.which, names)), None)
    if program is None:
        sys.exit("chromium is missing: apt-get install chromium")
    command = [program, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
    return subprocess.run([*command, *arguments], capture_output=True, text=True, timeout=120)


def look(page, framed, width):
    """Fails where the page is not as it should be in a window of this width."""
    found = chromium("--enable-logging=stderr", f"--window-size={width + 20},7000", "--dump-dom", framed.as_uri())
    console = [line for line in found.stderr.splitlines() if ":CONSOLE" in line]
    title = re.search(r"<title>(figures [^<]*)</title>", found.stdout)
    report = title.group(1) if title else "the page was not rendered"
    print(f"{width} px: {report}")
    if console or not title or not re.search(r"empty 0 wide false tall rows 0 resources 0$", report):
        sys.exit("\n".join([f"{page} is not as it should be at {width} px", *console]))


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    page = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        # the page in a frame of that width, since Chromium makes no window as narrow as a phone, with a probe that
        # reports what was laid out
        probed = html.escape(page.read_text().replace("</body>", PROBE), quote=True)
        for width in (1400, 390):
            framed = pathlib.Path(folder) / f"{width}.html"
            framed.write_text(FRAME.format(width=width, page=probed))
            look(page, framed, width)
            if len(sys.argv) > 2:
                picture = pathlib.Path(sys.argv[2]).resolve()
                picture = picture.with_stem(f"{picture.stem}-{width}")
                chromium(f"--window-size={width + 20},7000", f"--screenshot={picture}", framed.as_uri())


if __name__ == "__main__":
    main()
