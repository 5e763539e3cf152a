#!/usr/bin/env bash
# What mssim bench shows on a terminal: progress in a line that is written over, and a table that fits. In a pipe neither that nor
# an escape sequence.
# $1: mssim, $2: the source folder
set -euo pipefail
# shellcheck source=tests/support/command_line.sh
. "$2/tests/support/command_line.sh"

command -v script >/dev/null || skip "script (package bsdutils) is missing: there is no terminal to test on"

bench=(bench --scene cloth2500 --backend serial,openmp --integrator semi-euler --threads 1 --rounds 2)
escape=$'\033'
unset LC_ALL LC_CTYPE NO_COLOR
export LANG=C.UTF-8 TERM=xterm

# on_terminal COLUMNS: the bench on a terminal with so many. What it shows is in `shown`, and the table of it, before which the line
# of progress was wiped, in `table`; its widest line has $widest characters.
on_terminal() {
  script -qec "stty cols $1; $(printf '%q ' "$mssim" "${bench[@]}")" typescript >/dev/null </dev/null || fail "a bench on a terminal exits with $?"
  sed '1d; $d' typescript | tr -d '\r' >shown
  sed -n 's/.*\x1b\[K//; /^[^ ]*cloth2500[^ ]*: 2,500 nodes/,$p' shown >table
  widest=$(LC_ALL=C.UTF-8 wc -L <table)
}

on_terminal 80
grep -q "${escape}\[Kcloth2500  \[.*\]  .*verify: semi-euler serial" shown || fail "no progress: $(cat shown)"
grep -q "about [0-9]*:[0-9][0-9] left  round 2/2: semi-euler \(serial\|openmp\)" shown || fail "no time left, or no row: $(cat shown)"
! grep -q '^mssim: cloth2500 (1 of 1)' shown || fail "a line of a log on a terminal"
grep -q "openmp .*${escape}\[32m✓${escape}\[0m .*${escape}\[32m.*×.*█" table || fail "no coloured mark, ratio or bar: $(cat table)"

export NO_COLOR=1
on_terminal 80
grep -q 'serial .* ✓  .*1.00×.*[▏▎▍▌▋▊▉█]' table || fail "NO_COLOR: no mark, ratio or bar: $(cat table)"
! grep -q "$escape" table || fail "NO_COLOR is not heeded: $(cat table)"
[ "$widest" -le 80 ] || fail "80 columns: $(cat table)"

on_terminal 60
grep -q 'openmp .* ✓ .*×' table || fail "60 columns: no mark or ratio: $(cat table)"
[ "$widest" -le 60 ] || fail "60 columns: $(cat table)"

LANG=C on_terminal 80
grep -q 'openmp .* yes .*[0-9]x.* #' table || fail "no ASCII: $(cat table)"
! LC_ALL=C grep -v "^cloth2500" table | grep -q "[^ -~]" || fail "characters beyond ASCII: $(cat table)"

unset NO_COLOR
TERM=dumb on_terminal 80
! grep -q "$escape" shown || fail "escape sequences on a dumb terminal: $(cat shown)"
grep -q '^mssim: cloth2500 (1 of 1)$' shown || fail "a dumb terminal is told no scene: $(cat shown)"

# A pipe.
"$mssim" "${bench[@]}" 2>err | cat >out
! grep -q "$escape" out err || fail "escape sequences in a pipe: $(cat out err)"
warns '^mssim: cloth2500 (1 of 1)$'
says '^  semi-euler  serial .*✓ .*1.00×'
