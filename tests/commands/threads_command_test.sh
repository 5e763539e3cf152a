#!/usr/bin/env bash
# --threads binds a processor that is an OpenCL device, too; what cannot keep to it is marked.
set -euo pipefail
. "$2/tests/support/command_line.sh"

[ "$("$mssim" list devices --format csv | awk -F, 'NR == 2 { print ($3 == "cpu" && $6 > 1) }')" = 1 ] ||
  skip "needs a processor with several compute units as the first OpenCL device"

bench=(bench --scene cloth2500 --integrator semi-euler --rounds 3 --threads 1)

# columns FILE: backend, threads and note of every row
columns() { column_of "$1" backend threads note; }

ends 0 "${bench[@]}" --backend serial,opencl,hybrid --out one
[ "$(columns one/timings.csv)" = $'serial 1 \nopencl 1 \nhybrid 1 ' ] || fail "threads: $(columns one/timings.csv)"
[ "$(grep -Ec '^  .*(serial|opencl|hybrid) +1 ' out)" -eq 3 ] || fail "the table shows no threads: $(cat out)"
! grep -q '(!)' out one/table1.md || fail "a row on one processor is marked"
! grep -q 'speed-ups' out err one/table1.md || fail "speed-ups are said to be missing: $(cat out err)"
ends 0 run --scene cloth2500 --backend opencl --threads 1 --duration 0.01
[ ! -s err ] || fail "run says $(cat err)"
[ "$(value threads)" -eq 1 ] ||
  fail "run shows no threads: $(cat out)"

# A driver that cannot divide its device.
export OPENCL_LAYERS=${mssim%/*}/../fake_opencl/changing_layer.so FAKE_OPENCL=undividable
ends 0 "${bench[@]}" --backend serial,openmp,opencl,hybrid --out whole
units=$(column_of whole/timings.csv threads | sed -n 3p)
[ "$units" -gt 1 ] || fail "the device was divided"
[ "$(column_of whole/timings.csv threads | tr '\n' ' ')" = "1 1 $units $units " ] || fail "threads: $(columns whole/timings.csv)"
[ "$(columns whole/timings.csv | grep -Ec "^(opencl|hybrid) $units on $units processors instead of 1: the driver of .* cannot divide it")" -eq 2 ] ||
  fail "notes: $(columns whole/timings.csv)"
[ "$(grep -Ec "^  .*(opencl|hybrid) +$units +[0-9.]+ \(!\) " out)" -eq 2 ] || fail "the table marks no rows: $(cat out)"
legend="(!) on more processors than requested: hybrid ($units instead of 1), opencl ($units instead of 1)"
grep -qxF "$legend" out || fail "the table does not say what the mark means: $(cat out)"
grep -qxF "$legend." whole/table1.md || fail "table1.md does not say what the mark means: $(cat whole/table1.md)"
# shellcheck disable=SC2016 # Markdown's code
[ "$(grep -Ec '^\| `(opencl|hybrid)`.*\*\* \(!\)' whole/table1.md)" -eq 2 ] || fail "table1.md marks no rows: $(cat whole/table1.md)"
ends 0 run --scene cloth2500 --backend opencl --threads 1 --duration 0.01
warns "^mssim: opencl runs on $units processors instead of 1: the driver of .* cannot divide it$"
unset OPENCL_LAYERS

# Without serial there is nothing to be faster than: said before the measurement and below the table, not among CSV.
missing='speed-ups are missing, since serial is not among the backends; add it to --backend'
ends 0 "${bench[@]}" --backend openmp
[ "$(grep -cxF "mssim: $missing" err)" -eq 1 ] || fail "stderr does not say why there are no speed-ups: $(cat err)"
[ "$(grep -cxF "$missing" out)" -eq 1 ] || fail "stdout does not say why there are no speed-ups: $(cat out)"
for format in csv json; do
  ends 0 "${bench[@]}" --backend openmp --format $format
  grep -qxF "mssim: $missing" err || fail "$format: stderr does not say why there are no speed-ups: $(cat err)"
  ! grep -q 'speed-ups' out || fail "$format: $(cat out)"
done
