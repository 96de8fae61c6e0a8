#!/bin/sh
# run.sh PYTHON WHEEL_FOLDER VENV: installs the wheel in a fresh environment, which borrows numpy,
# scipy and cffi from the system, and runs the tests on what is installed.
set -eu
tests=$(cd "$(dirname "$0")" && pwd)
rm -rf "$3"
"$1" -m venv --system-site-packages "$3"
"$3/bin/python" -m pip install --quiet --no-deps --no-index "$2"/quadcover-*.whl
cd "$3"
exec "$3/bin/python" -m unittest discover -s "$tests"
