#!/usr/bin/env bash
# What mssim doctor finds here, and where something is missing. $1: mssim, $2: the source folder, $3: the emulator, if there is one
set -euo pipefail
. "$2/tests/support/command_line.sh"

# state ITEM: of the CSV in $work/out
state() { column_of out item state | sed -n "s/^$1 //p"; }

# is ITEM STATE: the table says so
is() { says "^$2  *$1\( \|\$\)"; }

# This machine, which runs tests.
ends 0 doctor
is 'main job' ok
for item in processor threads 'processor caches' affinity 'container limits' governor load memory 'energy counters' 'event counters' \
  'OpenCL de' TetGen MPI 'temporary folder' font 'cache of meshes' 'cache of references'; do
  says "^\(ok\|limited\|missing\)  *$item"
done
[ ! -s err ] || fail "stderr is not empty: $(cat err)"
awk 'length > 80 && !/\//' out >wide # a path stays whole
[ ! -s wide ] || fail "lines of more than 80 characters: $(cat wide)"
ends 0 doctor --format csv
[ "$(head -n 1 out)" = item,state,found,use,remedy ] || fail "columns: $(head -n 1 out)"
[ "$(state 'main job')" = ok ] || fail "main job: $(cat out)"
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
exits 0 env -u XDG_CACHE_HOME HOME=/dev/null "$mssim" doctor
is 'cache of meshes' limited
says XDG_CACHE_HOME

mkdir -p caches/mssim
ln -s "$work/nowhere/deep" caches/mssim/meshes # not even root can use or make it
XDG_CACHE_HOME=$work/caches TMPDIR=$work/nowhere saying TMPDIR ends 0 doctor
is 'cache of meshes' limited
is 'cache of references' ok
is 'temporary folder' missing

# Open MPI needs leave to run as root. Other launchers do not, and stand-ins serve other users.
mkdir launchers
make_program launchers/mpirun <<<'echo "mpirun (Open MPI) 4.1.4"'
leave='OMPI_ALLOW_RUN_AS_ROOT=1 and OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1'
# mpi_as LEAVE...: what doctor says of MPI, with these variables
mpi_as() { env -u OMPI_ALLOW_RUN_AS_ROOT -u OMPI_ALLOW_RUN_AS_ROOT_CONFIRM PATH="$work/launchers:$PATH" "$@" "$mssim" doctor --format csv >out 2>err; }
mpi_as
if [ "$(state MPI)" = missing ]; then
  echo "not tried: launchers of MPI (this build has no backend mpi)"
else
  wanted=ok
  [ "$EUID" -ne 0 ] || wanted=limited
  [ "$(state MPI)" = $wanted ] || fail "MPI without leave is not $wanted: $(cat out)"
  [ $wanted = ok ] || says "$leave"
  mpi_as OMPI_ALLOW_RUN_AS_ROOT=1
  [ "$(state MPI)" = $wanted ] || fail "MPI with half a leave is not $wanted: $(cat out)"
  mpi_as OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  [ "$(state MPI)" = ok ] || fail "MPI with leave: $(cat out)"
  make_program launchers/mpirun <<<'echo "HYDRA build details"'
  mpi_as
  [ "$(state MPI)" = ok ] || fail "another MPI: $(cat out)"
  dashes=$(printf '%76s' '' | tr ' ' -)
  make_program launchers/mpirun <<END
printf "%s\\n" $dashes "mpirun has detected an attempt to run as root." "" "Running as root is strongly discouraged." $dashes >&2
exit 1
END
  warning "attempt to run as root; set $leave" ends 1 bench --scene cloth2500 --backend mpi:2 --integrator semi-euler --rounds 1 \
    --launcher "$work/launchers/mpirun"
  TMPDIR=$work/nowhere expect 4 'set TMPDIR' run --scene cloth2500 --duration 0.001 --backend mpi
fi

# The CPUs that threads may use.
if cpus=$(taskset -pc $$ 2>/dev/null | sed 's/.*: //') && [ "$(nproc)" -gt 1 ]; then
  OMP_PROC_BIND=true exits 0 taskset -c "${cpus%%[-,]*}" "$mssim" doctor
  is affinity limited
  says '^limited  *affinity  *1 of '
  is threads ok
  # Where OpenMP puts all threads on one CPU, or understands nothing and lets them move.
  OMP_PROC_BIND=master saying OMP_PROC_BIND=true ends 0 doctor
  is affinity limited
  # clang's OpenMP then has one place, of all CPUs.
  GOMP_CPU_AFFINITY=9999 saying 'OMP_PROC_BIND=true\|OMP_PLACES=threads' ends 0 doctor
  is affinity limited
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
