#!/bin/sh
# Installs the packages this project is built with on Debian 12 (docs/dependencies.md says why each
# one), and those named as arguments. Needs root or sudo only when something is missing; otherwise it returns at once.
set -eu

packages="gcc g++ make cmake ninja-build pkg-config dpkg-dev file libopenblas-dev liblapacke-dev libsuitesparse-dev
libjansson-dev libpopt-dev zlib1g-dev libcmocka-dev clang libclang-rt-14-dev clang-format libmumps-dev libmumps-seq-dev openmpi-bin
libembree-dev libosd-dev python3-dev python3-pip python3-venv python3-setuptools python3-wheel python3-cffi python3-numpy python3-scipy
python3-distributed $*"

command -v dpkg-query >/dev/null 2>&1 || {
    echo "setup-debian: not a Debian system; install by hand: $packages" >&2
    exit 0
}

missing=""
for package in $packages; do
    # A package may be provided by another one (pkg-config by pkgconf).
    case $(dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2>/dev/null || true) in
    ii*) ;;
    *) missing="$missing $package" ;;
    esac
done
[ -n "$missing" ] || exit 0

as_root=""
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null 2>&1; then
        echo "setup-debian: missing packages:$missing" >&2
        echo "setup-debian: run as root: apt-get install$missing" >&2
        exit 1
    fi
    as_root=sudo
fi

echo "setup-debian: installing$missing" >&2
export DEBIAN_FRONTEND=noninteractive
$as_root apt-get update -q >&2
# shellcheck disable=SC2086
$as_root apt-get install -q -y --no-install-recommends $missing >&2
