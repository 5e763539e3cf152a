#!/usr/bin/env bash
# What a user meets at the command line: exit codes, one clear sentence for each mistake, nothing half-written.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# column NAME: of the latest results
column() { column_of "$work/results/timings.csv" "$1"; }

# Usage.
expect 2 'nothing to measure' bench
OMP_THREAD_LIMIT=1 expect 2 'threads 2 is more than OMP_THREAD_LIMIT allows, 1;' run --threads 2 --scene cloth2500
OMP_THREAD_LIMIT=1 expect 2 'openmp:2 is more than OMP_THREAD_LIMIT allows, 1; give fewer' bench --scene cloth2500 --backend openmp:2
expect 2 'memory.*unified.*copy.*shared' bench --scene cloth2500 --backend hybrid --memory unified
expect 2 'memory.*unified.*copy.*shared' run --scene cloth2500 --memory unified
expect 2 "known are $(names_of backends | paste -sd, | sed 's/,/, /g; s/\(.*\), /\1 and /')" bench --scene cloth2500 --backend cuda
expect 2 '/no/such/scene.json' bench --scene /no/such/scene.json
expect 2 'did you mean gather?): known are serial, mutex-per-group' bench --suite races --backend gahter
expect 2 'unknown backend "atomic"' bench --scene cloth2500 --backend atomic
expect 2 'duration' run --scene cloth2500 --duration 1e-9
expect 2 'fps' run --scene cloth2500 --fps 1e9
# As few frames as one wants: the first and the last.
ends 0 run --scene cloth2500 --duration 0.0002 --backend serial --fps 1e-16 --energy-curve few.csv
[ "$(grep -c '^[0-9]' few.csv)" -eq 2 ] || fail "frames: $(cat few.csv)"
expect 2 'dt' run --scene cloth2500 --dt -1
expect 2 'serial or openmp, not "hybrid"' run --scene cloth2500 --backend hybrid --precision double
expect 2 'garment .* --backend serial, not "openmp"' run --scene jeans1k --backend openmp --precision double
expect 2 'implicit .* --backend serial, not "openmp:double"' run --scene cloth2500 --backend openmp:double --integrator newton-euler
ends 0 run --scene cloth2500 --backend openmp --precision double --duration 0.01
make_scene exact.json cloth2500 's/"kind": "cloth",/&\n  "implicit": {"tolerance": 1e-300, "fast_springs_iterations": 10, "xpbd_substeps": 1},/'
ends 0 run --scene ./exact.json --backend serial --integrator implicit-euler --dt 0.05 --duration 0.1
warns 'serial: .*before its tolerance in 2 of 2 steps'
expect 2 'precision single cannot be used with --backend openmp:double' run --scene cloth2500 --backend openmp:double --precision single

# Rows in double precision differ from the reference by their roundings only.
ends 0 bench --scene cloth2500,torus-small --backend serial:double,openmp:double --integrator rk4 --threads 1,2 \
  --rounds 1 --out "$work/double"
rows='serial:double openmp:double:1 openmp:double'
[ "$(column_of "$work/double/timings.csv" backend | paste -sd ' ')" == "$rows $rows" ] || fail "rows: $(cat "$work/double/timings.csv")"
column_of double/timings.csv position_error | are 'x < 1e-9' ||
  fail "in double precision: $(column_of "$work/double/timings.csv" position_error)"

# Plans.
ends 0 bench --suite table1 --dry-run --out "$work/never"
[ "$(grep -c '^cloth' "$work/out")" -eq 6 ] || fail "--dry-run does not name the six cloths"
says '^about [0-9]* s in all$'
# 300 frames of 333 steps take longer than the samples.
one_row=(bench --scene cloth2500 --backend serial --integrator rk4 --rounds 1 --dry-run)
ends 0 "${one_row[@]}"
without=$(sed -n 's/^about \([0-9]*\) s in all$/\1/p' "$work/out")
ends 0 "${one_row[@]}" --fps 60
(($(sed -n 's/^about \([0-9]*\) s in all$/\1/p' "$work/out") > without + 10)) || fail "--dry-run with --fps: $(cat "$work/out")"
# Frames of more steps than samples may have are not timed.
ends 0 bench --scene cloth350k --backend serial --integrator rk4 --rounds 1 --dry-run
cp "$work/out" "$work/without"
ends 0 bench --scene cloth350k --backend serial --integrator rk4 --rounds 1 --dry-run --fps 60
diff "$work/without" "$work/out" || fail "--dry-run forecasts frames that are not timed"
ends 0 bench --suite table2 --dry-run
[ ! -e "$work/never" ] || fail "--dry-run has made a folder"
ends 0 bench --scene cloth2500 --dry-run --format csv
[ "$(cut -d, -f1 "$work/out" | xargs)" = 'scene cloth2500' ] || fail "--dry-run --format csv: $(cat "$work/out")"
expect 2 'github is of times, which --dry-run does not measure' bench --scene cloth2500 --dry-run --format github
for format in csv json; do
  expect 2 'of one table, .*: ask for --suite table2 alone' bench --suite table2 --scene cloth2500 --format $format --out "$work/never"
  [ ! -e "$work/never" ] || fail "a folder is made for what is refused"
done
expect 2 'too short: one round of all this takes about [0-9]* s' bench --suite table1 --time-budget 5
expect 2 'time-budget' bench --scene cloth2500 --time-budget nan

# Scenes.
make_scene huge.json cloth2500 's/"rows": 50/"rows": 1000000/; s/"columns": 50/"columns": 4000/'
expect 2 'huge.json.*GB.*name fewer with --backend' bench --scene "$work/huge.json" --out "$work/never"

# Devices and files.
expect 3 'no such device' run --scene cloth2500 --backend opencl --device 'no such device'
expect 4 'not-a-folder' bench --scene cloth2500 --out "$work/huge.json/not-a-folder"
expect 4 'no/such' run --scene cloth2500 --duration 0.01 --trace "$work/no/such/trace.h5"
[ -z "$(find "$work" -name '*.part' -o -name never)" ] || fail "something half-written is left"

# A simulation that blows up: named, and not verified.
make_scene wild.json cloth2500 's/"dt_s": 5e-5/"dt_s": 1e-2/'
expect 1 'blew up at step [0-9]* (t = .* s): node [0-9]* is not finite .* dt_s or "auto"$' run --scene "$work/wild.json"
expect 1 'blew up at step .* --dt, or leave it out$' run --scene cloth2500 --dt 1e-2
expect 1 'blew up before step .* --dt, or leave it out$' run --scene jeans1k --dt 1.5e-3
ends 1 bench --scene "$work/wild.json" --backend serial,openmp --rounds 2 --out "$work/results"
[ "$(column verified | sort -u)" = false ] || fail "a row that blew up is verified"
[ "$(grep -c '^mssim: wild, \(serial\|openmp\), [a-z0-9-]*: failed: ' "$work/err")" -eq 3 ] && grep -q '^mssim: and 3 more$' "$work/err" ||
  fail "stderr does not say which rows failed and why: $(cat "$work/err")"
grep -q '"\?failed: .*blew up at step' "$work/results/timings.csv" || fail "timings.csv does not say what failed"

# Data copied between host and device: the rows that do so say it.
ends 0 bench --scene cloth2500 --integrator semi-euler --rounds 2 --threads 2 --memory copy --out "$work/results" --overwrite
[ "$(column verified | sort -u)" = true ] || fail "not every row is verified with copied memory"
[ "$(column device | grep -c '(copied memory)$')" -eq 2 ] || fail "not two rows say that memory is copied"

# A device that was named is missed before anything is measured.
for command in 'bench --scene cloth2500' 'bench --scene cloth2500 --dry-run' 'bench --suite guide --dry-run' 'guide --scene cloth2500' 'list backends' \
  'run --scene cloth2500 --backend hybrid'; do
  # shellcheck disable=SC2086
  expect 3 'no OpenCL device has "nothing".*there are: 0 (' $command --device nothing
done
# A list that would not use an option refuses it.
expect 2 'list devices takes no --device' list devices --device 0
expect 2 '--instruction-set is for backends that have vector code .*leave it out' run --scene cloth2500 --backend serial --instruction-set AVX2
make_program own-program <<<'exit 3'
expect 2 'precision single cannot be used with --backend .*own-program, which chooses its precision itself' \
  run --scene cloth2500 --backend "$work/own-program" --precision single
for arguments in "--format github" "--dry-run --format json" "--dry-run --format csv"; do
  # shellcheck disable=SC2086 # words of their own
  expect 2 '--format.* is of scenes that are timed, and there are none: leave it out' bench --suite table2 $arguments --out "$work/never"
done
expect 2 '--view: "361,0" is not a view; .*up to 360 and 90' render --scene cloth2500 --view 361,0
expect 2 '--device is for backends that use OpenCL' run --scene cloth2500 --device 0
expect 2 'list scenes takes no --backend-folder' list scenes --backend-folder "$work"
expect 2 'list schema takes no --format' list schema --format csv

# The methods to avoid the data race: those asked for, and the base of the ratios where it is one of them.
ends 0 bench --suite races --backend serial,gather --rounds 2 --threads 2 --out "$work/races"
[ "$(wc -l <"$work/races/races.csv")" -eq 5 ] || fail "races.csv has not four methods: $(cat "$work/races/races.csv")"
[ "$(grep -c ',yes,ok$' "$work/races/races.csv")" -eq 4 ] || fail "races.csv: $(cat "$work/races/races.csv")"
[ -s "$work/races/races.md" ] || fail "races.md is missing"
[ ! -e "$work/races/table1.csv" ] || fail "races make Table 1"

# Help and listings.
"$mssim" list scenes --format csv | grep '^cloth350k,cloth,350000,2094002,4188004,' >/dev/null || fail "list scenes"
[ "$("$mssim" list integrators --format json | grep -c '"order"')" -eq "$(names_of integrators | wc -l)" ] || fail "list integrators"
"$mssim" list backends | grep '^hybrid ' >/dev/null || fail "list backends"
"$mssim" list methods --format csv | grep '^thread-private,12 bytes a node and thread,once,' >/dev/null || fail "list methods"
"$mssim" list suites --format csv | grep '^scaling,true,false,"cloth40k, .* and cloth16m",' >/dev/null || fail "list suites"
"$mssim" bench --help | tr -s '\n ' ' ' | grep 'tables stands for table1, table2 and table3' >/dev/null || fail "bench --help does not say what tables is"
