#!/usr/bin/env bash
# The backend mpi: the same bits as openmp's with any number of ranks, and one sentence for whatever ends them.
set -euo pipefail
. "$2/tests/support/mpi_ranks.sh"
mkdir one two
touch begun
let_ranks_share

no_rank() { [ -z "$(ranks_here)" ]; }

# Every explicit integrator; the last bit is openmp's, for 1 to 8 ranks, parts of different widths and several threads.
ends 0 bench --scene cloth4900 --backend openmp,mpi --integrator "$explicit" --ranks 2 --threads 1 --rounds 1 --out all
all_verified all $((2 * explicit_count))
[ "$(hashes all | wc -l)" -eq "$explicit_count" ] || fail "mpi and openmp differ: $(cat all/timings.csv)"
[ "$(column_of all/timings.csv device | sort -u | wc -l)" -eq 1 ] || fail "its instruction set is no device of mpi: $(cat all/timings.csv)"
if [ "$(nproc)" -ge 2 ]; then
  # Four stages pass over memory once in both, so they move the same bytes per step.
  column_of all/timings.csv integrator ms_per_step gigabytes_per_second |
    awk '$1 == "rk4" && NF == 3 { bytes = $2 * $3; if (n++ && (bytes / first > 1.001 || bytes / first < 0.999)) bad = 1; first = bytes }
         END { exit bad || n != 2 }' || fail "bytes of a step: $(cat all/timings.csv)"
  OMP_PROC_BIND=true same_bits cloth4900 2 1 semi-euler 1
  ! grep 'not timed' bits/timings.csv || fail "ranks share a processor where mssim binds its threads"
fi
for ranks in 1 3 4 5 6 7 8; do same_bits cloth4900 "$ranks" 1 semi-euler,rk4 2; done
same_bits cloth4900 2 2 semi-euler,rk4 2
grep ',mpi,' bits/timings.csv | grep -q 'not timed: 2 ranks of 2 threads on [1-3] processor' || [ "$(nproc)" -ge 4 ] ||
  fail "ranks that share processors are timed: $(cat bits/timings.csv)"

# Pieces that are too small for all of their threads: those that step are told and counted, and only they need processors.
make_scene wide.json cloth2500 's/"rows": 50/"rows": 20/; s/"columns": 50/"columns": 120/'
ends 0 bench --scene ./wide.json --backend mpi:3 --integrator rk4 --threads 2 --rounds 1 --out wide
grep -q ', 3 ranks of 1 to 2 threads, ' wide/timings.csv || fail "threads of the ranks: $(cat wide/timings.csv)"
[ "$(column_of wide/timings.csv threads)" -eq 5 ] || fail "threads of all ranks: $(cat wide/timings.csv)"
make_scene tiny.json cloth2500 's/"rows": 50/"rows": 5/; s/"columns": 50/"columns": 6/'
ends 0 bench --scene ./tiny.json --backend mpi:1 --integrator semi-euler --threads $(($(nproc) + 1)) --rounds 1 --out tiny
! grep 'not timed' tiny/timings.csv || fail "one thread shares a processor"

# What a step spends on messages, and copies that send none.
ends 0 bench --scene cloth4900 --backend mpi:1,mpi:2,mpi-copies:2 --integrator semi-euler --threads 1 --rounds 2 --out costs
sed 's/"[^"]*"//' costs/timings.csv >bare.csv  # notes have commas
all_verified costs 3
[ "$(hashes costs | wc -l)" -eq 1 ] || fail "copies have other bits: $(cat costs/timings.csv)"
[ "$(column_of bare.csv messages_per_step | awk '{ printf "%s ", ($1 <= 1) }')" = '1 1 1 ' ] || fail "messages: $(cat costs/timings.csv)"
if [ "$(nproc)" -ge 2 ]; then
  column_of bare.csv waiting_share | are 'x >= 0 && x < 1' || fail "waiting: $(cat costs/timings.csv)"
  [ "$(column_of bare.csv bytes_per_step | awk '{ printf "%s ", ($1 > 0) }')" = '0 1 0 ' ] || fail "bytes: $(cat costs/timings.csv)"
  column_of bare.csv latency_us | tail -n +2 | are 'x > 0 && x < 1e5' || fail "latency: $(cat costs/timings.csv)"
fi

# What it does not do is said, and what is asked for wrongly.
ends 3 bench --scene cloth2500 --backend openmp,mpi --integrator rk4 --ranks 8 --threads 1 --rounds 1 --out narrow
grep -q 'unsupported: 50 columns cannot be cut for 8 ranks: .* at most 6 ranks' narrow/timings.csv || fail "eight ranks: $(cat narrow/timings.csv)"
ends 3 bench --scene cloth2500 --backend openmp,mpi --integrator xpbd --ranks 2 --threads 1 --rounds 1 --out implicit
grep -q 'unsupported: it has no xpbd' implicit/timings.csv || fail "xpbd: $(cat implicit/timings.csv)"
expect 2 '"0" is' bench --scene cloth2500 --backend mpi --ranks 0

# What launchers and ranks are told, unless the user has told them something else.
make_program one/telling <<<"env >'$work/told'; exec mpirun \"\$@\""
SLURM_OVERLAP=0 ends 0 bench --scene cloth2500 --backend mpi:1 --integrator semi-euler --threads 1 --rounds 1 --launcher one/telling
grep -qx 'OMPI_MCA_btl_vader_eager_limit=65536' told || fail "short messages are not told from long ones: $(cat told)"
grep -qx 'SLURM_OVERLAP=0' told || fail "what the user has told Slurm does not go before: $(cat told)"

# Files of a launcher are looked for where mssim was started, and no launcher is started for more ranks than a scene can be cut for.
echo 'localhost slots=4' >hosts
ends 0 bench --scene cloth2500 --backend mpi:2 --integrator semi-euler --threads 1 --rounds 1 --launcher 'mpirun --hostfile hosts'
rm told
ends 3 bench --scene cloth2500 --backend mpi:5000 --integrator semi-euler --threads 1 --rounds 1 --launcher one/telling --out many
[ ! -e told ] || fail "ranks that have no columns are started"
grep -q 'unsupported: 50 columns cannot be cut for 5000 ranks: .* at most [0-9]* ranks' many/timings.csv || fail "5000 ranks: $(cat many/timings.csv)"
ends 3 bench --scene cloth2500 --backend mpi:2 --integrator semi-euler --rounds 1 --launcher ./hosts --out hostless
grep -q 'unavailable: ./hosts is not an executable file' hostless/timings.csv || fail "./hosts: $(cat hostless/timings.csv)"

# A guide has it, and its other cloths. The smallest would start below the floor if its ripple did not count.
make_scene small.json cloth2500 's/"rows": 50/"rows": 30/; s/"columns": 50/"columns": 30/
  s/"ceiling_height_m": 0.441/"ceiling_height_m": 0.0075/; s/"height_m": 0.0005/"height_m": 0.004/'
ends 0 guide --scene ./small.json --backend openmp,mpi --ranks 2 --threads 1 --integrator semi-euler --horizon 0.01 --time-budget 40 --error 0.1 \
  --out guide
[ "$(column_of guide/guide.csv backend | grep -c '^mpi$')" -ge 2 ] || fail "a guide has no points of mpi: $(cat guide/guide.csv)"
! grep 'failed:' guide/*.csv || fail "mpi fails in a guide"
[ "$(grep -c ',mpi,' guide/guide-sizes.csv)" -ge 2 ] || fail "a guide has no cloths of mpi: $(cat guide/guide-sizes.csv)"

# Names that say how many ranks: rows of their own.
ends 0 bench --scene cloth2500 --backend openmp,mpi:3,mpi:1 --integrator semi-euler --threads 1 --ranks 7 --rounds 1 --out counts
[ "$(column_of counts/timings.csv backend | xargs)" = 'openmp mpi:3 mpi:1' ] || fail "rows: $(cat counts/timings.csv)"
[ "$(column_of counts/timings.csv threads | xargs)" = '1 3 1' ] || fail "ranks: $(cat counts/timings.csv)"
[ "$(hashes counts | wc -l)" -eq 1 ] || fail "mpi:3 has other bits: $(cat counts/timings.csv)"
sed -n '/"mpi:3": {/,/^    }/p' counts/provenance.json | grep -q '"ranks": 3,' ||
  fail "the provenance does not say in how many processes: $(cat counts/provenance.json)"
expect 2 'mpi:0 has an invalid number of ranks: give one from 1 to 65536' bench --scene cloth2500 --backend mpi:0
expect 2 'mpi:two has an invalid number of ranks' bench --scene cloth2500 --backend mpi:two
expect 2 'serial:2 has a number of ranks or threads, which serial does not take' bench --scene cloth2500 --backend serial:2
expect 2 'unknown backend "mpl:2"' bench --scene cloth2500 --backend mpl:2
expect 2 'ranks is for backends that run in several processes, and none of these does' bench --scene cloth2500 --backend openmp --ranks 2
expect 2 'launcher is for backends that run in several processes' run --scene cloth2500 --duration 0.01 --launcher srun
ends 0 list backends
says '^mpi .*on one machine or several'
ends 3 bench --scene cloth2500 --backend openmp,mpi --integrator semi-euler --launcher no-mpirun --rounds 1 --out missing
fails_with 'unavailable: there is no no-mpirun in PATH: install Open MPI' missing

mixed_processors cloth2500 2 cloth2500

# A simulation, to the last bit.
for backend in openmp mpi:2; do
  ends 0 run --scene cloth2500 --backend "$backend" --threads 1 --duration 0.0025 --trace "${backend%:2}.h5"
done
h5diff -q openmp.h5 mpi.h5 /particles/cloth/position/value || fail "run: mpi has other positions than openmp"

# A launcher that fails: too few slots, a host that cannot be reached, an MPI of another kind.
bench=(bench --scene cloth2500 --integrator semi-euler --backend openmp,mpi --threads 1 --rounds 2)
OMPI_MCA_rmaps_base_oversubscribe=0 ends 1 "${bench[@]}" --ranks 3 --launcher "mpirun --host localhost:1" --out slots
fails_with 'has not started 3 ranks: .*not enough slots' slots
make_program one/ssh <<<'echo "ssh: connect to host node7 port 22: No route to host" >&2; exit 255'
make_program two/ssh <<<'sleep 100'
# shellcheck disable=SC2016 # the program expands it
make_program one/other-mpirun <<<'shift 2; "$@" & "$@"'
OMPI_MCA_plm_rsh_agent=$work/one/ssh ends 1 "${bench[@]}" --ranks 2 --launcher "mpirun --host node7,node8" --out route
fails_with 'mpirun --host node7,node8 has not started 2 ranks: ssh: connect to host node7' route
ends 1 "${bench[@]}" --ranks 2 --launcher "$work/one/other-mpirun" --out other
fails_with 'started 1 rank instead of 2' other

# Ranks or launchers that end or fall silent on the way: within 30 seconds, and the other rows are measured. All at
# once.
long=(bench --scene cloth40k --integrator semi-euler --backend openmp,mpi --ranks 2 --threads 1 --rounds 40)
mkdir -p tmp1 tmp2 tmp3 tmp4
seconds=$SECONDS
TMPDIR=$work/tmp1 "$mssim" "${long[@]}" --out killed >/dev/null 2>&1 &
killed=$!
TMPDIR=$work/tmp2 "$mssim" "${long[@]}" --out stopped >/dev/null 2>&1 &
stopped=$!
TMPDIR=$work/tmp3 OMPI_MCA_plm_rsh_agent=$work/two/ssh "$mssim" "${long[@]}" --launcher "mpirun --host node9" --out silent >/dev/null 2>&1 &
silent=$!
TMPDIR=$work/tmp4 "$mssim" "${long[@]}" --out orphaned >/dev/null 2>&1 &
orphaned=$!
victim=$(rank_of 1 "^TMPDIR=$work/tmp1/")
launcher=$(ps -o ppid= -p "$(rank_of 1 "^TMPDIR=$work/tmp4/")")
sleep 2
kill -KILL "$victim" || fail "there is no rank to kill"
kill -KILL "${launcher// /}" || fail "there is no launcher to kill"
frozen=$(rank_of 1 "^TMPDIR=$work/tmp2/")
for ((i = 0; i < 2500; ++i)); do  # mssim continues all ranks before each sample
  kill -STOP "$frozen" 2>/dev/null || break
  sleep 0.01
done
[ "$i" -gt 500 ] || fail "there is no rank to stop"
for process in "$killed" "$stopped" "$silent" "$orphaned"; do
  wait "$process" && fail "a bench with a row that failed is content"
done
echo "failures took $((SECONDS - seconds)) s"
fails_with 'rank 1 .*exited on signal 9' killed
fails_with "has received nothing for 20 seconds from rank 1 on $(uname -n)" stopped
fails_with 'mpirun was ended by signal 9' orphaned
fails_with 'mpirun --host node9 has not started 2 ranks within 25 s' silent

# What was measured beside a row that failed is kept, and the row is measured when the bench goes on.
measured=$(column_of killed/timings.csv rounds | head -n 1)
[ "$measured" -gt 3 ] || fail "the other row is not measured: $(cat killed/timings.csv)"
ends 0 bench --scene cloth40k --integrator semi-euler --backend openmp,mpi --ranks 2 --threads 1 --rounds $((measured + 3)) --resume --out killed
[ "$(grep -c 'true,ok' killed/timings.csv)" -eq 2 ] || fail "--resume does not measure mpi: $(cat killed/timings.csv)"
soon 5 no_rank || fail "a rank is left: $(ranks_here)"
segments=$(find /dev/shm -maxdepth 1 -name '*_segment.*' -newer begun)
[ -z "$segments" ] || fail "ranks leave shared memory behind: $segments"
left=$(find tmp tmp1 tmp2 tmp3 tmp4 -mindepth 1)
[ -z "$left" ] || fail "folders stay behind: $left"
