#!/usr/bin/env python3
"""Remeshes every mesh of the test data and every shape at some densities and in some modes, checks each
result with `quadcover check --against`, and prints a line for each run and a table of the outcomes.

A run counts as good when the program ends with status 0 within its CPU time, the check finds nothing, all
triangles of the map are positively oriented, Euler characteristic, boundary loops and components are those
of the repaired input, and the number of quads is within 5 % of what was asked for. Standard library only."""
import argparse
import collections
import concurrent.futures
import json
import os
import signal
import subprocess
import sys
import tempfile

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), *[os.pardir] * 3)
Run = collections.namedtuple("Run", "model path mode quads")
Outcome = collections.namedtuple("Outcome", "run status seconds text")
GOOD, MANY, PART, WRONG, ERROR, TIME, CRASH = (
    "good", "number of quads", "part failed", "invalid", "error", "time", "crash")


def parse():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", default=os.path.join(ROOT, "build/bin/quadcover"))
    p.add_argument("--meshes", default=os.path.join(
        os.environ.get("QC_TEST_DATA", os.path.join(ROOT, "../shared")), "meshes"))
    p.add_argument("--modes", default="fast,relocate,best")
    p.add_argument("--quads", default="10000,3000")
    p.add_argument("--only", default="", help="models whose name contains one of these, with commas")
    p.add_argument("--limit", type=int, default=60, help="CPU seconds of a run")
    p.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    p.add_argument("--set", action="append", default=[], metavar="STEP.PARAM=VALUE", help="passed on to the program")
    p.add_argument("--quick", action="store_true", help="two coarse shapes, mode fast: the smoke test")
    p.add_argument("--markdown", action="store_true", help="the table as Markdown, the lines on stderr")
    p.add_argument("--strict", action="store_true", help="status 1 unless all runs are good")
    a = p.parse_args()
    if a.quick:
        a.modes, a.quads, a.only, a.meshes = "fast", "400", "shape sphere,shape ellipsoid", ""
    a.program = os.path.abspath(a.program)
    return a


def models(a, folder):
    """(name, path): files of the test data, then the shapes, written to the folder."""
    found = []
    if os.path.isdir(a.meshes):
        found = [(f.rsplit(".", 1)[0], os.path.join(a.meshes, f)) for f in sorted(os.listdir(a.meshes))]
    elif a.meshes:
        print(f"no folder {a.meshes}: shapes only (set QC_TEST_DATA)", file=sys.stderr)
    listed = subprocess.run([a.program, "shape", "--list"], capture_output=True, text=True, check=True)
    for name in [line.split()[0] for line in listed.stdout.splitlines() if line.strip()]:
        found.append(("shape " + name, os.path.join(folder, f"shape_{name}.obj")))
    wanted = a.only.split(",")
    found = [(n, p) for n, p in found if any(w in n for w in wanted)]
    for name, path in found:
        if name.startswith("shape "):
            subprocess.run([a.program, "shape", name.split()[1], "-o", path], check=True)
    return found


def verdict(stats, check, quads):
    """(status, text) of a run which ended with status 0."""
    source, made = stats["input"], stats["quads"]
    euler = 2 * source["components"] - 2 * source["genus"] - source["boundaries"]
    wrong = [what for what, bad in (
        ("check", not check["valid"]), ("non-quads", check["non_quads"]),
        (f"Euler {check['euler']} not {euler}", check["euler"] != euler),
        (f"boundaries {check['boundaries']} not {source['boundaries']}",
         check["boundaries"] != source["boundaries"]),
        ("components", check["components"] != source["components"]),
        (f"{stats['uv']['flipped']} flipped", stats["uv"]["flipped"]),
        ("seams", stats["uv"]["max_seam_error"])) if bad]
    text = (f"{made['faces']} quads, {check['irregular']} irregular, RSD {check['rsd_edge']:.1f} "
            f"{check['rsd_angle']:.1f}, Hausdorff {100 * check['hausdorff_rel']:.2f} %")
    failed = [w for w in stats["warnings"] if "component" in w]
    if failed:
        return PART, failed[0]
    if wrong:
        return WRONG, "; ".join(wrong)
    if abs(made["faces"] / quads - 1) > 0.05:
        return MANY, text
    return GOOD, text


def execute(a, folder, run):
    stem = os.path.join(folder, f"{run.model}-{run.mode}-{run.quads}".replace(" ", "_"))
    remesh = ["sh", "-c", f'ulimit -t {a.limit}; exec "$@"', "sh", a.program, "remesh", run.path, "-o", stem + ".obj", "--quads", str(run.quads), "--mode",
              run.mode, "--stats", stem + ".json", "--threads", "1", "--progress", "none"]
    for value in a.set:
        remesh += ["--set", value]
    with open(stem + ".err", "w+") as err:
        child = subprocess.Popen(remesh, stdout=subprocess.DEVNULL, stderr=err)
        usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(usage[1])
        seconds = usage[2].ru_utime + usage[2].ru_stime
        err.seek(0)
        lines = err.read().strip().splitlines() or [""]
    if child.returncode in (-signal.SIGXCPU, -signal.SIGKILL) and seconds >= a.limit - 1:
        return Outcome(run, TIME, seconds, f"no result within {a.limit} s. {lines[-1]}")
    if child.returncode:
        status = ERROR if child.returncode in (1, 3) else CRASH
        return Outcome(run, status, seconds, f"status {child.returncode}: {lines[-1]}")
    check = subprocess.run([a.program, "check", stem + ".obj", "--against", run.path, "--json"],
                           capture_output=True, text=True)
    try:
        with open(stem + ".json") as f:
            status, text = verdict(json.load(f), json.loads(check.stdout), run.quads)
    except (OSError, ValueError, KeyError) as e:
        status, text = WRONG, f"unreadable figures: {e!r}"
    os.remove(stem + ".obj")
    return Outcome(run, status, seconds, text)


def table(a, outcomes, print_row):
    """Modes x densities, and who was not good."""
    print_row(["mode", "quads", "good", "of", "median s", "longest s", "not good"])
    for mode in a.modes.split(","):
        for quads in map(int, a.quads.split(",")):
            some = [o for o in outcomes if (o.run.mode, o.run.quads) == (mode, quads)]
            if not some:
                continue
            seconds = sorted(o.seconds for o in some)
            bad = [f"{o.run.model} ({o.status})" for o in some if o.status != GOOD]
            print_row([f"`{mode}`", quads, len(some) - len(bad), len(some),
                       f"{seconds[len(seconds) // 2]:.1f}", f"{seconds[-1]:.1f}", ", ".join(bad)])


def markdown_row(cells):
    print("| " + " | ".join(map(str, cells)) + " |")
    if cells[0] == "mode":
        print("|---|---:|---:|---:|---:|---:|---|")


def text_row(cells):
    print("{:<12} {:>6} {:>5} {:>4} {:>9} {:>10}  {}".format(*cells))


def main():
    a = parse()
    with tempfile.TemporaryDirectory() as folder:
        runs = [Run(n, p, m, int(q)) for m in a.modes.split(",") for q in a.quads.split(",")
                for n, p in models(a, folder)]
        log = sys.stderr if a.markdown else sys.stdout
        outcomes = []
        with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
            for o in pool.map(lambda run: execute(a, folder, run), runs):
                outcomes.append(o)
                print(f"{o.status:<16} {o.run.mode:<9} {o.run.quads:>6} {o.run.model:<22} "
                      f"{o.seconds:6.2f} s  {o.text}", file=log, flush=True)
    bad = [o for o in outcomes if o.status != GOOD]
    print()
    table(a, outcomes, markdown_row if a.markdown else text_row)
    if a.markdown and bad:
        print("\nWhat happened:\n")
        for o in bad:
            text = o.text.replace(folder, "").replace(os.path.dirname(o.run.path) + os.sep, "")
            print(f"- {o.run.model}, `{o.run.mode}`, {o.run.quads} quads, {o.status}: {text}")
    print(f"\n{len(outcomes) - len(bad)} of {len(outcomes)} runs good, each with at most {a.limit} CPU seconds.")
    return 1 if a.strict and bad or not outcomes else 0


if __name__ == "__main__":
    sys.exit(main())
