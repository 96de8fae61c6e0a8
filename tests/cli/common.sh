# Sourced by the tests: $quadcover, a scratch folder which is removed at the end, and assertions.
set -u
quadcover=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
failures=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# run STATUS ARGUMENTS...: output in ./out and ./err.
run() {
    expected=$1
    shift
    "$quadcover" "$@" >out 2>err
    status=$?
    [ "$status" -eq "$expected" ] || fail "status $status, not $expected: quadcover $* ($(cat err))"
}

# An error is one line, "quadcover: error: ..."; the arguments are texts it must hold.
error_says() {
    [ "$(grep -c '^quadcover: error: ' err)" -eq 1 ] || fail "not one error line: $(cat err)"
    [ "$(grep -cv '^quadcover: ' err)" -eq 0 ] || fail "more on stderr: $(cat err)"
    for text in "$@"; do
        grep '^quadcover: error: ' err | grep -q -- "$text" || fail "no '$text' in: $(cat err)"
    done
}

out_says() {
    for text in "$@"; do
        grep -q -- "$text" out || fail "no '$text' in the output"
    done
}

# value FILE KEY: the first number under a key of a JSON file.
value() { sed -n "s/^ *\"$2\": *\\([-0-9.eE+]*\\),*\$/\\1/p" "$1" | head -n 1; }

# between VALUE LOW HIGH WHAT
between() {
    awk -v x="$1" -v lo="$2" -v hi="$3" 'BEGIN { exit !(x != "" && x >= lo && x <= hi) }' ||
        fail "$4: $1 is not in $2 .. $3"
}

same() { cmp -s "$1" "$2" || fail "$3: $1 and $2 differ"; }

finish() {
    [ "$failures" -eq 0 ] || exit 1
    exit 0
}
