#!/usr/bin/env bash
# mssim compare on result folders, made up here: verdicts, exit codes, one clear sentence for each mistake.
set -euo pipefail
. "$2/tests/support/command_line.sh"

make_run base serial=1 openmp=0.1
make_run slower serial=1 openmp=0.112
make_run faster serial=1 openmp=0.09
make_run noisy serial=1:0.3 openmp=0.1
make_run few serial=1:0.02:3
make_run few-slower serial=2:0.02:3
make_run other hybrid=1
# Samples are compared, whatever time the row has.
awk -F, -v OFS=, 'NR == 1 { for (i = 1; i <= NF; ++i) c[$i] = i } $c["backend"] == "openmp" { $c["ms_per_step"] = 0.1 } 1' \
  slower/timings.csv >timings && mv timings slower/timings.csv

# Verdicts and exit codes.
saying 'serial .* same' ends 0 compare "$work/base" "$work/base"
says 'openmp .* same'
says '^all  *2 '
[ ! -s "$work/err" ] || fail "a comparison with itself has messages"
saying 'openmp .* 1\.12 .* slower' ends 1 compare "$work/base" "$work/slower"
warns '^mssim: cloth2500, openmp, semi-euler: slower, 1\.12 times the time (1\.[01][0-9]* to 1\.1[0-9]*)$'
says 'serial .* same'
saying 'openmp .* same' ends 0 compare "$work/base" "$work/slower" --threshold 15
saying 'openmp .* 0\.9 .* faster' ends 0 compare "$work/base" "$work/faster"
saying 'serial .* undecided  [0-9]* samples per side would decide' ends 0 compare "$work/base" "$work/noisy"
warns '1 of 2 combinations is undecided'
saying 'serial .* undecided  at least 5 samples per side are needed' ends 0 compare "$work/few" "$work/few-slower"
saying '"low": null' ends 0 compare "$work/few" "$work/few-slower" --format json
says '"high": null'
warning 'only BASE has: cloth2500, openmp, semi-euler$' ends 0 compare "$work/base" "$work/few"
warning 'only NEW has: cloth2500, openmp, semi-euler$' ends 0 compare "$work/few" "$work/base/timings.csv"

# A row that is gone.
cp -r "$work/base" "$work/lost"
sed -i '/,openmp,/s/,true,ok,/,false,failed: step 7 is not finite,/' "$work/lost/timings.csv"
saying 'openmp .* lost  *failed: step 7 is not finite' ends 1 compare "$work/base" "$work/lost"
warning 'without a verified time in BASE: cloth2500, openmp, semi-euler' ends 0 compare "$work/lost" "$work/base"
cp -r "$work/lost" "$work/all-lost"
sed -i '/,serial,/s/,true,ok,/,false,failed: step 7 is not finite,/' "$work/all-lost/timings.csv"
warning 'without a verified time in BASE: cloth2500, serial, semi-euler and 1 more' ends 2 compare "$work/all-lost" "$work/base"
warns 'nothing to compare: .*all-lost has no verified time of what both have; measure it again'

# Formats.
ends 1 compare "$work/base" "$work/slower" --format markdown
# shellcheck disable=SC2016 # the backquotes are Markdown's
says '^| cloth2500 | `openmp` | semi-euler | 0.100 | 0.112 | 1.12 | .* | \*\*slower\*\* |$'
ends 1 compare "$work/base" "$work/slower" --format json
/usr/bin/python3 - "$work/out" <<'PYTHON' || fail "the JSON is not what it should be"
import json, math, sys
def refuse(constant):
    raise ValueError(constant)
result = json.load(open(sys.argv[1]), parse_constant=refuse)
assert result["regression"] is True and result["threshold"] == 0.05, result
assert [row["verdict"] for row in result["rows"]] == ["same", "slower"], result
assert all(len(row["base_samples_ms"]) == len(row["new_samples_ms"]) > 4 for row in result["rows"]), result
assert math.isclose(result["geometric_means"][0]["geometric_mean_ratio"], math.sqrt(1.12), rel_tol=1e-9), result
PYTHON

# A folder keeps both.
ends 1 compare "$work/base" "$work/slower" --format markdown --out "$work/kept/comparison"
cmp "$work/out" "$work/kept/comparison/comparison.md" || fail "the kept page is not the printed one"
expect 2 'kept/comparison/comparison.md already exists.*--overwrite' compare "$work/base" "$work/slower" --out "$work/kept/comparison"
rm "$work/kept/comparison/comparison.md"
expect 2 'comparison.json already exists.*--overwrite' compare "$work/base" "$work/slower" --out "$work/kept/comparison"
ends 1 compare "$work/base" "$work/slower" --format json --out "$work/kept/comparison" --overwrite
cmp "$work/out" "$work/kept/comparison/comparison.json" || fail "the kept JSON is not the printed one"
expect 4 'timings.csv' compare "$work/base" "$work/slower" --out "$work/base/timings.csv"
expect 2 'not there' compare "$work/base" "$work/not there" --out "$work/unmade"
[ ! -e "$work/unmade" ] || fail "a refused comparison leaves a folder"
# A full disk leaves both files as they were.
cp -r "$work/kept/comparison" "$work/before"
on_full_disk 1 'comparison.json' compare "$work/base" "$work/base" --out "$work/kept/comparison" --overwrite
diff -r "$work/before" "$work/kept/comparison" || fail "a comparison is half new"

# Damaged files are named, with the row.
cp -r "$work/base" "$work/cut"
sed -i '$d' "$work/cut/samples.csv"
expect 2 'cut/samples.csv: cloth2500, openmp, semi-euler has [0-9]* samples*, but [0-9]* rounds.*measure' \
  compare "$work/base" "$work/cut"

# Runs that are not alike.
cp -r "$work/base" "$work/cpu"
sed -i 's/"model": "[^"]*"/"model": "Another CPU"/' "$work/cpu/provenance.json"
expect 2 'not comparable: the CPU was .* and is Another CPU with 2 logical CPUs; .*--force' compare "$work/base" "$work/cpu"
warning 'compared anyway: the CPU was ' ends 0 compare "$work/base" "$work/cpu" --force
says 'openmp .* same'
cp -r "$work/base" "$work/threads"
sed -i 's/"asked_for": 2/"asked_for": 1/; s/GNU 12/GNU 13/' "$work/threads/provenance.json"
expect 2 'the compiler was GNU 12.* and is GNU 13.*; the number of threads was 2 and is 1' compare "$work/base" "$work/threads"

# Nothing to compare is no success.
mkdir "$work/empty"
warning 'only BASE has: cloth2500, serial, semi-euler and 1 more' ends 2 compare "$work/base" "$work/other"
warns 'only NEW has: cloth2500, hybrid, semi-euler'
warns 'nothing to compare: .* have no measured combination in common'
[ ! -s "$work/out" ] || fail "nothing to compare, and a table: $(cat "$work/out")"
expect 2 'empty holds no timings.csv' compare "$work/base" "$work/empty"
echo '{}' >"$work/empty/history.jsonl"
expect 2 'history.jsonl is a file, and its folder .*empty holds no timings.csv' compare "$work/base" "$work/empty/history.jsonl"
expect 2 'there is no .*missing' compare "$work/missing" "$work/base"
expect 2 'NEW is missing: give .*BASE' compare "$work/base"

# Files that are broken.
broken() {
  rm -rf "$work/broken"
  cp -r "$work/base" "$work/broken"
}
broken && sed -i 's/,0.1\([0-9]*\),$/,nan,/' "$work/broken/samples.csv"
expect 2 'samples.csv, line [0-9]*, column ms_per_step: "nan" is not a number' compare "$work/base" "$work/broken"
broken && sed -i 's/,10,0.1\([0-9]*\),$/,10,0,/' "$work/broken/samples.csv"
expect 2 'openmp, semi-euler has 0 ms in round 8, not between 1e-12 and 1e12; measure' compare "$work/base" "$work/broken"
broken && sed -i '/,openmp,/s/^\(\([^,]*,\)\{10\}\)[^,]*/\1/' "$work/broken/timings.csv"
expect 2 'timings.csv: cloth2500, openmp, semi-euler has no ms_per_step' compare "$work/base" "$work/broken"
broken && sed -i '/,openmp,/s/^\(\([^,]*,\)\{11\}\)[^,]*/\11e299/' "$work/broken/timings.csv"
expect 2 'ms_per_step_low of cloth2500, openmp, semi-euler is 1e+299, not between' compare "$work/base" "$work/broken"
broken && sed -i '/,openmp,/d' "$work/broken/samples.csv"
expect 2 'openmp, semi-euler has no samples' compare "$work/base" "$work/broken"
broken && rm "$work/broken/provenance.json"
expect 2 'provenance.json: there is no such file: give a folder that mssim bench wrote' compare "$work/base" "$work/broken"

# Options.
expect 2 'threshold' compare "$work/base" "$work/base" --threshold -5
expect 2 'format.*github' compare "$work/base" "$work/base" --format github
