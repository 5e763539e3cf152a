#!/usr/bin/env bash
# The dressing of a garment is traced from the command line, and looking on changes nothing.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# dress ARGUMENTS...: jeans that fit, dressed on one thread
dress() {
  ends 0 run --scene jeans1k --threads 1 "$@"
  cat out err
}
# fit: everything printed that does not depend on the clock
fit() {
  awk 'NR == 1 { for (i = 1; i <= NF; ++i) clock[i] = $i == "wall_s" || $i == "ms_per_iteration" }
       { for (i = 1; i <= NF; ++i) if (!clock[i]) printf "%s ", $i; print "" }' out
}
# steps TRACE: of its frames, in one line
steps() { numbers_of "$1" /particles/garment/position/step | tr '\n' ' '; }

dress
fit >alone
dress --trace jeans.h5 --energy-curve jeans.csv
[ "$(cat err)" = $'mssim: wrote jeans.csv\nmssim: wrote jeans.h5 and jeans.xdmf' ] || fail "a trace: $(cat err)"
left_out='the work of seams, of contacts and of the correction of elongations'
grep -q "^# left out: $left_out" jeans.csv || fail "the curve does not say what it leaves out"
h5dump -a /observables/leaves_out jeans.h5 | grep "$left_out" >/dev/null || fail "the trace does not say what it leaves out"
h5dump -H -d /parameters/panels/flat jeans.h5 | grep 'SIMPLE { ( 1054, 2 ) ' >/dev/null || fail "no flat coordinates"
fit | cmp - alone || fail "a trace changes the dressing"
[ ! -e jeans.h5.part ] || fail "a part is left"

# The frames are the start, those of 60 a second as the nearest steps, and the end.
iterations=$(value iterations) dt=$(value dt_s)
expected=$(awk -v n="$iterations" -v dt="$dt" 'BEGIN {
  for (f = 0; (step = int(f / (60 * dt) + 0.5)) < n; ++f) printf "%d ", step
  printf "%d ", n }')
[ "$(steps jeans.h5)" = "$expected" ] ||
  fail "frames at $(steps jeans.h5)instead of $expected"
frames=$(wc -w <<<"$expected")
[ "$(grep -c '^[0-9]' jeans.csv)" -eq "$frames" ] || fail "the energy curve has other frames than $frames"
"$2/scripts/check-energy" jeans.h5 jeans.csv 1e-9 || fail "the trace has other energies than the curve"
[ "$(grep -c '<Grid Name="body"' jeans.xdmf)" -eq "$frames" ] || fail "the body is not in each of $frames frames"
for panel in 'front left' 'back left' 'front right' 'back right'; do
  [ "$(grep -c "<Grid Name=\"$panel\"" jeans.xdmf)" -eq "$frames" ] || fail "$panel is not in each of $frames frames"
done
[ "$(h5dump -n jeans.h5 | grep -c '/body/points')" -eq 1 ] || fail "the body is not there once"
h5dump -d /observables/damping_loss/value jeans.h5 >/dev/null 2>&1 && fail "the trace has losses"

# Other frames end with the same state; the last one is it.
# last VECTOR TRACE FRAME: of 1000 of the 1054 nodes
last() { numbers_of "$2" "/particles/garment/$1/value" -s "$3,0,0" -c 1,1000,3; }
dress --trace few.h5 --fps 7
fit | cmp - alone || fail "other frames change the dressing"
few=$(steps few.h5)
[ "${few##* "$iterations" }" = "" ] && [ "$(wc -w <<<"$few")" -lt 10 ] || fail "7 frames a second are at $few"
for vector in position velocity; do
  last "$vector" few.h5 $(($(wc -w <<<"$few") - 1)) >numbers
  [ "$(wc -w <numbers)" -eq 3000 ] && last "$vector" jeans.h5 $((frames - 1)) | cmp - numbers || fail "the last ${vector}s differ"
done

# What does not go, in a sentence, and nothing is written.
mkdir never
expect 2 '.--duration must give between one step and' run --scene jeans1k --duration 1e-9 --trace never/a.h5
expect 2 '--losses cannot be used with a garment' run --scene jeans1k --losses --trace never/a.h5
expect 2 'frames per second .* than one per step of .*; give --fps ' run --scene jeans1k --fps 1e5 --trace never/a.h5
expect 4 'cannot write no/such/a.h5' run --scene jeans1k --trace no/such/a.h5
expect 2 '"a.xdmf" is not a name of the form NAME.h5' run --scene jeans1k --trace never/a.xdmf
[ -z "$(ls never)" ] || fail "left: $(ls never)"


# A dressing that blows up shows how.
make_scene wild.json jeans1k 's/"dt_s": [0-9.e-]*/"dt_s": 1.5e-3/; s/scene.schema/none/'
warning 'blew up before step [0-9]*: node [0-9]* is not finite' ends 1 run --scene wild.json --threads 1 --fps 600 --trace wild.h5
wild=$(steps wild.h5)
[ "$(wc -w <<<"$wild")" -ge 1 ] || fail "nothing shows how it blew up"
! h5dump -d /particles/garment/position/value wild.h5 | grep -i nan >/dev/null || fail "the trace holds numbers that are none"
