#!/usr/bin/env python3
"""Writes the corpus: 300 models in nine classes, and corpus.jsonl with the name, class, number of faces, Euler
characteristic, components and boundary loops of each. A name is class-seed; the same seed gives the same bytes.
What is there already is kept when it was made by the same sources. Needs numpy."""
import argparse
import hashlib
import json
import multiprocessing
import os

import numpy as np

from classes import CLASSES
from mesh import topology, write_obj

DRAWS = 50


def names():
    return [(f"{kind}-{k:02d}", kind, maker, k) for kind, maker, count in CLASSES for k in range(1, count + 1)]


def make(folder, name, kind, maker, number):
    """Draws until the maker is content and the result is an oriented manifold."""
    for draw in range(DRAWS):
        seed = int.from_bytes(hashlib.sha256(f"{name}/{draw}".encode()).digest()[:4], "little")
        try:
            points, faces = maker(np.random.RandomState(seed), number)
            found = topology(points, faces)
            break
        except ValueError as e:
            reason = e
    else:
        raise SystemExit(f"corpus: {name}: no luck in {DRAWS} draws: {reason}")
    write_obj(os.path.join(folder, name + ".obj"), points, faces)
    return {"name": name, "class": kind, **found}


def sources():
    """Hash of the files next to this one."""
    here, digest = os.path.dirname(os.path.abspath(__file__)), hashlib.sha256()
    for f in sorted(os.listdir(here)):
        if f.endswith(".py"):
            with open(os.path.join(here, f), "rb") as file:
                digest.update(file.read())
    return digest.hexdigest()


def call(arguments):
    return make(*arguments)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("folder")
    p.add_argument("--only", default="", help="names which begin with one of these, with commas")
    p.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    a = p.parse_args()
    os.makedirs(a.folder, exist_ok=True)
    index, stamp = os.path.join(a.folder, "corpus.jsonl"), os.path.join(a.folder, "sources")
    wanted = sources() + " " + a.only
    if os.path.exists(stamp) and os.path.exists(index) and open(stamp).read() == wanted:
        return
    wanted_models = [(a.folder, *n) for n in names() if n[0].startswith(tuple(a.only.split(",")))]
    with multiprocessing.Pool(a.jobs) as pool, open(index, "w") as out:
        for line in pool.imap(call, wanted_models):
            print(json.dumps(line), file=out, flush=True)
    with open(stamp, "w") as out:
        out.write(wanted)


if __name__ == "__main__":
    main()
