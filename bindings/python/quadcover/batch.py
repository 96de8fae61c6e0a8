"""The tasks of `quadcover batch` on a Dask cluster.

    quadcover batch models -o results --quads 5000 --tasks tasks.jsonl
    python3 -m quadcover.batch tasks.jsonl --scheduler-file cluster.json

Workers need the program and the files under the same paths, and nothing of this package. A task on a
worker which is lost runs again on another one.
"""
import argparse
import json
import os
import subprocess
import sys
import uuid


def read_tasks(path):
    with open(path, encoding="utf-8") as file:
        return [json.loads(line) for line in file]


def collect(tasks_path, program=None):
    """Gathers results.jsonl and summary.html. Returns the exit status of the program: 1 as long as
    meshes failed or were not run."""
    program = program or read_tasks(tasks_path)[0]["command"][0]
    return subprocess.run([program, "batch", "--tasks", os.path.abspath(tasks_path), "--collect"]).returncode


def run(tasks_path, client, program=None, progress=None):
    """Runs all tasks of a file on the cluster of a distributed.Client and returns their lines
    (docs/batch.md) in order, None for a task which was lost with its workers. progress(done, total,
    line) is called after each. program: its path on the workers, that of the tasks by default.
    `collect` takes the results in."""
    from distributed import as_completed

    tasks = read_tasks(tasks_path)
    run_id, lines = uuid.uuid4().hex[:8], [None] * len(tasks)
    number = {}
    for k, task in enumerate(tasks):
        command = [program or task["command"][0], "batch", "--tasks", os.path.abspath(tasks_path),
                   "--run-task", str(k + 1)]
        future = client.submit(subprocess.run, command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, pure=False, key=f"quadcover-{run_id}-{k + 1}")
        number[future] = k
    for done, future in enumerate(as_completed(number), 1):
        k = number[future]
        if future.status == "finished":
            answer = future.result()
            if answer.stdout:
                lines[k] = json.loads(answer.stdout)
        if progress:
            progress(done, len(tasks), lines[k])
    return lines


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="quadcover.batch", description="Runs the tasks of quadcover batch on Dask.")
    parser.add_argument("tasks", help="what quadcover batch --tasks has written")
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument("--scheduler", help="address, such as tcp://host:8786")
    where.add_argument("--scheduler-file", help="file which dask scheduler --scheduler-file has written")
    parser.add_argument("--program", help="path of quadcover on the workers")
    given = parser.parse_args(arguments)
    try:
        from distributed import Client
    except ImportError:
        parser.error("needs the package distributed")

    def show(done, total, line):
        text = f"{line['name']}: {line['status']}, {line['seconds']:.1f} s" if line else "a task was lost"
        print(f"quadcover: {text}; {done} of {total} meshes", file=sys.stderr)

    with Client(given.scheduler, scheduler_file=given.scheduler_file) as client:
        run(given.tasks, client, given.program, show)
    return collect(given.tasks, given.program)


if __name__ == "__main__":
    sys.exit(main())
