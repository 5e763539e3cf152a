#!/usr/bin/env bash
# Results in the formats that other tools read: Google Benchmark's compare.py and github-action-benchmark.
set -euo pipefail
. "$2/tests/support/command_line.sh"

bench=(bench --scene cloth2500 --backend serial,opencl --integrator semi-euler,rk4 --threads 1 --rounds 3)

# github-action-benchmark's own format: on stdout, and in the folder.
ends 0 "${bench[@]}" --format github --out a
cmp -s out a/github.json || fail "a/github.json is not what was printed"
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
ends 0 "${bench[@]}" --verified a --format csv --out b
[ "$(head -n 1 out | cut -d, -f1-2)" = scene,nodes ] || fail "--format csv prints no table: $(head -n 1 out)"
[ "$(wc -l <out)" -eq 5 ] || fail "--format csv has not four rows"
[ ! -e b/github.json ] || fail "github.json is written unasked"
expect 2 'format: unknown value "xml": known are csv, github, json and table; see mssim bench --help' bench --scene cloth2500 --format xml

# Google Benchmark's own tool takes benchmark.json as it is and compares every combination, by a U test too.
exits 0 /usr/bin/python3 /usr/share/benchmark/compare.py --no-color benchmarks a/benchmark.json b/benchmark.json
for backend in serial opencl; do
  for integrator in semi-euler rk4; do
    for what in _median _mean _stddev _pvalue; do says "^cloth2500/$backend/$integrator$what "; done
    [ "$(grep -c "^cloth2500/$backend/$integrator " out)" -eq 3 ] || fail "compare.py shows not all samples of $backend"
  done
done
