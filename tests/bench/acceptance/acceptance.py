#!/usr/bin/env python3
"""Remeshes every mesh of the test data and every shape, or every model of the corpus, at some densities and in
some modes, checks each result with `quadcover check --against`, and prints a line for each run and a table of
the outcomes.

A run counts as good when the program ends with status 0 within its CPU time, the check finds nothing, all
triangles of the map are positively oriented, Euler characteristic, boundary loops and components are those
of the repaired input (of the corpus: those counted when it was made), and the number of quads is within 5 % of
what was asked for; as valid when only the number of quads is another one. Standard library only."""
import argparse
import concurrent.futures
import json
import os
import subprocess
import sys
import tempfile

import tables
from runs import GOOD, VALID, Model, Run, build_of, execute, key

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), *[os.pardir] * 3)


def parse():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", default=os.path.join(ROOT, "build/bin/quadcover"))
    p.add_argument("--meshes", default=os.path.join(
        os.environ.get("QC_TEST_DATA", os.path.join(ROOT, "../shared")), "meshes"))
    p.add_argument("--corpus", help="folder which tests/bench/corpus/corpus.py wrote, instead of meshes and shapes")
    p.add_argument("--modes", default="fast,relocate,best")
    p.add_argument("--quads", default="10000,3000")
    p.add_argument("--only", default="", help="models whose name contains one of these, with commas")
    p.add_argument("--limit", type=int, default=60, help="CPU seconds of a run")
    p.add_argument("--memory", type=int, default=0, help="address space of a run in MB; 0: unlimited")
    p.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    p.add_argument("--set", action="append", default=[], metavar="STEP.PARAM=VALUE", help="passed on to the program")
    p.add_argument("--results", metavar="FILE.jsonl", help="append a line for each run; what is there is not run again")
    p.add_argument("--keep", choices=("build", "good", "all"), default="build",
                   help="which lines of --results count: those of this build (default), all good ones too, all")
    p.add_argument("--quick", action="store_true", help="two coarse shapes, mode fast: the smoke test")
    p.add_argument("--markdown", action="store_true", help="the table as Markdown, the lines on stderr")
    p.add_argument("--strict", action="store_true", help="status 1 unless all runs are good")
    a = p.parse_args()
    if a.quick:
        a.modes, a.quads, a.only, a.meshes = "fast", "500", "shape sphere,shape ellipsoid", ""
    a.program = os.path.abspath(a.program)
    a.build = build_of(a.program)
    return a


def corpus_models(folder):
    with open(os.path.join(folder, "corpus.jsonl")) as lines:
        return [Model(m["name"], m["class"], os.path.join(folder, m["name"] + ".obj"), m)
                for m in map(json.loads, lines)]


def models(a, folder):
    """Files of the test data, then the shapes, written to the folder."""
    if a.corpus:
        return [m for m in corpus_models(a.corpus) if any(w in m.name for w in a.only.split(","))]
    found = []
    if os.path.isdir(a.meshes):
        found = [Model(f.rsplit(".", 1)[0], "meshes", os.path.join(a.meshes, f), None)
                 for f in sorted(os.listdir(a.meshes))]
    elif a.meshes:
        print(f"no folder {a.meshes}: shapes only (set QC_TEST_DATA)", file=sys.stderr)
    listed = subprocess.run([a.program, "shape", "--list"], capture_output=True, text=True, check=True)
    for name in [line.split()[0] for line in listed.stdout.splitlines() if line.strip()]:
        found.append(Model("shape " + name, "shapes", os.path.join(folder, f"shape_{name}.obj"), None))
    found = [m for m in found if any(w in m.name for w in a.only.split(","))]
    for m in found:
        if m.kind == "shapes":
            subprocess.run([a.program, "shape", m.name.split()[1], "-o", m.path], check=True)
    return found


def known(a):
    """Outcomes of earlier calls by their keys; a line cut short by an interruption is none."""
    found = {}
    if a.results and os.path.exists(a.results):
        with open(a.results) as lines:
            for line in lines:
                try:
                    o = json.loads(line)
                except ValueError:
                    continue
                found[o["key"]] = o
    return {k: o for k, o in found.items() if a.keep == "all" or o["build"] == a.build or
            (a.keep == "good" and o["status"] == GOOD)}


def run_all(a, folder, report):
    """(run, outcome) of all runs in their order; each new one is appended to the results when it is done."""
    runs = [Run(m, mode, int(q)) for mode in a.modes.split(",") for q in a.quads.split(",") for m in models(a, folder)]
    before = known(a)
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        done = [before.get(key(run, a.set)) or pool.submit(execute, a, folder, run) for run in runs]
        outcomes = []
        for run, o in zip(runs, done):
            if not isinstance(o, dict):
                o = o.result()
                report(run, o)
            outcomes.append((run, o))
    return outcomes


def reporter(a):
    """Prints and stores an outcome."""
    log = sys.stderr if a.markdown else sys.stdout

    def report(run, o):
        print(f"{o['status']:<16} {run.mode:<9} {run.quads:>6} {run.model.name:<22} {o['seconds']:6.2f} s  {o['text']}",
              file=log, flush=True)
        if a.results:
            with open(a.results, "a") as lines:
                print(json.dumps(o), file=lines, flush=True)
    return report


def main():
    a = parse()
    with tempfile.TemporaryDirectory() as folder:
        outcomes = run_all(a, folder, reporter(a))
    bad = [(run, o) for run, o in outcomes if o["status"] != GOOD]
    failed = [(run, o) for run, o in bad if o["status"] not in VALID]
    print()
    (tables.by_class if a.corpus else tables.by_mode)(a, outcomes)
    told = failed if a.corpus else bad
    if a.markdown and told:
        print("\nWhat happened:\n")
        for run, o in told:
            print(f"- {run.model.name}, `{run.mode}`, {run.quads} quads, {o['status']}: {o['text']}")
    print(f"\n{len(outcomes) - len(bad)} of {len(outcomes)} runs good, {len(outcomes) - len(failed)} valid, "
          f"each with at most {a.limit} CPU seconds.")
    old = sum(o["build"] != a.build for _, o in outcomes)
    if old:
        print(f"{old} outcomes are those of earlier builds.")
    return 1 if a.strict and bad or not outcomes else 0


if __name__ == "__main__":
    sys.exit(main())
