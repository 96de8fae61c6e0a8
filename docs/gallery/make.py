#!/usr/bin/env python3
"""make.py QUADCOVER [ID...]: makes the figures of figures.json again (all, or those named).

Reports go to docs/gallery/reports (not kept in the repository), small pictures and the page README.md
beside this file. Meshes are found in $QC_TEST_DATA/meshes; a figure whose mesh is missing keeps the
picture it has."""

import json
import os
import shlex
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "bindings/report"))
import browser as chromium
import gallery

REPORTS, PICTURES = os.path.join(HERE, "reports"), os.path.join(HERE, "pictures")
HEAD = """# Gallery

The figures of the three papers ([references](../theory/references.md)) made again: `make gallery` runs the commands below and writes the
reports, with `reports/index.html` as a page for all of them. Models which are not among the test data are replaced by others, as said
there, or left out (the hand of Figures 9 and 10 of the 2007 paper); so are drawings which explain a notion. This page is made by `make.py` from `figures.json`.
"""


def mesh_of(figure):
    """The triangle mesh, made when it is a shape; None when it is missing."""
    if "mesh" in figure:
        folder = os.environ.get("QC_TEST_DATA", os.path.join(ROOT, "../shared"))
        path = os.path.join(folder, "meshes", figure["mesh"])
        return path if os.path.exists(path) else None
    path = os.path.join(REPORTS, figure["id"] + ".obj")
    subprocess.run([PROGRAM, "shape", *shlex.split(figure["shape"]), "-o", path], check=True)
    return path


def make(figure, page):
    mesh = mesh_of(figure)
    if not mesh:
        print(f"{figure['id']}: no {figure['mesh']}; set QC_TEST_DATA")
        return True
    report = os.path.join(REPORTS, figure["id"] + ".html")
    done = subprocess.run([PROGRAM, "remesh", mesh, *shlex.split(figure["options"]), "--progress", "none",
                           "--report", report], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        print(f"{figure['id']}: {done.stderr.strip()}")
        return False
    data = gallery.picture(page, report, figure.get("show", ()))
    for path in (os.path.join(PICTURES, figure["id"] + ".jpg"), report[:-5] + ".jpg"):
        with open(path, "wb") as file:
            file.write(data)
    print(f"{figure['id']}: {gallery.caption(gallery.read_report(report))}")
    return True


def commands(figure):
    name = figure.get("mesh") or figure["shape"].split()[0] + ".obj"
    lines = [f"quadcover shape {figure['shape']} -o {name}"] if "shape" in figure else []
    return lines + [f"quadcover remesh {name} {figure['options']} --report {figure['id']}.html"]


def write_page(figures):
    parts = [HEAD]
    for figure in figures:
        parts.append(f"## {figure['title']}\n\n{figure['text']}.\n\n![{figure['title']}](pictures/{figure['id']}.jpg)\n\n"
                     "```sh\n" + "\n".join(commands(figure)) + "\n```\n")
    with open(os.path.join(HERE, "README.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(parts))


def main(wanted):
    with open(os.path.join(HERE, "figures.json"), encoding="utf-8") as file:
        figures = json.load(file)
    browser = chromium.find()
    if not browser:
        sys.exit("make.py: no Chromium for the pictures: install the package chromium")
    for folder in (REPORTS, PICTURES):
        os.makedirs(folder, exist_ok=True)
    good = True
    with chromium.Browser(browser, 480, 360) as page:
        for figure in figures:
            if not wanted or figure["id"] in wanted:
                good = make(figure, page) and good
    with open(os.path.join(REPORTS, "captions.json"), "w", encoding="utf-8") as file:
        json.dump({f["id"] + ".html": [f["title"], f["text"]] for f in figures}, file)
    gallery.make_index(REPORTS, "QuadCover: the figures of the papers", None)
    write_page(figures)
    return good


PROGRAM = os.path.abspath(sys.argv[1])
sys.exit(0 if main(sys.argv[2:]) else 1)
