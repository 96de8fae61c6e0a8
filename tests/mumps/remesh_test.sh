# The program with hodge.solver=mumps, alone and by mpirun: the quads of builtin, E_D to 1e-9.
# remesh_test.sh QUADCOVER PLUGIN WORKER MPIRUN [OPTIONS OF MPIRUN ...]
here=$(dirname "$0")
program=$1 plugin=$2 worker=$3
shift 3
set -- "$program" "$@"
. "$here/../cli/common.sh"
shift
# without hard features the choice of integers leaves a margin for another rounding of the sums
remesh="remesh in.obj --quads 600 --mode fast --progress none --set features.hard=false"
run 0 shape genus --genus 3 --resolution 2000 -o in.obj
run 0 $remesh -o builtin.obj --stats builtin.json --set hodge.solver=builtin
run 0 $remesh -o default.obj
same builtin.obj default.obj "solver builtin"
run 0 $remesh -o alone.obj --stats alone.json --plugin "$plugin" --set hodge.solver=mumps \
    --set round.solver=mumps
"$@" -n 1 "$quadcover" $remesh -o two.obj --stats two.json --plugin "$plugin" \
    --set hodge.solver=mumps --set round.solver=mumps : -n 1 "$worker" >out 2>err || fail "mpirun: $(cat err)"
[ -s out ] && fail "something was printed: $(cat out)"
[ "$(value builtin.json E_D)" ] || fail "no E_D in the statistics"
for kind in alone two; do
    e=$(value builtin.json E_D)
    between "$(value $kind.json E_D)" "$(awk "BEGIN { printf \"%.15g\", $e * (1 - 1e-9) }")" \
        "$(awk "BEGIN { printf \"%.15g\", $e * (1 + 1e-9) }")" "$kind: E_D"
    [ "$(grep -c '^f ' $kind.obj)" = "$(grep -c '^f ' builtin.obj)" ] || fail "$kind: other quads"
    grep -q '"solver": "mumps"' $kind.json || fail "$kind: the statistics do not name the solver"
done

# Names and launches that cannot work.
run 2 $remesh -o no.obj --set hodge.solver=mumps
error_says "no qc.solver/1 is called 'mumps'" "load the plugin" builtin
run 2 $remesh -o no.obj --plugin "$plugin" --set hodge.solver=mump
error_says "closest: 'mumps'"
run 2 $remesh -o no.obj --plugin "$plugin" --set hodge.solver=buildin
error_says "closest: 'builtin'"
run 2 $remesh -o no.obj --plugin ./qc_mumps.so --set hodge.solver=mumps
error_says qc_mumps.so
quadcover=$worker
run 1
grep -q 'no MPI launcher' err || fail "worker alone: $(cat err)"
"$@" -n 2 "$worker" >out 2>err && fail "workers without a program succeeded"
grep -q 'the first MPI process must run the program' err || fail "workers only: $(cat err)"
finish
