#!/bin/sh
# page.sh PAGE MARK COMMAND...: runs the command and replaces what is between the two lines
# <!-- begin MARK --> and <!-- end MARK --> of the page by its output. The page stays as it was when the
# command fails.
set -eu
page=$1 mark=$2
shift 2
output=$(mktemp) result=$(mktemp)
trap 'rm -f "$output" "$result"' EXIT
{
    echo "Measured on $(date -u +%Y-%m-%d) with $(nproc) cores$(awk '$1 > 0.3 {
        printf "; other programs were running (load %.1f), so times are too long", $1 }' /proc/loadavg)."
    "$@" || echo FAILED
} >"$output"
if grep -q '^FAILED$' "$output"; then exit 1; fi
grep -q "<!-- begin $mark -->" "$page" || { echo "page.sh: no mark $mark in $page" >&2; exit 1; }
awk -v output="$output" -v mark="$mark" '
$0 == "<!-- begin " mark " -->" { print; while ((getline line < output) > 0) print line; skip = 1 }
$0 == "<!-- end " mark " -->" { skip = 0 }
!skip { print }' "$page" >"$result"
cat "$result" >"$page"
