# Functions of the tests at the command line, whose first argument is $mssim and second the $source folder. They run in $work, a folder
# that goes away. A test that has called fail() goes on, and in the end exits with 1.
mssim=$1 source=$2 work=$(mktemp -d)
cd "$work"
# finish STATUS: what every test ends with. One that is skipped from somewhere on (77) has failed if anything before failed.
finish() {
  rm -rf "$work"
  if { [ "$1" -eq 0 ] || [ "$1" -eq 77 ]; } && [ "$failures" -gt 0 ]; then echo "$failures failures" && exit 1; fi
}
trap 'finish $?' EXIT
export POCL_CACHE_DIR=${mssim%/*}/../pocl  # kernels compile for seconds
failures=0

fail() {
  echo "FAILED: $1"
  failures=$((failures + 1))
}

# expect STATUS PATTERN ARGUMENTS...: mssim must exit with STATUS and say PATTERN on stderr, in one line, with nothing on stdout
expect() {
  local wanted=$1 pattern=$2 status=0
  shift 2
  timeout 30 "$mssim" "$@" >"$work/out" 2>"$work/err" </dev/null || status=$?
  echo "mssim $*: $status $(cat "$work/err")"
  [ "$status" -eq "$wanted" ] || fail "exit status $status instead of $wanted"
  grep -q -- "$pattern" "$work/err" || fail "stderr does not say \"$pattern\""
  [ "$(wc -l <"$work/err")" -eq 1 ] || fail "stderr has not one line"
  [ ! -s "$work/out" ] || fail "stdout is not empty"
}

# runs_limited: whether mssim runs in a limited address space, in which a sanitizer has no room
runs_limited() { (ulimit -v 2000000 && "$mssim" --version) &>/dev/null; }

# ends STATUS ARGUMENTS...: mssim must exit with STATUS; what it says is in $work/out and $work/err
ends() {
  local status=0
  "$mssim" "${@:2}" >"$work/out" 2>"$work/err" </dev/null || status=$?
  [ "$status" -eq "$1" ] || fail "mssim $(printf '%q ' "${@:2}") exits with $status instead of $1: $(cat "$work/out" "$work/err")"
}

# says PATTERN, warns PATTERN: what mssim has said on stdout, on stderr
says() { grep -q -- "$1" "$work/out" || fail "stdout does not say \"$1\": $(cat "$work/out")"; }
warns() { grep -q -- "$1" "$work/err" || fail "stderr does not say \"$1\": $(cat "$work/err")"; }

# saying PATTERN FUNCTION ARGUMENTS..., warning PATTERN FUNCTION ARGUMENTS...: runs mssim by ends, or by a test's own function, and then
# it has said PATTERN on stdout, on stderr
saying() { "${@:2}"; says "$1"; }
warning() { "${@:2}"; warns "$1"; }

# value COLUMN: of the one row that mssim has printed, in which no field behind it holds a blank
value() { awk -v name="$1" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = NF - i } NR == 2 { print $(NF - c) }' "$work/out"; }

# begins ARGUMENTS...: mssim runs beside the test, as $process. Shells start such programs with SIGINT ignored; env puts it back.
begins() {
  true >"$work/out" 2>"$work/err"  # nobody takes what an earlier run has said for this one's
  env --default-signal=INT,QUIT "$mssim" "$@" >"$work/out" 2>"$work/err" </dev/null &
  process=$!
}

# soon SECONDS COMMAND...: waits until the command succeeds, no longer than that
soon() {
  local i
  for ((i = 0; i < 10 * $1; ++i)); do
    "${@:2}" 2>/dev/null && return
    sleep 0.1
  done
  return 1
}

# is_ended STATUS SIGNAL [SECONDS COMMAND...]: $process is sent the signal, and must exit with STATUS; before, the command must succeed
# within SECONDS
is_ended() {
  local status=0
  [ $# -eq 2 ] || soon "${@:3}" || fail "mssim has not come so far: ${*:4}: $(cat "$work/err")"
  kill -"$2" "$process" || fail "mssim ended before SIG$2: $(cat "$work/err")"
  wait "$process" || status=$?
  [ "$status" -eq "$1" ] || fail "SIG$2 gives exit status $status instead of $1: $(cat "$work/err")"
}

# is_gone PROCESS
is_gone() { ! kill -0 "$1" 2>/dev/null; }

# on_full_disk KIB PATTERN ARGUMENTS...: mssim, whose files may not be larger, must exit with 4 and say PATTERN on stderr
on_full_disk() {
  local most=$1 pattern=$2 status=0
  shift 2
  (ulimit -f "$most" && exec "$mssim" "$@" >"$work/out" 2>"$work/err") || status=$?
  [ "$status" -eq 4 ] || fail "a full disk gives exit status $status: $(cat "$work/err")"
  warns "$pattern"
}

# bodies_scene FILE FLOOR BODY...: makes a scene of these bodies above a floor at FLOOR
bodies_scene() {
  local file=$1 floor=$2
  shift 2
  cat >"$file" <<END
{"kind": "bodies", "description": "of a test", "dt_s": 5e-5, "gravity_m_per_s2": 9.81, "viscous_damping_per_s": 0.1,
 "floor": {"height_m": $floor, "restitution": 0.5, "friction": 0.4},
 "bodies": {"density_kg_per_m3": 1000, "springs": {"stiffness_n_per_m": 10000, "damping_n_s_per_m": 0.5},
  "list": [$(IFS=,; echo "$*")]}}
END
}

# make_run FOLDER BACKEND=MS[:SPREAD][:COUNT]...: a result folder in which only times and rounds are made up: COUNT samples of each backend
# (15), spread evenly about MS by at most that fraction (0.02), and MS as the time per step of its row
make_run() {
  local folder=$1 of=$source/results/table1/zen5 backend ms spread count pair file
  rm -rf "$folder"
  mkdir "$folder"
  cp "$of/provenance.json" "$folder"
  for file in timings samples; do head -n 1 "$of/$file.csv" >"$folder/$file.csv"; done
  for pair in "${@:2}"; do
    backend=${pair%%=*}
    IFS=: read -r ms spread count <<<"${pair#*=}"
    awk -F, -v OFS=, -v b="$backend" -v ms="$ms" -v n="${count:-15}" 'NR == 1 { for (i = 1; i <= NF; ++i) c[$i] = i; next }
      $c["scene"] == "cloth2500" && $c["backend"] == b && $c["integrator"] == "semi-euler" {
        $c["ms_per_step"] = ms; $c["ms_per_step_low"] = 0.99 * ms; $c["ms_per_step_high"] = 1.01 * ms; $c["rounds"] = n; print
      }' "$of/timings.csv" >>"$folder/timings.csv"
    awk -v b="$backend" -v ms="$ms" -v s="${spread:-0.02}" -v n="${count:-15}" 'BEGIN {
        for (i = 1; i <= n; ++i) print "cloth2500," b ",semi-euler," i ",10," ms * (1 + s * (2 * (i - 1) / (n - 1) - 1)) ","
      }' >>"$folder/samples.csv"
  done
}

# column_of FILE NAME: that column of a CSV file in which no field before it holds a comma
column_of() {
  awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i; next } { print $c }' "$1"
}

# names_of LIST: the first column of mssim list LIST, a line each
names_of() { "$mssim" list "$1" --format csv | awk -F, 'NR > 1 { print $1 }'; }

# backends_for KIND: the names of mssim's backends that step scenes of that kind (cloth, bodies, garment), a line each. Without mpi and
# mpi-copies, which are measured only on request.
backends_for() { "$mssim" list backends --format csv | awk -F, -v kind="$1" '$1 !~ /^mpi/ && "+" $2 "+" ~ "[+]" kind "[+]" { print $1 }'; }

# explicit_integrators: their names, a line each
explicit_integrators() { "$mssim" list integrators --format csv | awk -F, 'NR > 1 && $4 != "" { print $1 }'; }

# run_python SOURCE SCRIPT ARGUMENTS...: SOURCE/tests/SCRIPT, by the Python with the modules that read traces: that of .ci/run
# (scripts/lib/readers.sh), else Debian's own
run_python() {
  local source=$1 script=$2 python=$1/build/readers/bin/python
  shift 2
  [ -x "$python" ] || python=/usr/bin/python3
  PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$source/tests/support "$python" -W ignore "$source/tests/$script" "$@"
}
