# Functions of the tests at the command line. Needs $mssim; sets $work, a folder that goes away. A test that has called fail() goes on,
# and in the end exits with 1.
work=$(mktemp -d)
# finish STATUS: what every test ends with
finish() {
  rm -rf "$work"
  if [ "$1" -eq 0 ] && [ "$failures" -gt 0 ]; then echo "$failures failures" && exit 1; fi
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

# ends STATUS ARGUMENTS...: mssim must exit with STATUS; what it says is in $work/out and $work/err
ends() {
  local status=0
  "$mssim" "${@:2}" >"$work/out" 2>"$work/err" </dev/null || status=$?
  [ "$status" -eq "$1" ] || fail "mssim $(printf '%q ' "${@:2}") exits with $status instead of $1: $(cat "$work/out" "$work/err")"
}

# column_of FILE NAME: that column of a CSV file in which no field before it holds a comma
column_of() {
  awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i; next } { print $c }' "$1"
}

# names_of LIST: the first column of mssim list LIST, a line each
names_of() { "$mssim" list "$1" --format csv | awk -F, 'NR > 1 { print $1 }'; }

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
