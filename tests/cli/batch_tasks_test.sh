# Tasks for other engines: a list, single tasks, a job array for Slurm run by a stand-in.
. "$(dirname "$0")/batch_common.sh"

mkdir "in dir"
for n in 200 300 400 500 600; do mesh "in dir/m$n.obj" $n; done
echo garbage >'in dir/bad.off'
run 0 batch 'in dir' -o res --quads 150 --mode fast --tasks tasks.jsonl --slurm job.sh \
    --limit 600 --memory 4000
[ "$(wc -l <tasks.jsonl)" -eq 6 ] || fail "tasks: $(cat tasks.jsonl)"
[ -e res/m200.obj ] && fail 'writing tasks ran one'
grep -q '^#SBATCH --array=1-6$' job.sh || fail "job: $(cat job.sh)"
grep -q '^#SBATCH --mem=4256M$' job.sh || fail "memory: $(cat job.sh)"

# What sbatch does: the script once for each index of the array, from anywhere, in any order.
sbatch() {
    size=$(sed -n 's/^#SBATCH --array=1-//p' job.sh)
    for index in $(seq "$size" -1 1); do
        [ "$index" = "$1" ] || (cd / && SLURM_ARRAY_TASK_ID=$index sh "$scratch/job.sh" >>"$scratch/log" 2>&1) ||
            echo "$index" >>failed
    done
}
sbatch 4 # one node is lost
[ "$(cat failed)" = 1 ] || fail "failed elements: $(cat failed log)"
run 1 batch --tasks tasks.jsonl --collect
error_says '2 of 6 meshes failed or were not run: bad, m400'
once res bad m200 m300 m500 m600
run 0 batch --tasks tasks.jsonl --run-task 4
out_says '"name":"m400".*"status":"done"'
first=$(ls -i res/m400.obj)
run 0 batch --tasks tasks.jsonl --run-task 4
[ "$(ls -i res/m400.obj)" = "$first" ] || fail 'a finished task ran again'
run 1 batch --tasks tasks.jsonl --collect
error_says '1 of 6 meshes failed or were not run: bad'
once res bad m200 m300 m400 m500 m600
run 2 batch --tasks tasks.jsonl --run-task 7
error_says '1 to 6'

# A task which has succeeded fails when an engine runs it once more: the success stays.
sed 's/--mode=fast/--mode=fats/' tasks.jsonl >fails.jsonl
run 0 batch --tasks fails.jsonl --run-task 4
out_says '"name":"m400".*"status":"done"'
run 1 batch --tasks tasks.jsonl --collect
once res bad m200 m300 m400 m500 m600
[ "$(ls -i res/m400.obj)" = "$first" ] || fail 'a success was lost'

# The same bytes here; a local batch goes on from there.
run 1 batch 'in dir' -o local --quads 150 --mode fast
for n in 200 300 400 500 600; do same res/m$n.obj local/m$n.obj 'by tasks or here'; done
mesh 'in dir/bad.off' 300
run 0 batch 'in dir' -o res --quads 150 --mode fast --progress plain
[ "$(wc -l <err)" -eq 1 ] || fail "not the bad one alone: $(cat err)"
run 1 batch 'in dir' -o res --quads 150 --mode fast --tasks tasks.jsonl
error_says 'nothing is left'

# Slurm takes 1000 elements: more tasks are dealt out to them, each once.
seq -f 'mesh%g.obj' 2345 >many.txt
run 0 batch many.txt -o many --slurm job.sh
grep -q '^#SBATCH --array=1-1000$' job.sh || fail 'array of many'
sed "s|'$quadcover'|echo|; s|'[^']*quadcover'|echo|" job.sh >dealt.sh
for index in 1 345 346 1000; do SLURM_ARRAY_TASK_ID=$index sh dealt.sh; done | sed 's/.*--run-task //' | tr '\n' ' ' >dealt
[ "$(cat dealt)" = '1 1001 2001 345 1345 2345 346 1346 1000 2000 ' ] || fail "dealt: $(cat dealt)"
finish
