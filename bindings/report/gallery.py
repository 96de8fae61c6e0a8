#!/usr/bin/env python3
"""gallery.py DIR [--title TEXT]: one page for a folder of reports.

Writes DIR/index.html, a card for each page of `quadcover remesh --report` in DIR, with a picture
where a Chromium is found. Captions come from DIR/captions.json, {file: [title, text]}, if there is
one. The viewer is that of the reports."""

import argparse
import base64
import html
import json
import os
import re

import browser as chromium

HERE = os.path.dirname(os.path.abspath(__file__))
# Drawn and read in one task, at the size of the window, without the controls.
PICTURE = """quadcover.ready.then((view) => {
  view.render();
  return view.canvas.toDataURL('image/jpeg', 0.8).split(',')[1];
})"""
# Text alone beside the picture: the window is as large as the picture.
BARE = "document.head.append(Object.assign(document.createElement('style'), {textContent: " \
       "'.report{display:block!important}.panel{display:none}.view{height:100vh!important}'}))"


def read_report(path):
    """The JSON of a report, or None for other pages."""
    with open(path, encoding="utf-8", errors="replace") as file:
        found = re.search(r'<script id="report" type="application/json">(.*?)</script>', file.read(), re.DOTALL)
    return json.loads(found.group(1)) if found else None


def picture(page, path, controls=()):
    """JPEG of a report; controls: values of the radio buttons and boxes which are clicked before."""
    page.open(path)
    page.run(BARE)
    page.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    for value in controls:
        page.run(f"document.querySelector('input[value={value}]').click()")
    return base64.b64decode(page.run(PICTURE))


def caption(report):
    quads, seconds = report["stats"]["quads"], report["stats"]["seconds"]["total"]
    return f"{quads['faces']} quads, {quads['irregular']} irregular vertices, mode " \
           f"{report['stats']['mode']}, {seconds:.1f} s"


def write_index(folder, title, cards):
    with open(os.path.join(HERE, "viewer.html"), encoding="utf-8") as file:
        viewer = file.read()
    data = json.dumps({"title": title, "cards": cards}).replace("<", "\\u003c")
    page = viewer.replace("@QUADCOVER_DATA@", f'<script id="gallery" type="application/json">{data}</script>', 1)
    with open(os.path.join(folder, "index.html"), "w", encoding="utf-8") as file:
        file.write(page.replace("<title>QuadCover</title>", f"<title>{html.escape(title)}</title>", 1))


def make_index(folder, title, page=None):
    """Cards in the order of captions.json, the others by name."""
    captions, cards = {}, []
    if os.path.exists(os.path.join(folder, "captions.json")):
        with open(os.path.join(folder, "captions.json"), encoding="utf-8") as file:
            captions = json.load(file)
    others = sorted(n for n in os.listdir(folder) if n.endswith(".html") and n != "index.html")
    for name in [n for n in captions if n in others] + [n for n in others if n not in captions]:
        path = os.path.join(folder, name)
        report = read_report(path)
        if not report:
            continue
        heading, text = captions.get(name, [os.path.basename(report["stats"]["input"]["file"]), caption(report)])
        card = {"title": heading, "text": text, "page": name}
        saved = path[:-5] + ".jpg"
        data = None
        if os.path.exists(saved):
            with open(saved, "rb") as file:
                data = file.read()
        elif page:
            data = picture(page, path)
        if data:
            card["image"] = "data:image/jpeg;base64," + base64.b64encode(data).decode()
        cards.append(card)
    write_index(folder, title, cards)
    return len(cards)


def main():
    parser = argparse.ArgumentParser(description="One page for a folder of reports.")
    parser.add_argument("folder")
    parser.add_argument("--title", default="QuadCover")
    arguments = parser.parse_args()
    path = chromium.find()
    if path:
        with chromium.Browser(path, 640, 480) as page:
            n = make_index(arguments.folder, arguments.title, page)
    else:
        n = make_index(arguments.folder, arguments.title)
    print(f"{os.path.join(arguments.folder, 'index.html')}: {n} reports")


if __name__ == "__main__":
    main()
