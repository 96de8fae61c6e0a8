"""One run of `quadcover remesh` within limits of CPU time and memory, and what `quadcover check` says of it."""
import collections
import hashlib
import json
import os
import signal
import subprocess
import threading

Model = collections.namedtuple("Model", "name kind path topology")      # topology: None, or counts known beforehand
Run = collections.namedtuple("Run", "model mode quads")
GOOD, MANY, PART, WRONG, ERROR, TIME, MEMORY, CRASH = (
    "good", "number of quads", "part failed", "invalid", "error", "time", "memory", "crash")
VALID = (GOOD, MANY)


def key(run, settings):
    """What a run is known by in a file of results."""
    return " ".join([run.model.name, run.mode, str(run.quads), *settings])


def build_of(program):
    """Hash of the program and of the library next to it."""
    digest = hashlib.sha256()
    library = os.path.join(os.path.dirname(program), os.pardir, "lib", "libquadcover.so")
    for path in (program, library):
        if os.path.exists(path):
            with open(path, "rb") as f:
                digest.update(f.read())
    return digest.hexdigest()[:16]


def counts(stats):
    """Those of the repaired input."""
    source = stats["input"]
    return {"euler": 2 * source["components"] - 2 * source["genus"] - source["boundaries"],
            "components": source["components"], "boundaries": source["boundaries"]}


def verdict(run, stats, check):
    """(status, text) of a run which ended with status 0."""
    made, expected = stats["quads"], run.model.topology or counts(stats)
    wrong = [f"input {k} {v} not {expected[k]}" for k, v in counts(stats).items() if v != expected[k]]
    wrong += [f"{k} {check[k]} not {expected[k]}" for k in ("euler", "boundaries", "components")
              if check[k] != expected[k]]
    wrong += [what for what, bad in (
        ("check", not check["valid"]), ("non-quads", check["non_quads"]),
        (f"{stats['uv']['flipped']} flipped", stats["uv"]["flipped"]),
        ("seams", stats["uv"]["max_seam_error"])) if bad]
    text = (f"{made['faces']} quads, {check['irregular']} irregular, RSD {check['rsd_edge']:.1f} "
            f"{check['rsd_angle']:.1f}, Hausdorff {100 * check['hausdorff_rel']:.2f} %")
    failed = [w for w in stats["warnings"] if "has no result" in w]
    if failed:
        return PART, failed[0]
    if wrong:
        return WRONG, "; ".join(wrong)
    if abs(made["faces"] / run.quads - 1) > 0.05:
        return MANY, text
    return GOOD, text


def limited(a, command):
    """The command in a shell which has the limits; that of time sends SIGXCPU."""
    limits = f"ulimit -S -t {a.limit}" + (f"; ulimit -v {1024 * a.memory}" if a.memory else "")
    return ["sh", "-c", limits + '; exec "$@"', "sh", *command]


def wait(a, child):
    """Exit status, CPU seconds and memory in MB of the child, which is killed when it hangs."""
    clock = threading.Timer(20 * a.limit, child.kill)
    clock.start()
    usage = os.wait4(child.pid, 0)
    clock.cancel()
    child.returncode = os.waitstatus_to_exitcode(usage[1])
    return child.returncode, usage[2].ru_utime + usage[2].ru_stime, usage[2].ru_maxrss / 1024


def failure(a, code, last):
    """(status, text) of a run which did not end with status 0."""
    if code == -signal.SIGXCPU:
        return TIME, f"no result within {a.limit} s. {last}"
    if code == 1 and "memory" in last:
        return MEMORY, last
    return (ERROR if code in (1, 3) else CRASH), f"status {code}: {last}"


def execute(a, folder, run):
    """The outcome as a dict which JSON can hold."""
    stem = os.path.join(folder, f"{run.model.name}-{run.mode}-{run.quads}".replace(" ", "_"))
    command = [a.program, "remesh", run.model.path, "-o", stem + ".obj", "--quads", str(run.quads), "--mode",
               run.mode, "--stats", stem + ".json", "--threads", "1", "--progress", "none"]
    for value in a.set:
        command += ["--set", value]
    with open(stem + ".err", "w+") as err:
        child = subprocess.Popen(limited(a, command), stdout=subprocess.DEVNULL, stderr=err)
        code, seconds, megabytes = wait(a, child)
        err.seek(0)
        lines = err.read().strip().splitlines() or [""]
    outcome = {"key": key(run, a.set), "build": a.build, "seconds": round(seconds, 3), "megabytes": round(megabytes),
               "warnings": [], "quads": 0}
    if code:
        status, text = failure(a, code, lines[-1])
    else:
        check = subprocess.run([a.program, "check", stem + ".obj", "--against", run.model.path, "--json"],
                               capture_output=True, text=True)
        try:
            with open(stem + ".json") as f:
                stats = json.load(f)
            status, text = verdict(run, stats, json.loads(check.stdout))
            outcome.update(warnings=stats["warnings"], quads=stats["quads"]["faces"])
        except (OSError, ValueError, KeyError) as e:
            status, text = WRONG, f"unreadable figures: {e!r}"
        os.remove(stem + ".obj")
    text = text.replace(folder, "").replace(os.path.dirname(run.model.path) + os.sep, "")
    return {**outcome, "status": status, "text": text}
