# Functions of the tests that run mssim or a script, whose first argument is $mssim and second the $source folder. They run in $work, a
# folder that goes away. A test that has called fail() goes on, and in the end exits with 1; one that has called it in a subshell does not.
mssim=$1 source=$2 work=$(mktemp -d)
cd "$work"
# finish STATUS [COMMAND...]: what every test ends with. A test that has more to clear away sets the trap anew, with a COMMAND that runs
# first. One that is skipped from somewhere on (77) has failed if anything before failed.
finish() {
  "${@:2}"
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

# skip WHY: ends the test, which counts as skipped unless something failed before
skip() { echo "skipped: $1" && exit 77; }

# exits STATUS COMMAND...: the command must exit with STATUS; what it says is in $work/out and $work/err
exits() {
  local status=0
  "${@:2}" >"$work/out" 2>"$work/err" </dev/null || status=$?
  [ "$status" -eq "$1" ] || fail "$(printf '%q ' "${@:2}")exits with $status instead of $1: $(cat "$work/out" "$work/err")"
}

# ends STATUS ARGUMENTS...: mssim must do so
ends() { exits "$1" "$mssim" "${@:2}"; }

# refuses STATUS PATTERN COMMAND...: the command must exit with STATUS and say PATTERN on stderr, in one line, with nothing on stdout
refuses() {
  exits "$1" "${@:3}"
  echo "${*:3}: $(cat "$work/err")"
  warns "$2"
  [ "$(wc -l <"$work/err")" -eq 1 ] || fail "stderr has not one line"
  [ ! -s "$work/out" ] || fail "stdout is not empty: $(cat "$work/out")"
}

# expect STATUS PATTERN ARGUMENTS...: mssim must do so
expect() { refuses "$1" "$2" timeout 30 "$mssim" "${@:3}"; }

# runs_limited: whether mssim runs in a limited address space, in which a sanitizer has no room
runs_limited() { (ulimit -v 2000000 && "$mssim" --version) &>/dev/null; }

# says PATTERN, warns PATTERN: what the latest command has said on stdout, on stderr
says() { grep -q -- "$1" "$work/out" || fail "stdout does not say \"$1\": $(cat "$work/out")"; }
warns() { grep -q -- "$1" "$work/err" || fail "stderr does not say \"$1\": $(cat "$work/err")"; }

# saying PATTERN FUNCTION ARGUMENTS..., warning PATTERN FUNCTION ARGUMENTS...: a command, run by ends, exits or a test's own function, has
# said PATTERN on stdout, on stderr
saying() { "${@:2}"; says "$1"; }
warning() { "${@:2}"; warns "$1"; }

# value COLUMN: of the one row that mssim has printed, in which no field behind it holds a blank
value() { awk -v name="$1" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = NF - i } NR == 2 { print $(NF - c) }' "$work/out"; }

# are CONDITION: whether every number on stdin, and there is one, satisfies this condition of awk on x
are() { awk "{ x = \$1; if (!($1)) bad = 1 } END { exit bad || !NR }"; }

# numbers_of TRACE DATASET [OPTIONS OF h5dump...]: the numbers of a dataset, one a line
numbers_of() { h5dump -y -m %.17g -d "$2" "${@:3}" "$1" | sed -n '/DATA {/,/}/p' | grep -o '[-0-9][-+.0-9e]*'; }

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
  # shellcheck disable=SC2016 # the inner shell expands them
  warning "$2" exits 4 bash -c 'ulimit -f "$0" && exec "$@"' "$1" "$mssim" "${@:3}"
}

# make_traces: cloth.h5, double.h5 in double precision, bodies.h5 and garment.h5, each with its energy curve
make_traces() {
  ends 0 run --scene cloth2500 --threads 1 --duration 0.1 --fps 40 --trace cloth.h5 --energy-curve cloth.csv
  ends 0 run --scene cloth2500 --backend serial --precision double --duration 0.02 --fps 100 --trace double.h5 --energy-curve double.csv
  ends 0 run --scene box-small --threads 1 --duration 0.1 --fps 40 --trace bodies.h5 --energy-curve bodies.csv
  ends 0 run --scene jeans1k --threads 1 --fps 5 --trace garment.h5 --energy-curve garment.csv
}

# make_program FILE: a program of the commands of bash on stdin
make_program() { { echo '#!/bin/bash' && cat; } >"$1" && chmod +x "$1"; }

# make_scene FILE SCENE CHANGE: that scene of mssim's, changed by an expression of sed
make_scene() {
  sed "$3" "$source/scenes/$2.json" >"$1"
  ! cmp -s "$source/scenes/$2.json" "$1" || fail "$3 changes nothing in $2"
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

# column_of FILE NAME...: these columns of a CSV file in which no field before them holds a comma, with blanks between them
column_of() {
  awk -F, -v names="${*:2}" '
    NR == 1 { count = split(names, name, " "); for (i = 1; i <= NF; ++i) place[$i] = i; next }
    { for (i = 1; i <= count; ++i) printf "%s%s", $place[name[i]], i < count ? " " : "\n" }' "$1"
}

# of_backend FILE NAME BACKEND: that column of the backend's rows
of_backend() { column_of "$1" backend "$2" | sed -n "s/^$3 //p"; }

# all_verified FOLDER COUNT: it has so many rows, and all are verified
all_verified() {
  [ "$(column_of "$1/timings.csv" verified | sort | uniq -c | xargs)" = "$2 true" ] || fail "not $2 verified rows: $(cat "$1/timings.csv")"
}

# data_of PAGE: the JSON that a report holds
data_of() {
  PYTHONUTF8=1 /usr/bin/python3 -c 'import re, sys; print(re.search(r"id=\"mssim-data\"[^>]*>(.*?)</script>", open(sys.argv[1]).read(), re.S).group(1))' "$1"
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
