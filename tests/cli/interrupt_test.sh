# Ctrl-C at various moments: finished or 130, never a partial or temporary file.
. "$(dirname "$0")/common.sh"

run 0 shape knot --resolution 60000 -o in.obj
for delay in 0.05 0.2 0.5 1; do
    rm -f quads.obj stats.json
    # A background job of a non-interactive shell ignores SIGINT; SIGTERM takes the same path.
    "$quadcover" remesh in.obj -o quads.obj --stats stats.json --mode fast >out 2>err &
    pid=$!
    sleep $delay
    kill -TERM $pid 2>/dev/null
    wait $pid
    status=$?
    case $status in
    0) [ -s quads.obj ] || fail 'done without an output' ;;
    130)
        grep -q '^quadcover: error: interrupted$' err || fail "message: $(cat err)"
        [ -e quads.obj ] && [ "$(tail -c 1 quads.obj | wc -l)" -ne 1 ] && fail 'partial output'
        ;;
    *) fail "status $status after $delay s: $(cat err)" ;;
    esac
    ls | grep -v -e '^in.obj$' -e '^quads.obj$' -e '^stats.json$' -e '^out$' -e '^err$' >left
    grep -v '^left$' left >really_left
    [ -s really_left ] && fail "files left: $(cat really_left)"
    rm -f left really_left
done
finish
