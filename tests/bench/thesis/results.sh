#!/bin/sh
# results.sh BIN PAGE FIGURES [PART ...]: rewrites the parts of docs/results.md, all by default: those of
# `bench_thesis --list`, acceptance and scale; corpus only when it is named. BIN is the folder of the programs, which the
# corpus lies beside.
set -eu
bin=$1 page=$2 figures=$3
shift 3
here=$(dirname "$0")
[ $# -gt 0 ] || set -- $("$bin/bench_thesis" --list | cut -d' ' -f1) acceptance scale
mkdir -p "$figures"
for part in "$@"; do
    echo "results: $part" >&2
    case $part in
    acceptance) set -- python3 "$here/../acceptance/acceptance.py" --program "$bin/quadcover" --modes fast,best \
        --quads 300,1000,3000,10000,50000 --limit 180 --markdown ;;
    scale) set -- python3 "$here/../scale/scale.py" --program "$bin/quadcover" ;;
    corpus) set -- python3 "$here/../acceptance/acceptance.py" --program "$bin/quadcover" --corpus "$bin/../corpus" \
        --results "$bin/../corpus/results.jsonl" --modes fast --quads 1000 --memory 4096 --markdown ;;
    *) set -- "$bin/bench_thesis" --figures "$figures" "$part" ;;
    esac
    sh "$here/../common/page.sh" "$page" "$part" "$@"
done
