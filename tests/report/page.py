"""What a page of `quadcover remesh --report` holds, and running the program."""

import base64
import json
import re
import subprocess
import zlib


def run(program, *arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    assert done.returncode == 0, f"{arguments}: {done.stderr}"


def part(text, name):
    return re.search(f'<script id="{name}"[^>]*>(.*?)</script>', text, re.DOTALL).group(1)


def unpack(data, count, stride):
    """Planes of bytes, zigzag, differences: the inverse of bindings/cli/report_arrays.c."""
    values = []
    for i in range(count):
        folded = sum(data[k * count + i] << (8 * k) for k in range(4))
        difference = (folded >> 1) ^ -(folded & 1)
        values.append(difference + (values[i - stride] if i >= stride else 0))
    return values


def read(path):
    """(report, {name: list of integers}) of a page."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    report = json.loads(part(text, "report"))
    data = zlib.decompress(base64.b64decode(part(text, "geometry")))
    arrays, offset = {}, 0
    for entry in report["geometry"]["arrays"]:
        size = 4 * entry["count"]
        arrays[entry["name"]] = unpack(data[offset:offset + size], entry["count"], entry["stride"])
        offset += size
    assert offset == len(data)
    return report, arrays
