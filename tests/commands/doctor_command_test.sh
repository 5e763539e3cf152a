#!/usr/bin/env bash
# What mssim doctor finds here, and where something is missing. $1: mssim, $2: the source folder, $3: the emulator, if there is one
set -euo pipefail
. "$2/tests/support/command_line.sh"

# field ITEM COLUMN: of the CSV in $work/out, whose fields before it hold no comma
field() { awk -F, -v item="$1" -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i } $1 == item { print $c }' out; }

# is ITEM STATE: the table says so
is() { says "^$2  *$1\( \|\$\)"; }

# This machine, which runs tests.
ends 0 doctor
is 'main job' ok
for item in processor threads 'processor caches' affinity 'container limits' governor load memory 'energy counters' 'event counters' \
  'OpenCL de' TetGen MPI font 'cache of meshes' 'cache of references'; do
  says "^\(ok\|limited\|missing\)  *$item"
done
[ ! -s err ] || fail "stderr is not empty: $(cat err)"
awk 'length > 80 && !/\//' out >wide # a path stays whole
[ ! -s wide ] || fail "lines of more than 80 characters: $(cat wide)"
ends 0 doctor --format csv
[ "$(head -n 1 out)" = item,state,found,use,remedy ] || fail "columns: $(head -n 1 out)"
[ "$(field 'main job' state)" = ok ] || fail "main job: $(cat out)"
awk -F, 'NR > 1 && $2 == "ok" && $NF != "" { print }' out >surplus
[ ! -s surplus ] || fail "remedies of what is there: $(cat surplus)"
awk -F, 'NR > 1 && $2 != "ok" && $NF == "" { print }' out >bare
[ ! -s bare ] || fail "no remedy: $(cat bare)"
saying '"item": "TetGen"' ends 0 doctor --format json

# Without programs, drivers and places for caches the main job runs, and each is named with its package.
mkdir none
PATH=$work/none ends 0 doctor
is TetGen missing
says 'package tetgen'
OCL_ICD_VENDORS=$work/none ends 0 doctor
is 'OpenCL device' missing
says 'pocl-opencl-icd'
echo "$(cd "${mssim%/*}/../fake_opencl" && pwd)/deviceless_driver.so" >none/fake.icd
OCL_ICD_VENDORS=$work/none ends 0 doctor
is 'OpenCL driver' limited
says 'A fake driver'
env -u XDG_CACHE_HOME HOME=/dev/null "$mssim" doctor >out 2>err || fail "without a place for caches: $? $(cat err)"
is 'cache of meshes' limited
says XDG_CACHE_HOME

# The CPUs that threads may use.
if cpus=$(taskset -pc $$ 2>/dev/null | sed 's/.*: //') && [ "$(nproc)" -gt 1 ]; then
  OMP_PROC_BIND=true taskset -c "${cpus%%[-,]*}" "$mssim" doctor >out 2>err || fail "on one CPU: $? $(cat err)"
  is affinity limited
  says '^limited  *affinity  *1 of '
  is threads ok
else
  echo "not tried: fewer CPUs (there is one, or no taskset)"
fi

# Where the main job cannot run, doctor says all the same what is there, and ends as bench does.
if [ $# -gt 2 ]; then
  echo "not tried: mssim without its data (an emulator runs it)"
else
  mkdir -p alone/bin
  cp "$mssim" alone/bin/mssim
  mssim=$work/alone/bin/mssim
  warning '^mssim: .*alone/share/mssim' ends 4 bench --scene cloth2500 --backend serial,openmp
  ends 4 doctor
  is 'main job' missing
  says '^ok  *threads'
fi
