"""batch_dask_test.py PROGRAM PLUGIN MODULE: the tasks of `quadcover batch` on a Dask cluster of two
worker processes, started as docs/batch.md says, one of which is killed in the middle: every mesh is
finished once. Skipped (77) without `distributed`."""

import importlib.util
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time

try:
    from distributed import Client
except ImportError:
    print("skipped: no python3-distributed")
    sys.exit(77)

PROGRAM, PLUGIN, MODULE = (os.path.abspath(path) for path in sys.argv[1:4])
SPEC = importlib.util.spec_from_file_location("batch", MODULE)
batch = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(batch)
N_MESHES, HANGS = 6, 2


def quadcover(*arguments):
    return subprocess.run([PROGRAM, *arguments], check=True, stdout=subprocess.DEVNULL)


def make_tasks():
    """Small meshes; that with most faces waits while there is a file `hang`."""
    faces = {}
    os.mkdir("in")
    for i in range(N_MESHES):
        path = f"in/mesh {i}.obj"
        quadcover("shape", "torus", "--resolution", str(900 if i == HANGS else 300 + 20 * i), "-o", path)
        with open(path, encoding="utf-8") as file:
            faces[i] = sum(line.startswith("f ") for line in file)
    stages = [{"stage": "qc.repair"}, {"stage": "test.trouble", "params": {"hang": faces[HANGS]}},
              {"stage": "qc.size", "params": {"quads": 150}}] + [
                  {"stage": "qc." + name} for name in ("field.smoothest", "matching", "hodge", "round", "untangle",
                                                       "extract", "measure")]
    with open("pipeline.json", "w", encoding="utf-8") as file:
        json.dump({"qc_pipeline": 1, "stages": stages}, file)
    open("hang", "w", encoding="utf-8").close()
    quadcover("batch", "in", "-o", "results", "--pipeline", "pipeline.json", "--plugin", PLUGIN, "--tasks",
              "tasks.jsonl")


def wait_for(what, condition):
    end = time.monotonic() + 120
    while not condition():
        assert time.monotonic() < end, f"waited for {what}"
        time.sleep(0.1)


def start_cluster():
    log = open("dask.log", "w", encoding="utf-8")
    dask = [sys.executable, "-m", "dask"]
    where = ["--scheduler-file", "cluster.json"]
    processes = [subprocess.Popen([*dask, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", *where],
                                  stdout=log, stderr=log)]
    for _ in range(2):
        processes.append(subprocess.Popen([*dask, "worker", "--nthreads", "1", "--no-dashboard", *where], stdout=log,
                                          stderr=log))
    return processes


def kill_worker(client, processes, address):
    """The worker and the nanny which would start it again, but not what they have started."""
    pid = client.run(os.getpid, workers=[address])[address]
    nanny = client.run(os.getppid, workers=[address])[address]
    mine = [process for process in processes if process.pid in (pid, nanny)]
    assert mine, "the worker is of this cluster"
    for each in (nanny, pid):
        os.kill(each, signal.SIGKILL)


def hanging(client):
    """The worker which runs the mesh that waits, once all others are done."""
    busy = [address for address, keys in client.processing().items() if keys]
    works = os.path.isdir("results/.batch") and any(
        name.startswith(f"mesh {HANGS}.") for name in os.listdir("results/.batch"))
    return busy[0] if len(busy) == 1 and works else None


def still_running():
    """A process which runs one of the tasks."""
    mine = os.path.abspath("tasks.jsonl").encode()
    for number in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{number}/cmdline", "rb") as file:
                if mine in file.read().split(b"\0"):
                    return True
        except OSError:
            pass  # it has ended meanwhile
    return False


def check(lines):
    names = [f"mesh {i}" for i in range(N_MESHES)]
    assert [line["name"] for line in lines] == names and all(line["status"] == "done" for line in lines), lines
    with open("results/results.jsonl", encoding="utf-8") as file:
        written = [json.loads(line) for line in file]
    assert sorted(line["name"] for line in written) == names, written
    for name in names:
        quadcover("check", f"results/{name}.obj")


def main():
    make_tasks()
    processes = start_cluster()
    result, counts = [], []
    try:
        with Client(scheduler_file="cluster.json", timeout=60) as client:
            client.wait_for_workers(2, timeout=60)
            runner = threading.Thread(target=lambda: result.extend(
                batch.run("tasks.jsonl", client, progress=lambda done, total, line: counts.append(done))))
            runner.start()
            wait_for("all but one", lambda: len(counts) == N_MESHES - 1 and hanging(client))
            first = hanging(client)
            kill_worker(client, processes, first)
            wait_for("the other worker", lambda: hanging(client) not in (None, first))
            os.remove("hang")  # both go on: the one nobody waits for any more, too
            runner.join(120)
        assert counts == list(range(1, N_MESHES + 1)), counts
        assert batch.collect("tasks.jsonl") == 0
        check(result)
        # What the lost one leaves later adds no line.
        wait_for("the end of all", lambda: not still_running())
        assert batch.collect("tasks.jsonl") == 0
        check(result)
    finally:
        for process in reversed(processes):
            process.terminate()
        for process in processes:
            process.wait(60)


with tempfile.TemporaryDirectory() as scratch:
    os.chdir(scratch)
    try:
        main()
    except BaseException:
        if os.path.exists("dask.log"):
            with open("dask.log", encoding="utf-8") as text:
                print(text.read())
        raise
    finally:
        os.chdir("/")
