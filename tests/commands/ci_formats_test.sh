#!/usr/bin/env bash
# Results in the formats that other tools read: Google Benchmark's compare.py and github-action-benchmark.
set -euo pipefail
. "$2/tests/support/command_line.sh"

bench=(bench --scene cloth2500 --backend serial,opencl --integrator semi-euler,rk4 --threads 1 --rounds 3)
"$mssim" "${bench[@]}" --format github --out a >github.json 2>err || fail "a bench exits with $?: $(cat err)"
"$mssim" "${bench[@]}" --verified a --format csv --out b >table.csv 2>err || fail "a bench exits with $?: $(cat err)"

# Google Benchmark's own tool takes benchmark.json as it is and compares every combination, by a U test too.
/usr/bin/python3 /usr/share/benchmark/compare.py --no-color benchmarks a/benchmark.json b/benchmark.json >compared 2>err ||
  fail "compare.py exits with $?: $(tail -n 1 err)"
for backend in serial opencl; do
  for integrator in semi-euler rk4; do
    for what in _median _mean _stddev _pvalue; do
      grep -q "^cloth2500/$backend/$integrator$what " compared || fail "compare.py shows no $backend/$integrator$what"
    done
    [ "$(grep -c "^cloth2500/$backend/$integrator " compared)" -eq 3 ] || fail "compare.py shows not all samples of $backend"
  done
done

# github-action-benchmark's own format: on stdout, and in the folder.
cmp -s github.json a/github.json || fail "a/github.json is not what was printed"
[ ! -e b/github.json ] || fail "github.json is written unasked"
/usr/bin/python3 - a <<'END' || fail "github.json is not what github-action-benchmark reads"
import csv, json, sys
rows = {"/".join((r["scene"], r["backend"], r["integrator"])): r for r in csv.DictReader(open(sys.argv[1] + "/timings.csv"))}
entries = json.load(open(sys.argv[1] + "/github.json"))
assert len(entries) == len(rows) == 4
for entry in entries:
    row = rows[entry["name"]]
    assert entry["unit"] == "ms/step" and entry["value"] == float(row["ms_per_step"]) > 0, entry
    assert entry["range"] == "", f"three rounds have no interval: {entry}"
END

# The other formats of the summary.
[ "$(head -n 1 table.csv | cut -d, -f1-2)" = scene,nodes ] || fail "--format csv prints no table: $(head -n 1 table.csv)"
[ "$(wc -l <table.csv)" -eq 5 ] || fail "--format csv has not four rows"
expect 2 'format: unknown value "xml": known are csv, github, json and table; see mssim bench --help' bench --scene cloth2500 --format xml
