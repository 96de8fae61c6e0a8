#!/bin/sh
# page.sh PROGRAM PAGE [options of the program]: runs the benchmark and replaces what is between the two
# marker lines of the page by its tables. The page stays as it was when the benchmark fails.
set -eu
program=$1 page=$2
shift 2
tables=$(mktemp) result=$(mktemp)
trap 'rm -f "$tables" "$result"' EXIT
{
    echo "Measured on $(date -u +%Y-%m-%d) with $(nproc) cores."
    "$program" --markdown "$@" || echo FAILED
} >"$tables"
if grep -q '^FAILED$' "$tables"; then exit 1; fi
awk -v tables="$tables" '
/<!-- begin bench_sparse -->/ { print; while ((getline line < tables) > 0) print line; skip = 1 }
/<!-- end bench_sparse -->/ { skip = 0 }
!skip { print }' "$page" >"$result"
cat "$result" >"$page"
