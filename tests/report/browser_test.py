"""The page in a headless Chromium: nothing on the console, no request, a picture of the right shape,
controls which change it and change it back. Skipped (77) without Chromium."""

import os
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../bindings/report"))
import browser as chromium
import gallery
from page import run

COLUMNS, ROWS = 32, 24

# The canvas as seen, since drawing and reading happen in one task: share of the cells of a raster
# which is not background, a hash of all pixels, and counts of colours.
LOOK = """quadcover.ready.then((view) => {
  view.render();
  const copy = document.createElement('canvas');
  const w = copy.width = view.canvas.width, h = copy.height = view.canvas.height;
  const context = copy.getContext('2d');
  context.drawImage(view.canvas, 0, 0);
  const p = context.getImageData(0, 0, w, h).data;
  const cover = new Array(%d).fill(0), total = cover.slice();
  let hash = 0, red = 0, blue = 0, dark = 0;
  for (let y = 0; y < h; y++) for (let x = 0; x < w; x++) {
    const i = 4 * (y * w + x), [r, g, b] = [p[i], p[i + 1], p[i + 2]];
    const cell = Math.floor(y * %d / h) * %d + Math.floor(x * %d / w);
    const object = Math.abs(r - p[0]) + Math.abs(g - p[1]) + Math.abs(b - p[2]) > 12;
    total[cell]++;
    cover[cell] += object;
    hash = (hash * 31 + r + 256 * g + 65536 * b) | 0;
    red += r > 1.8 * Math.max(g, b) && r > 100;
    blue += b > 1.8 * r && b > 100;
    dark += object && r + g + b < 300;
  }
  return { w, h, hash, red, blue, dark, cover: cover.map((n, i) => n / total[i]) };
})""" % (COLUMNS * ROWS, ROWS, COLUMNS, COLUMNS)


def click(page, value):
    page.run(f"document.querySelector('input[value={value}]').click()")
    return page.run(LOOK)


def is_quiet(page, path):
    assert page.messages == [], page.messages
    asked = [url for url in page.requests if not url.startswith("data:")]
    assert asked == ["file://" + os.path.abspath(path)], asked
    assert page.run("performance.getEntriesByType('resource').length") == 0


def has_the_shape(look):
    """Coverage of the knot against knot.txt, one digit a cell."""
    cover = [round(9 * x) for x in look["cover"]]
    rows = ["".join(map(str, cover[i:i + COLUMNS])) for i in range(0, len(cover), COLUMNS)]
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "knot.txt"), encoding="ascii") as file:
        expected = [int(c) for c in file.read() if c.isdigit()]
    assert len(expected) == len(cover), "\n".join(rows)
    off = sum(abs(a - b) for a, b in zip(cover, expected)) / len(cover)
    print(f"mean deviation of the coverage: {off:.3f} of 9")
    assert off < 0.4, "\n".join(rows)
    assert 0.1 < sum(cover) / 9 / len(cover) < 0.6


def controls_work(page):
    start = page.run(LOOK)
    has_the_shape(start)
    assert start["red"] > 50 and start["blue"] > 50, "no cones"
    looks = {value: click(page, value) for value in ("input", "grid", "quads")}
    assert len({look["hash"] for look in looks.values()}) == 3, "surfaces look the same"
    assert looks["quads"]["hash"] == start["hash"]
    for value in ("singularities", "field", "edges"):
        changed = click(page, value)
        assert changed["hash"] != start["hash"], f"{value} changes nothing"
        assert click(page, value)["hash"] == start["hash"], f"{value} does not go back"
        if value == "singularities":
            assert changed["red"] + changed["blue"] < (start["red"] + start["blue"]) / 10
        if value == "edges":
            assert changed["dark"] < start["dark"] / 2, (changed["dark"], start["dark"])


def turns(page):
    """The mouse turns the object."""
    before = page.run(LOOK)["hash"]
    for kind, x in (("mousePressed", 300), ("mouseMoved", 420), ("mouseReleased", 420)):
        page.call("Input.dispatchMouseEvent", type=kind, x=x, y=400, button="left", buttons=1, clickCount=1)
    assert page.run(LOOK)["hash"] != before


def panel_is_complete(page):
    words = page.run("document.querySelector('.panel').innerText")
    for text in ("knot.obj", "Irregular vertices", "Edge lengths / mean", "Angles", "Times", "qc.untangle",
                 "quadcover remesh"):
        assert text in words, text
    assert page.run("document.querySelectorAll('.panel details').length") == \
        page.run("JSON.parse(document.getElementById('report').textContent).stats.pipeline.stages.length")
    assert page.run("document.querySelectorAll('.panel svg rect').length") == 144
    assert page.run("document.querySelector('.legend').innerText").count("index") >= 2


def large(page, program):
    """100000 faces. The time is printed only: it depends on the machine."""
    run(program, "shape", "genus", "--resolution", "100000", "-o", "large.obj")
    run(program, "remesh", "large.obj", "--quads", "20000", "--mode", "fast", "--report", "large.html")
    size = os.path.getsize("large.html")
    seconds = page.open("large.html")
    print(f"large: {size / 1e6:.1f} MB, complete after {seconds:.2f} s")
    assert size < 30e6
    is_quiet(page, "large.html")
    assert page.run(LOOK)["dark"] > 1000


def folder_becomes_a_gallery(page):
    """A card with a picture for each report, which leads there."""
    assert gallery.make_index(".", "Two <runs>", page) == 2
    page.open("index.html")
    is_quiet(page, "index.html")
    assert page.run("document.querySelector('h1').innerText") == "Two <runs>"
    assert page.run("[...document.querySelectorAll('.cards a')].map((a) => a.getAttribute('href'))") == \
        ["knot.html", "large.html"]
    pictures = page.run("Promise.all([...document.images].map(async (i) => { await i.decode(); return i.naturalWidth; }))")
    assert len(pictures) == 2 and min(pictures) > 100, pictures
    assert "irregular vertices" in page.run("document.querySelector('.cards').innerText")


def main(program):
    path = chromium.find()
    if not path:
        print("no Chromium: install the package chromium, or name a program in $CHROMIUM")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder, chromium.Browser(path, 1000, 600) as page:
        os.chdir(folder)
        run(program, "shape", "knot", "--noise", "0.05", "--retriangulate", "-o", "knot.obj")
        # the sharp edges of the noise as guides: with cones to be looked at
        run(program, "remesh", "knot.obj", "--quads", "1500", "--mode", "fast", "--report", "knot.html",
            "--set", "features.hard=false")
        page.open("knot.html")
        is_quiet(page, "knot.html")
        controls_work(page)
        panel_is_complete(page)
        turns(page)
        is_quiet(page, "knot.html")
        large(page, program)
        folder_becomes_a_gallery(page)


main(os.path.abspath(sys.argv[1]))
