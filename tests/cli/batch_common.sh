# Sourced by the tests of batch: small meshes, a pipeline with a stage that makes trouble ($2).
. "$(dirname "$0")/common.sh"
plugin=$2

# mesh FILE FACES: a torus (its faces are about FACES).
mesh() { "$quadcover" shape torus --resolution "$2" -o "$1" >/dev/null || fail "cannot make $1"; }
faces() { grep -c '^f ' "$1"; }

# status_of FOLDER NAME
status_of() { sed -n "s/.*\"name\":\"$2\".*\"status\":\"\\([a-z]*\\)\".*/\\1/p" "$1/results.jsonl"; }

# once FOLDER NAME...: one line for each mesh, no others, nothing else left.
once() {
    folder=$1
    shift
    [ "$(wc -l <"$folder/results.jsonl")" -eq $# ] || fail "lines: $(cat "$folder/results.jsonl")"
    for name in "$@"; do
        [ "$(grep -c "\"name\":\"$name\"" "$folder/results.jsonl")" -eq 1 ] || fail "not once: $name"
    done
    [ -e "$folder/.batch" ] && fail "left: $(ls -a "$folder/.batch")"
}

# wait_for WHAT COMMAND...: at most a minute.
wait_for() {
    what=$1
    shift
    for i in $(seq 600); do
        "$@" && return
        sleep 0.1
    done
    fail "waited for $what"
}

# trouble SETTINGS: pipeline.json with the stage, e.g. trouble '"crash": 400'
trouble() {
    cat >pipeline.json <<END
{ "qc_pipeline": 1, "stages": [
  { "stage": "qc.repair" }, { "stage": "test.trouble", "params": { $1 } },
  { "stage": "qc.size", "params": { "quads": 150 } }, { "stage": "qc.field.smoothest" },
  { "stage": "qc.matching" }, { "stage": "qc.hodge" }, { "stage": "qc.round" },
  { "stage": "qc.untangle" }, { "stage": "qc.extract" }, { "stage": "qc.measure" } ] }
END
}
