"""Renders a page of `creepage report` in a headless Chromium and looks at it.

    python tests/python/check_page.py PAGE.html [PICTURE.png]

Fails where the browser's console says anything, where the page asks for an address, or where a figure has no size or a
row of a table is squeezed; where a scene is drawn empty or is the same at its first and last time, and where without
WebGL its still picture does not stand in for it. Needs the program `chromium` (Debian: apt-get install chromium).
"""

import html
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PROBE = """<script>window.addEventListener('load', async () => {
  // what the canvas of a scene shows, read when it has just been drawn, since it is cleared thereafter
  const pixels = (figure, time) => new Promise(done => {
    figure.addEventListener('drawn', () => {
      const copy = new OffscreenCanvas(400, 240).getContext('2d');
      copy.drawImage(figure.querySelector('canvas'), 0, 0, 400, 240);
      done(new Uint32Array(copy.getImageData(0, 0, 400, 240).data.buffer));
    }, { once: true });
    const slider = figure.querySelector('input.time');
    slider.value = time;
    slider.dispatchEvent(new Event('input'));
  });
  const scenes = [...document.querySelectorAll('figure.scene')];
  let [still, bare, unmoved] = [0, 0, 0];
  for (const figure of scenes) {
    if (figure.dataset.drawn !== 'true') {
      const { width, height } = figure.querySelector('.still').getBoundingClientRect();
      still += width >= 100 && height >= 100;
      continue;
    }
    const last = Number(figure.querySelector('input.time').max);
    const [first, end] = [await pixels(figure, 0), await pixels(figure, last)];
    bare += new Set(end).size < 500;
    unmoved += last > 0 && first.filter((colour, at) => colour !== end[at]).length < 500;
  }
  const drawn = scenes.filter(figure => figure.dataset.drawn === 'true').length;
  const sizes = [...document.querySelectorAll('svg:not(.live .still)')].map(s => s.getBoundingClientRect());
  const empty = sizes.filter(r => r.width < 100 || r.height < 100).length;
  const wide = document.documentElement.scrollWidth > window.innerWidth + 1;
  const tall = [...document.querySelectorAll('tr')].filter(r => r.getBoundingClientRect().height > 300).length;
  parent.document.title = `figures ${sizes.length} scenes ${scenes.length} drawn ${drawn} still ${still} ` +
    `bare ${bare} unmoved ${unmoved} empty ${empty} wide ${wide} tall rows ${tall} ` +
    `resources ${performance.getEntriesByType('resource').filter(e => !e.name.startsWith('data:')).length}`;
});</script></body>"""


FRAME = """<!DOCTYPE html><html><head><title>none</title></head><body style="margin:0">
<iframe style="border:0;width:{width}px;height:6900px" srcdoc="{page}"></iframe></body></html>"""

# WebGL in software: there may be no graphics card
WEBGL = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
NO_WEBGL = ("--disable-gpu", "--disable-3d-apis")


def chromium(*arguments):
    names = ("chromium", "chromium-browser", "google-chrome")
    program = next(filter(None, map(shutil.which, names)), None)
    if program is None:
        sys.exit("chromium is missing: apt-get install chromium")
    # time that passes only while the page has nothing to do: what it has asked for is done before it is looked at
    command = [program, "--headless", "--no-sandbox", "--hide-scrollbars", "--virtual-time-budget=5000"]
    return subprocess.run([*command, *arguments], capture_output=True, text=True, timeout=300)


def look(page, framed, width, graphics):
    """Fails where the page is not as it should be in a window of this width."""
    # a low window, since what it shows is drawn in software at each frame
    window = f"--window-size={width + 20},900"
    found = chromium(*graphics, "--enable-logging=stderr", window, "--dump-dom", framed.as_uri())
    console = [line for line in found.stderr.splitlines() if ":CONSOLE" in line]
    title = re.search(r"<title>(figures [^<]*)</title>", found.stdout)
    report = title.group(1) if title else "the page was not rendered"
    shown = "with WebGL" if graphics == WEBGL else "without"
    print(f"{width} px, {shown}: {report}")
    scenes = r"drawn \1 still 0" if graphics == WEBGL else r"drawn 0 still \1"
    good = rf"scenes (\d+) {scenes} bare 0 unmoved 0 empty 0 wide false tall rows 0 resources 0$"
    if console or not title or not re.search(good, report):
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
            look(page, framed, width, WEBGL)
            if len(sys.argv) > 2:
                picture = pathlib.Path(sys.argv[2]).resolve()
                picture = picture.with_stem(f"{picture.stem}-{width}")
                chromium(*WEBGL, f"--window-size={width + 20},7000", f"--screenshot={picture}", framed.as_uri())
        look(page, framed, width, NO_WEBGL)


if __name__ == "__main__":
    main()
