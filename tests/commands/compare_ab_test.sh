#!/usr/bin/env bash
# mssim compare --ab: programs that take turns. Most are scripts here, which write times as mssim does, so that what comes
# out is known.
set -euo pipefail
. "$2/tests/support/command_line.sh"
export TMPDIR=$work/tmp
mkdir "$TMPDIR"

# program NAME COMMANDS: a program that finds its result folder in $out and the backends in $backends, may call
# `times MS [STATUS [VERIFIED [BACKEND]]]` for each row that it has, and counts its runs in NAME.runs. Its help knows
# --verified where NAME begins with "new-"; then $verified is the folder that it is given, which must have been written.
program() {
  make_program "$work/$1" <<SCRIPT
[ "\$1" = bench ] || exit 9
[ "\$2" != --help ] || { case \${0##*/} in new-*) echo "  --verified TEXT" ;; esac; exit 0; }
echo "\$*" >>"\$0.runs"
verified=
while [ \$# -gt 1 ]; do
  case \$1 in --out) out=\$2 ;; --verified) verified=\$2 ;; --backend) backends=\$2 ;; esac
  shift
done
[ -z "\$verified" ] || [ -f "\$verified/timings.csv" ] || exit 8
times() {
  mkdir -p "\$out"
  [ -e "\$out/timings.csv" ] || echo scene,backend,integrator,ms_per_step_min,verified,status >"\$out/timings.csv"
  echo "cloth2500,\${4-openmp},semi-euler,\$1,\${3-true},\${2-ok}" >>"\$out/timings.csv"
}
runs=\$(wc -l <"\$0.runs")
$2
SCRIPT
}

# ab STATUS BASE NEW OPTIONS...: compare --ab must exit with STATUS and leave nothing in the folder for temporary files
ab() {
  local wanted=$1 base=$2 new=$3
  shift 3
  rm -f "$work/$base.runs" "$work/$new.runs"
  ends "$wanted" compare --ab "$work/$base" "$work/$new" --scene cloth2500 "$@"
  [ -z "$(ls -A "$TMPDIR")" ] || fail "something is left in $TMPDIR"
}

# One that is no mssim and never says anything is given up, and named.
make_program sleeper <<<'sleep 1000'
warning 'sleeper bench --help has not ended within 11 s' ab 2 sleeper sleeper --time-budget 1

# One whose help fails is no mssim, either.
make_program stranger <<<'exit 7'
warning 'stranger bench --help exited with 7: give the path of an mssim program' ends 2 compare --ab "$work/stranger" "$mssim" --scene cloth2500

# Times that vary a little from run to run.
# shellcheck disable=SC2016 # for the programs' own shell
{
  program steady 'times "1.00$((runs * 7 % 10))"'
  program steady2 'times "1.00$((runs * 3 % 10))"'
  program slow 'times "1.10$((runs * 3 % 10))"'
  program quick 'times "0.90$((runs * 3 % 10))"'
  program wild 'times "$((runs % 4 + 1)).5"; sleep 0.05'
  program wild2 'times "$(((runs ^ 1) % 4 + 1)).5"; sleep 0.05'  # by turns less and more, so that nobody can tell
  program wrong 'times 1.0 ok false; exit 1'
  program broken 'times not-a-number'
  program fickle 'if [ "$runs" -gt 2 ]; then times 1 "failed: step 3"; exit 1; else times 1; fi'
  program crash 'echo "what went wrong"; kill -SEGV $$'
  program deaf 'echo "no such device" >&2; exit 3'
  program silent 'exit 0'
  program new-steady 'times "1.00$((runs * 7 % 10))"'
  program new-steady2 'times "1.00$((runs * 3 % 10))"'
  program new-slow 'times "1.10$((runs * 3 % 10))"'
  program new-wrong 'times 1.0 ok false; exit 1'
  program new-refusing '[ -z "$verified" ] || { echo "what is wrong with it"; exit 2; }; times 1'
  program new-unsure '[ -z "$verified" ] || { times 1 ok false; exit 1; }; times 1'
  # Each verifies while the other does: they wait for one another, ten seconds at most.
  meet='touch "$0.here"; i=0; until [ -e "${0%/*}/$other.here" ]; do i=$((i + 1)); [ $i -lt 1000 ] || exit 9; sleep 0.01; done'
  program new-meeting "other=new-meeting2; $meet; times 1.00\$((runs * 7 % 10))"
  program new-meeting2 "other=new-meeting; $meet; times 1.00\$((runs * 3 % 10))"
  program new-two 'times "1.00$((runs % 7))"; times "$((runs % 4 + 1)).5" ok true serial'
  # What nobody can tell apart goes on, here until it fails in the 14th run.
  program new-two2 'times "1.00$((runs % 5))"
    if [ "$runs" -lt 14 ]; then times "$(((runs ^ 1) % 4 + 1)).5" ok true serial; else times 1 "failed: late" false serial; exit 1; fi'
  # What cannot run takes nothing along, and what BASE loses on the way only itself.
  program new-partly 'times "1.00$((runs % 7))"; times "" "unsupported: no such method" false serial; exit 3'
  program new-losing 'times "1.00$((runs % 7))"; if [ "$runs" -lt 4 ]; then times 1 ok true serial; else times 1 "failed: late" false serial; exit 1; fi'
  program new-gone 'times "1.00$((runs % 5))"
    if [ "$runs" -lt 14 ]; then times "$(((runs ^ 1) % 4 + 1)).5" ok true serial; else rm "$out/timings.csv"; times "" "unavailable: no device" false serial; exit 3; fi'
  program new-both 'times "1.00$((runs % 5))"; times "1.00$((runs % 3))" ok true serial'
  program sleepy 'echo $$ >"$0.pid"; sleep 60'
}

saying 'openmp .* same' ab 0 steady steady2
warns '10 rounds in'
warns 'steady has no bench --verified: each process of both programs verifies again'
[ "$(wc -l <"$work/steady.runs")" -eq 10 ] || fail "not 10 runs"
grep -q '^bench --scene cloth2500 --backend openmp --integrator semi-euler --rounds 7 --out ' "$work/steady.runs" ||
  fail "the program is not given what was asked for: $(head -n 1 "$work/steady.runs")"
saying 'openmp .* slower' ab 1 steady slow
warns '^mssim: 10 rounds in [0-9]* s$'
saying 'openmp .* same' ab 0 steady slow --threshold 20
saying '"verdict": "faster"' ab 0 steady quick --format json
[ "$(grep -A 10 '"base_samples_ms"' "$work/out" | grep -c ' 1\.0')" -eq 10 ] || fail "not the ten samples of BASE: $(cat "$work/out")"

# The budget: no round is begun that would not fit, and what is not known is not said.
start=$(date +%s%N)
saying 'undecided' ab 0 wild wild2 --time-budget 2 --backend openmp,serial --integrator rk4 --threads 2
warns 'the time budget ended'
(($(date +%s%N) - start < 4000000000)) || fail "the time budget of 2 s is exceeded by far"
grep -q -- '--backend openmp,serial --integrator rk4 --rounds 7 --out [^ ]* --threads 2$' "$work/wild.runs" || fail "options"

# Verified once: the first run of each verifies, all others rely on its folder, and every one is a process of its own.
saying 'openmp .* same' ab 0 new-steady new-steady2
warns '10 rounds in'
if grep -q 'verifies again' "$work/err"; then fail "both know --verified"; fi
for name in new-steady new-steady2; do
  [ "$(wc -l <"$work/$name.runs")" -eq 11 ] || fail "not 11 runs of $name"
  grep -q '^bench --scene cloth2500 --backend openmp --integrator semi-euler --rounds 1 --out [^ ]*$' \
    <(head -n 1 "$work/$name.runs") || fail "$name is not asked to verify first"
  folder=$(sed -n '1s/.*--out //p' "$work/$name.runs")
  [ "$(grep -c -- "--rounds 7 --out [^ ]* --verified $folder\$" "$work/$name.runs")" -eq 10 ] ||
    fail "$name is not sampled ten times with what it has verified"
done
saying 'openmp .* same' ab 0 new-meeting new-meeting2
saying 'openmp .* slower' ab 1 new-steady new-slow
# One that is older: nobody is spared the verification, so that both are measured alike.
warning 'steady has no bench --verified' ab 0 steady new-steady2
warning 'slow has no bench --verified' ab 1 new-steady slow
says 'openmp .* slower'
if grep -q -- --verified "$work/steady.runs" "$work/slow.runs" "$work/new-steady.runs" "$work/new-steady2.runs"; then
  fail "one of the two is not verified again"
fi
# What is wrong is found before anything is sampled; and what turns out not to be verified does not count.
saying 'lost  *failed: not verified' ab 1 new-steady new-wrong
warns '^mssim: 0 rounds in'
# Both programs may have run at the same time: that is no time of BASE.
saying '"base_ms": null' ab 1 new-steady new-wrong --format json
warning 'new-wrong has no verified time of what both have' ab 2 new-wrong new-steady
saying 'lost  *failed: not verified' ab 1 new-steady new-unsure
warning 'none in a later round (failed: not verified)' ab 2 new-unsure new-steady
warns 'nothing is left to compare'
warning '^what is wrong with it$' ab 2 new-steady new-refusing
warns 'new-refusing bench exited with 2'
# What is settled is not measured any further.
saying 'openmp .* same' ab 1 new-two new-two2 --backend openmp,serial
says 'serial .* lost  *failed: late'
[ "$(grep -c -- '--backend openmp,serial --integrator semi-euler --rounds 7 ' "$work/new-two.runs")" -eq 10 ] ||
  fail "openmp is not sampled ten times"
[ "$(grep -c -- '--backend serial --integrator semi-euler --rounds 7 ' "$work/new-two.runs")" -eq 3 ] ||
  fail "serial is not gone on with alone"

saying 'openmp .* same' ab 0 new-steady new-both --backend openmp,serial
warns 'only .*new-both has cloth2500, serial, semi-euler$'
saying 'openmp .* same' ab 0 new-partly new-both --backend openmp,serial
warns 'new-partly has no time for .*serial.*: unsupported: no such method'
saying 'openmp .* same' ab 1 new-both new-partly --backend openmp,serial
says 'serial .* lost  *unsupported: no such method'
saying 'openmp .* same' ab 0 new-losing new-both --backend openmp,serial
if grep -q '^cloth2500 *serial' "$work/out"; then fail "a row stands that BASE has lost"; fi
warns 'new-losing had a time for .*serial.* none in a later round (failed: late)'

saying 'openmp .* same' ab 1 new-two new-gone --backend openmp,serial
says 'serial .* lost  *unavailable: no device'

# Programs that fail.
saying 'lost  *failed: not verified' ab 1 steady wrong
warning 'nothing to compare' ab 2 wrong steady
saying 'lost  *failed: step 3' ab 1 steady fickle
warning 'none in a later round (failed: step 3)' ab 2 fickle steady
warns 'nothing is left to compare'
warning '^what went wrong$' ab 2 steady crash
warns 'crash bench was ended by signal 11'
warning '^no such device$' ab 3 steady deaf
warns 'deaf bench exited with 3'
warning 'silent bench exited with 0 instead of measuring, without a message' ab 2 steady silent
warning 'timings.csv, line 2, column ms_per_step_min: "not-a-number" is not a number' ab 2 steady broken
warning 'cannot run .*missing: give the path' ab 3 steady missing
expect 2 'needs a --scene' compare --ab "$work/steady" "$work/slow"
expect 2 'scene needs --ab: add it' compare "$work" "$work" --scene cloth2500
expect 2 'time-budget' compare --ab "$work/steady" "$work/slow" --scene cloth2500 --time-budget 0
expect 2 'ab and --force exclude each other' compare --ab "$work/steady" "$work/slow" --scene cloth2500 --force

# Interrupted: ends the program under way, leaves nothing.
begins compare --ab "$work/sleepy" "$work/sleepy" --scene cloth2500
is_ended 130 INT 10 test -s "$work/sleepy.pid"
is_gone "$(cat "$work/sleepy.pid")" || fail "the program under way goes on"
[ -z "$(ls -A "$TMPDIR")" ] || fail "interrupted it leaves something in $TMPDIR"
# What the rounds before show is judged and written.
rm -f "$work/wild2.runs"
begins compare --ab "$work/wild" "$work/wild2" --scene cloth2500 --out "$work/interrupted"
is_ended 130 INT 20 bash -c "[ \"\$(wc -l <'$work/wild2.runs')\" -ge 3 ]"
warns 'rounds* in .*a signal ended it before every verdict was settled'
says '^cloth2500 *openmp .*undecided'
grep -q '"verdict": "undecided"' "$work/interrupted/comparison.json" || fail "interrupted it writes no comparison"

# The real thing against itself: whatever the noise, never slower by more than a factor of 20. A small cloth is soon verified; a build with a
# sanitizer takes minutes for ten rounds.
make_scene small.json cloth2500 's/"rows": 50/"rows": 20/; s/"columns": 50/"columns": 20/'
ends 0 compare --ab "$mssim" "$mssim" --scene "$work/small.json" --threads 1 --threshold 1900 --time-budget 240
says 'small  openmp   semi-euler .* same'
warns '^mssim: 10 rounds in'
if grep -q 'verifies again' "$work/err"; then fail "it knows --verified itself"; fi
# And against an older one, which is this one with an option less: a few rounds, too few for a verdict.
make_program older <<SCRIPT
case "\$*" in
  *--help) "$mssim" "\$@" | grep -v -- --verified ;;
  *--verified*) exit 9 ;;
  *) exec "$mssim" "\$@" ;;
esac
SCRIPT
ends 0 compare --ab "$work/older" "$mssim" --scene "$work/small.json" --threads 1 --threshold 1900 --time-budget 6
says '^small  *openmp  *semi-euler  *[0-9]'
warns '^mssim: [1-9][0-9]* rounds\{0,1\} in'
warns 'older has no bench --verified'
