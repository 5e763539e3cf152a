#!/usr/bin/env bash
# Garments are timed, dressed and verified from the command line like any scene.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# has FILE NAME BACKEND VALUE: in the one row of the backend
has() { [ "$(of_backend "$1" "$2" "$3")" = "$4" ] || fail "$1: $2 of $3 is \"$(of_backend "$1" "$2" "$3")\", not \"$4\""; }

# A garment is dressed by each backend, verified and timed.
jeans=(--scene jeans1k --backend "serial,openmp" --integrator semi-euler --threads 1)
ends 0 bench "${jeans[@]}" --rounds 1 --out jeans
for backend in serial openmp; do
  for yes in verified settled largest_gap_mm_within deepest_node_mm_within deepest_face_mm_within elongation_99_within \
    elongation_999_within upper_edge_rise_mm_within crotch_rise_mm_within rows_astray_within side_distance_mm_within; do
    has jeans/garment.csv "$yes" "$backend" true
  done
  has jeans/garment.csv status "$backend" ok
  has jeans/timings.csv verified "$backend" true
  # What was never published or cannot be counted is not made up.
  for none in springs_published gigabytes_per_second roofline_fraction paper_ms; do has jeans/timings.csv "$none" "$backend" ""; done
  awk -v ms="$(of_backend jeans/garment.csv ms_per_iteration "$backend")" -v ns="$(of_backend jeans/garment.csv ns_per_iteration_and_vertex "$backend")" \
    'BEGIN { exit !(ms > 0 && ns / (ms * 1e6 / 1054) > 0.999 && ns / (ms * 1e6 / 1054) < 1.001) }' || fail "times of $backend"
done
has jeans/garment.csv speedup_vs_serial serial 1
grep -q '^| with: .openmp. | \*\*[0-9.]*\*\* ([0-9.]*×) |$' jeans/figure6.md || fail "figure6.md: $(cat jeans/figure6.md)"
grep -q '^serial,semi-euler,without,ms_per_iteration,[0-9.e-]*$' jeans/figure6.csv || fail "figure6.csv: $(cat jeans/figure6.csv)"
grep -q '"name": "jeans1k/openmp/semi-euler"' jeans/benchmark.json || fail "benchmark.json"

# The dressing is the one that mssim run shows.
ends 0 run --scene jeans1k --backend openmp --threads 1
has jeans/garment.csv dressing_iterations openmp "$(value iterations)"

# --resume adds rounds and does not dress again; then nothing is left to do.
dressed=$(of_backend jeans/garment.csv dressing_s serial)$(of_backend jeans/garment.csv dressing_s openmp)
ends 0 bench "${jeans[@]}" --rounds 2 --out jeans --resume
has jeans/timings.csv rounds serial 2
[ "$(of_backend jeans/garment.csv dressing_s serial)$(of_backend jeans/garment.csv dressing_s openmp)" = "$dressed" ] || fail "--resume dresses again"
before=$(cat jeans/garment.csv)
ends 0 bench "${jeans[@]}" --rounds 2 --out jeans --resume
[ "$(cat jeans/garment.csv)" = "$before" ] || fail "a finished folder is changed"

# What cannot dress is a row that says why, and an error only where it was asked for.
ends 0 bench --scene jeans1k --rounds 1 --format csv
backends=$(backends_for cloth)
others=$(comm -23 <(sort <<<"$backends") <(backends_for garment | sort))
[ -n "$others" ] || fail "every backend dresses"
[ "$(wc -l <out)" -eq $((3 * $(wc -w <<<"$backends") + 1)) ] || fail "there are not three rows for each backend and a header"
[ "$(grep -Ec '^jeans1k,1054,,semi-euler,(serial|openmp),.*,true,ok$' out)" -eq 2 ] || fail "not both rows are ok: $(cat out)"
[ "$(grep -Ec '^jeans1k,.*,('"${others//$'\n'/|}"'),.*,false,"?unsupported: .*garments' out)" -eq $((3 * $(wc -w <<<"$others"))) ] ||
  fail "backends that do not dress are not unsupported: $(cat out)"
[ "$(grep -Ec '^jeans1k,.*,(midpoint|rk4),(serial|openmp),.*,false,"?unsupported: only semi-euler ' out)" -eq 4 ] || fail "four are not semi-euler: $(cat out)"
ends 0 bench --scene jeans1k --backend openmp --rounds 1 --format github
says '"jeans1k/openmp/semi-euler"'
ends 3 bench --scene jeans1k --backend openmp,hybrid --rounds 1
ends 3 bench --scene jeans1k --backend openmp --integrator rk4 --rounds 1 --format json
says '"status": "unsupported: only semi-euler '

# Algorithm 1 as printed: four rows, each verified against itself and timed, whether it fits or not.
printed="algorithm1 algorithm1-simd algorithm1-threads algorithm1-threads-simd"
"$mssim" list backends --format csv >out
grep -q '^serial,cloth+bodies+garment,' out && grep -q '^hybrid,cloth+bodies,' out || fail "list backends: $(cat out)"
for backend in $printed; do grep -q "^$backend,garment,,true," out || fail "list backends: $(cat out)"; done
ends 0 bench --scene jeans1k --backend "serial,${printed// /,}" --integrator semi-euler --threads 2 --rounds 1 --out printed
for backend in $printed; do
  has printed/timings.csv verified "$backend" true
  has printed/garment.csv status "$backend" ok
  [ -n "$(of_backend printed/garment.csv dressing_iterations "$backend")" ] || fail "$backend has not dressed"
  case $backend in
    *threads*) has printed/timings.csv threads "$backend" 2 ;;
    *) has printed/timings.csv threads "$backend" 1 ;;
  esac
done
[ "$(of_backend printed/timings.csv state_hash algorithm1)" = "$(of_backend printed/timings.csv state_hash algorithm1-threads-simd)" ] ||
  fail "SIMD instructions or threads change the result: $(cat printed/timings.csv)"
for line in 'without: .algorithm1.' 'without: .algorithm1-simd.' 'with: .algorithm1-threads.' 'with: .algorithm1-threads-simd.'; do
  grep -q "as printed, $line | \*\*" printed/figure6.md || fail "figure6.md has no line $line: $(cat printed/figure6.md)"
done
grep -q 'i7-4702MQ' printed/figure6.md && grep -q 'Cortex-A17' printed/figure6.md || fail "figure6.md does not name the paper's devices"
grep -q '^algorithm1-threads,semi-euler,with,ms_per_iteration,[0-9.e-]*$' printed/figure6.csv || fail "figure6.csv: $(cat printed/figure6.csv)"
ends 0 report printed --no-runs --out printed.html
for claim in parallel-iterations simd-is-faster; do
  grep -Eo "\"name\": ?\"$claim\"[^}]*" printed.html >out || fail "the report has no claim $claim"
  ! grep -q 'not testable' out || fail "$claim is not judged: $(cat out)"
done
ends 3 bench --scene cloth2500 --backend serial,algorithm1 --integrator semi-euler --rounds 1 --out cloth
grep -q 'algorithm1.*unsupported: .*garments' cloth/timings.csv || fail "a cloth: $(cat cloth/timings.csv)"

# What does not fit is no result.
make_scene slack.json jeans1k 's/"correction": "bounded"/"correction": "none"/; s/"bounded": {[^}]*}/"none": {}/; s/": 200,/": 60,/'
ends 1 bench --scene slack.json --backend serial --integrator semi-euler --rounds 1 --out slack
grep -q 'failed: dressed, .*the 99th percentile of elongations is [0-9.]* %, beyond 6 %' slack/timings.csv || fail "slack: $(cat slack/timings.csv)"
has slack/garment.csv ms_per_iteration serial ""
has slack/garment.csv verified serial false
head -n 1 slack/garment.csv | grep elongation_999_within >/dev/null || fail "the fit of what does not fit is not told"

# Plans, budgets, and what does not go with a garment.
ends 0 bench --suite garment --dry-run
[ "$(grep -c '^jeans[0-9]*k ' out)" -eq 6 ] || fail "the plan has not six jeans: $(cat out)"
combinations() { awk -v scene="$1" '$1 == scene { print $4 }' out; }
[ $(($(combinations jeans16k) - $(combinations jeans64k))) -eq "$(wc -w <<<"$printed")" ] ||
  fail "jeans64k does not leave out the rows of Algorithm 1: $(cat out)"
awk '/^about/ { exit !($2 > 20 && $2 < 600) }' out || fail "the suite is expected to take $(tail -n 1 out)"
expect 2 'time-budget is too short' bench --scene jeans1k --time-budget 0.1
expect 2 '.--trace cannot be used with jeans1k, which is a garment: .*mssim run --trace' bench --scene jeans1k --trace --out traced
[ ! -e traced ] || fail "a folder is made for what is refused"
ends 0 bench --scene jeans1k --backend serial --integrator semi-euler --time-budget 20 --rounds 2 --format json
"$mssim" list scenes --format csv >out
says '^jeans1k,garment,[0-9]*,[0-9]*,,'

# Ctrl-C while it dresses ends it soon, and says that there is nothing yet.
begins bench --scene jeans64k --backend serial --integrator semi-euler --out stopped
soon 30 test -e stopped/provenance.json || fail "no folder is begun"
sleep 1
is_ended 130 INT
warns 'nothing was measured yet'
[ ! -e stopped/timings.csv ] || fail "there are times of what was not timed"
