#!/usr/bin/env bash
# mssim guide: a small run prints a recommendation and its table, and writes a folder; what is asked for wrongly is
# named in one sentence.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# A small cloth of the committed family.
make_scene tiny.json cloth2500 's/"rows": 50/"rows": 8/; s/"columns": 50/"columns": 8/; s/"every_columns": [0-9]*/"every_columns": 7/'
tiny=(guide --scene "$work/tiny.json" --backend serial --integrator 'semi-euler,rk4' --threads 1 --horizon 0.01 --time-budget 60)

ends 0 "${tiny[@]}" --error 1e-2 --out "$work/folder"
grep -q '^Take \(semi-euler\|rk4\) on serial with a step of ' "$work/folder/guide.md" || fail "the page recommends nothing: $(head -20 "$work/folder/guide.md")"
for file in guide.csv guide.md guide-steps.csv guide-errors.csv guide-sizes.csv guide-frames.csv provenance.json; do
  [ -s "$work/folder/$file" ] || fail "there is no $file"
done
head -1 "$work/folder/guide.csv" | tr -d '\r' >"$work/columns"
echo scene,nodes,springs_unique,integrator,backend,dt_s,steps,horizon_s,position_error,energy_error,solver_error,step_error,reference_error,ms_per_step,wall_s_per_s,force_evaluations_per_s,samples,diverged,on_front,status,note,recommended >"$work/expected"
cmp "$work/columns" "$work/expected" || fail "guide.csv has other columns: $(cat "$work/columns")"
column_of "$work/folder/guide.csv" integrator | sort -u | tr '\n' ' ' >"$work/integrators"
[ "$(cat "$work/integrators")" = 'rk4 semi-euler ' ] || fail "integrators: $(cat "$work/integrators")"
# Each curve begins with a step that diverges, and the front is not empty.
[ "$(column_of "$work/folder/guide.csv" diverged | grep -c true)" -ge 2 ] || fail "no point diverged"
[ "$(column_of "$work/folder/guide.csv" on_front | grep -c true)" -ge 1 ] || fail "there is no front"
# One point is recommended, which keeps the error.
[ "$(column_of "$work/folder/guide.csv" recommended | grep -c true)" -eq 1 ] || fail "not one point is recommended"
awk -F, '$NF == "true" && $9 <= 0.01 && $20 == "ok"' "$work/folder/guide.csv" | grep -q . || fail "the recommended point: $(grep 'true$' "$work/folder/guide.csv")"
grep -q '^Measured: 2 of 2 methods' "$work/folder/guide.md" || fail "the page does not say how many methods were measured"
# Both reach the wished error.
[ "$(awk -F, 'NR > 1 && $4 == 0.01 { print $2 }' "$work/folder/guide-errors.csv" | sort -u | tr '\n' ' ')" = 'rk4 semi-euler ' ] || fail "guide-errors.csv: $(cat "$work/folder/guide-errors.csv")"
grep -q '^On serial, semi-euler and rk4 take .* ms per step; at an error of 0.01 a simulated second takes ' "$work/folder/guide.md" || fail "the page says nothing of equal errors"
# Both limits are those of theory, on this cloth to a twentieth.
awk -F, 'NR > 1 { ratio = $4 / $6; if (ratio < 0.95 || ratio > 1.05) print }' "$work/folder/guide-steps.csv" >"$work/off"
[ ! -s "$work/off" ] || fail "limits differ from theory: $(cat "$work/off")"

expect 2 'folder already holds results: give another --out, or --overwrite' "${tiny[@]}" --out "$work/folder"
ends 0 "${tiny[@]}" --out "$work/folder" --overwrite --error 1e-9
grep -q '^No .* error within 1e-09 of a mean rest length' "$work/folder/guide.md" || fail "an error that nothing keeps: $(head -9 "$work/folder/guide.md")"

# Too little time: nothing is recommended, what was measured is written, and the time that would do is named.
program=$(realpath "${mssim%/*}/../bin/own_backend")  # tests/support/own_backend.cpp
printf '{"command": ["%s", "slow"]}' "$program" >"$work/slow.json"  # 30 ms per step on every machine, and hundreds of steps to 1e-4
ends 1 guide --scene "$work/tiny.json" --backend "$work/slow.json" --integrator semi-euler --horizon 0.01 --time-budget 5 --error 1e-4 \
  --out "$work/short"
named=$(sed -n 's/^mssim: tiny: nothing is recommended.*--time-budget \([0-9.]*\) .*/\1/p' "$work/err")
are 'x >= 10' <<<"$named" || fail "stderr says: $(cat "$work/err")"
says "^Nothing is recommended: 5 s is not enough.* semi-euler on slow.* $named s "
grep -q "^Nothing is recommended: 5 s is not enough" "$work/short/guide.md" || fail "the page recommends $(sed -n 9p "$work/short/guide.md")"
! column_of "$work/short/guide.csv" recommended | grep true || fail "a point is recommended: $(cat "$work/short/guide.csv")"
grep -q ',semi-euler,slow,' "$work/short/guide.csv" || fail "guide.csv: $(cat "$work/short/guide.csv")"
ends 1 guide --scene cloth40k --backend serial --integrator newton-euler --threads 1 --time-budget 0.01
warns '^mssim: cloth40k: nothing is recommended.*--time-budget'
says '^Nothing is recommended: 1 s '

# As with bench, it is no success if nothing could run on a backend that was named.
ends 3 guide --scene "$work/tiny.json" --backend serial,threads-mutex --integrator newton-euler --threads 1 --horizon 0.01 --error 1e-2
warns '^mssim: tiny, threads-mutex, newton-euler: unsupported: '
says '^Not measured, because the backend cannot run them here: newton-euler on threads-mutex\.'

# Stopped before there is a point it replaces nothing; what replaces it leaves none of its tables.
cp -r "$work/folder" "$work/before"
timeout -s INT 3 "$mssim" guide --scene cloth350k --backend openmp --out "$work/folder" --overwrite >"$work/out" 2>"$work/err" || true
diff -r "$work/before" "$work/folder" || fail "a guide that was stopped has replaced an earlier one: $(cat "$work/err")"
ends 0 bench --scene "$work/tiny.json" --backend serial --integrator semi-euler --rounds 1 --out "$work/folder" --overwrite
[ -z "$(find "$work/folder" -name 'guide*')" ] || fail "--overwrite leaves $(ls "$work/folder")"

# Programs: one that fails, and one that hangs, cost their own points, and the status says why.
for mistake in exits hangs; do printf '{"command": ["%s", "%s"]}' "$program" "$mistake" >"$work/$mistake.json"; done
ends 1 guide --scene "$work/tiny.json" --backend serial,exits,hangs --backend-limit 1 --integrator semi-euler,rk4 --threads 1 \
  --horizon 0.01 --time-budget 60 --error 1e-2 --out "$work/programs"
warns '^mssim: tiny, exits, semi-euler: failed: exits ended with exit code 3'
for text in ',semi-euler,exits,.*failed: exits ended with exit code 3' ',semi-euler,hangs,.*failed: hangs did not answer ""step '; do
  grep -q "$text" "$work/programs/guide.csv" || fail "guide.csv does not say $text: $(cat "$work/programs/guide.csv")"
done
grep -q '^Take \(semi-euler\|rk4\) on serial with a step of ' "$work/programs/guide.md" || fail "other programs cost serial its points"

# One whose states are wrong has failed.
printf '{"command": ["%s", "nan"]}' "$program" >"$work/nan.json"
ends 1 guide --scene "$work/tiny.json" --backend nan --integrator semi-euler --threads 1 --horizon 0.01 --time-budget 60 --error 1e-2
warns '^mssim: tiny, nan, semi-euler: failed: its energy grows or is not finite '
says '^Not measured down to an error of 0.01, because the backend fails: semi-euler on nan\.'

# One that says that its times mean nothing has none. This one's state stays as it is.
cat >"$work/crowded.py" <<'PYTHON'
import os, socket
with socket.socket(socket.AF_UNIX) as mssim:
    mssim.connect(os.environ["MSSIM_SOCKET"])
    lines = mssim.makefile("rw")
    for word, _, rest in (line.rstrip("\n").partition(" ") for line in lines):
        if word == "state":
            file = rest
        elif word == "prepare":
            lines.write("untimed too crowded\nready 1\n")
        elif word == "set":
            state = open(file, "rb").read()
        elif word == "get":
            open(file, "r+b").write(state)
        elif word == "end":
            break
        if word in ("set", "step", "get"):
            lines.write("done\n")
        lines.flush()
PYTHON
printf '{"command": ["/usr/bin/python3", "%s"]}' "$work/crowded.py" >"$work/crowded.json"
ends 3 guide --scene "$work/tiny.json" --backend crowded,serial --integrator semi-euler --threads 1 --horizon 0.01 --time-budget 60 \
  --error 1e-2 --out "$work/untimed"
warns '^mssim: tiny, crowded, semi-euler: not timed: too crowded'
says '^Take semi-euler on serial '
grep -q '^[^,]*,[^,]*,[^,]*,semi-euler,crowded,,.*,not timed: too crowded,' "$work/untimed/guide.csv" || fail "guide.csv: $(cat "$work/untimed/guide.csv")"

expect 2 '^mssim: --scene NAME|FILE,... is missing: give .*list scenes.*; see mssim guide --help$' guide
expect 2 'jeans1k is a garment' guide --scene jeans1k
mkdir "$work/other"
cp "$work/tiny.json" "$work/other/tiny.json"
expect 2 "two scenes called tiny, $work/tiny.json and $work/other/tiny.json; name one of them" guide --scene "$work/tiny.json,$work/other/tiny.json"
ends 0 bench --suite guide --scene "$work/tiny.json,$work/./tiny.json" --dry-run
[ "$(grep -c '^tiny ' "$work/out")" -eq 1 ] || fail "one file is two scenes: $(cat "$work/out")"
expect 2 '^mssim: --overwrite needs the folder of an earlier run' guide --scene cloth2500 --overwrite

# The suite is the same for many scenes.
ends 0 bench --suite guide --dry-run --time-budget 1080
[ "$(grep -c '^\(cloth\|bodies\)[0-9].* 90$' "$work/out")" -eq 12 ] || fail "--suite guide: $(cat "$work/out")"
expect 2 '^mssim: --rounds cannot be used with --suite guide: leave it out$' bench --suite guide --rounds 3
