#!/usr/bin/env bash
# What is typed wrong at the command line is named in one sentence, with the nearest word that is right and the page that helps.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# page ARGUMENTS...: mssim must print $work/page and end well
page() {
  ends 0 "$@"
  [ ! -s err ] || fail "mssim $*: $(cat err)"
  mv out page
}

# Commands.
warning '^Usage: mssim COMMAND' ends 2
[ ! -s out ] || fail "mssim alone writes to stdout: $(cat out)"
mv err alone
page --help
cp "$work/page" "$work/help"
cmp "$work/help" "$work/alone" || fail "mssim alone shows another page than --help"
commands=$(sed -nE 's/^  ([a-z-]+)  +[A-Z].*/\1/p' "$work/help" | grep -v '^-')
for command in bench run new-backend help; do grep -qx -e "$command" <<<"$commands" || fail "--help does not name $command: $commands"; done
page help
cmp "$work/page" "$work/help" || fail "mssim help shows another page than --help"
tr -s '\n ' ' ' <page | grep -q 'Exit codes: .* 1 .*guide .*a program of it failed.* 2 ' || fail "exit code 1 is not that of a program that fails"
for command in $commands; do
  page "$command" --help
  cp "$work/page" "$work/help"
  page help "$command"
  cmp "$work/page" "$work/help" || fail "mssim help $command shows another page than mssim $command --help"
  grep -q Example "$work/page" || fail "mssim help $command shows no example"
  [ "$(awk 'length > 80' "$work/page" | wc -l)" -eq 0 ] || fail "mssim help $command has lines longer than 80 characters"
done
page -V
grep -q '^mssim [0-9.]* (' "$work/page" || fail "-V: $(cat "$work/page")"
cp "$work/page" "$work/version"
page --version
cmp "$work/page" "$work/version" || fail "-V and --version differ"
expect 2 'unknown command "frobnicate": known are bench, .*; see mssim --help' frobnicate
expect 2 'unknown command "bnech" (did you mean bench?): known are ' bnech --scene cloth2500
expect 2 'unknown command "rnu" (did you mean run?): known are ' help rnu

# Options.
expect 2 'mssim bench has no option "--thread" (did you mean --threads?); see mssim bench --help' bench --scene cloth2500 --thread 2
expect 2 'mssim run has no option "-scene" (did you mean --scene?)' run -scene cloth2500
expect 2 'mssim run has no option "--fsp" (did you mean --fps?)' run --scene cloth2500 --fsp=30
expect 2 'mssim has no option "--verison" (did you mean --version?); see mssim --help' --verison
expect 2 'mssim compare has no option "--frobnicate"; see mssim compare --help' compare a b --frobnicate
expect 2 '^mssim: --scene NAME|FILE is missing: give .*list scenes.*; see mssim run --help$' run
expect 2 '^mssim: --scene needs a value: give --scene NAME|FILE; see mssim run --help$' run --scene
expect 2 '^mssim: --integrator: "," names nothing: give a value' bench --scene cloth2500 --integrator , --dry-run
expect 2 '^mssim: SCENE: "," names nothing' check ,
expect 2 '^mssim: --out: "" is empty: give a value.*mssim report --help' report f1 --out= --no-runs
expect 2 '^mssim: --integrator: "" is empty: give a value' bench --scene cloth2500 --integrator= --dry-run
expect 2 '^mssim: --threads: "" is not a whole number' run --scene cloth2500 --threads= --losses
expect 2 'mssim bench has no option "--fsp" (did you mean --fps?)' bench --scene cloth2500 --fsp= --dry-run
expect 2 'there is no folder --out=' report -- --out=
saying '^Usage: mssim report DIR\.\.\. \[' ends 0 help report
expect 2 '^mssim: --scene is given 2 times: give it once;' run --scene cloth2500 --scene cloth4900
expect 2 '^mssim: --dry-run takes no value: leave it out;' bench --scene cloth2500 --dry-run=perhaps
expect 2 'mssim bench has no option "--output" (did you mean --out?)' bench --scene cloth2500 --output x
expect 2 'mssim bench has no option "-o" (did you mean .*--out' bench --scene cloth2500 -o x
expect 2 'mssim has no option "-v" (did you mean --version?)' -v
expect 2 'unknown command "version" (did you mean --version?)' version
expect 2 'mssim run has no option "--suite", which is one of mssim bench;' run --suite table1
expect 2 '^mssim: unexpected argument "cloth350k" of mssim bench (did you mean --scene cloth350k?);' bench cloth350k
expect 2 '^mssim: unexpected argument "--scene" of mssim bench behind "--": .*before "--"; see mssim bench --help$' bench -- --scene cloth2500
expect 2 '^mssim: "jeans4k" is a scene, not a trace: did you mean --scene jeans4k?' render jeans4k
expect 2 '^mssim: WHAT is missing: give what to list: scenes, ' list
expect 2 '^mssim: unexpected argument "twice" of mssim list: ' list scenes twice
expect 2 '^mssim: --resume and --overwrite exclude each other: leave out one of them;' bench --scene cloth2500 --resume --overwrite

# Files are no streams, and a stream that takes nothing is told with its reason.
ends 0 run --scene cloth2500 --duration 0.01 --fps 200 --trace fall.h5
for writer in 'report f1 --out' 'render --scene jeans4k --out' 'export fall.h5 --format obj --frames all --out'; do
  # shellcheck disable=SC2086 # the words of a command
  expect 2 '^mssim: cannot write -: .*\./-' $writer -
done
[ -z "$(find . -name '-*')" ] || fail "written: $(find . -name '-*')"
for listing in suites columns methods; do
  "$mssim" list $listing >/dev/full 2>err && fail "a full standard output is no error"
  warns 'No space left on device.*redirect'
done

# Values.
expect 2 '^mssim: --threads: "x" is not a whole number from 1 to 4096; see mssim bench --help$' bench --scene cloth2500 --threads x
expect 2 '^mssim: --threads: "0" is not a whole number from 1 to 4096;' bench --scene cloth2500 --threads 0
for list in 1,,2 2,2 1,0 1,two "1," ",1"; do
  expect 2 "^mssim: --threads: \"$list\" is not a list of different whole numbers from 1 to 4096;" bench --scene cloth2500 --threads "$list"
done
expect 2 '^mssim: --threads: "1,2" is not a whole number from 1 to 4096;' run --scene cloth2500 --threads 1,2
expect 2 '^mssim: --threads 4000 is too many for the ' bench --scene cloth2500 --threads 1,4000
expect 2 '^mssim: a list of --threads cannot be used with --suite guide' bench --suite guide --threads 1,2
expect 2 '^mssim: WHAT: unknown word "scnes" (did you mean scenes?): known are ' list scnes
for command in bench guide; do
  expect 2 '^mssim: --time-budget: "1e10" is not a number from 0.001 to 1e+08;' $command --scene cloth2500 --time-budget 1e10
done
expect 2 '^mssim: --launcher: "  " names no program; see mssim bench --help$' bench --scene cloth2500 --backend mpi --launcher '  '
expect 2 '^mssim: --precision: unknown precision "half": known are single and double;' run --scene cloth2500 --precision half
expect 2 '^mssim: --suite: unknown suite "all" (did you mean tables?): known are table1, .* and tables;' bench --suite all
expect 2 '^mssim: unknown integrator "euler" (did you mean .*semi-euler.*explicit-euler' bench --scene cloth2500 --integrator euler
expect 2 '^mssim: serial:doubel: unknown suffix "doubel" (did you mean double?): known are each and double$' bench --scene cloth2500 --backend serial:doubel
expect 2 'backend hybrid does not go with this command or suite: give serial, openmp, .* or mpi-copies$' bench --suite peers --backend hybrid
expect 2 'backend algorithm1 does not go with this command or suite: give serial, ' guide --scene cloth2500 --backend algorithm1
expect 2 '^mssim: --fps times frames for the result folder: give --out too$' bench --scene cloth2500 --fps 60
expect 2 '^mssim: --fps 1e+09 makes frames shorter than a step of 5e-05 s on cloth2500: give a smaller number$' \
  bench --scene cloth2500 --fps 1e9 --out never
cp "$source/src/starters/examples/"*.cpp mine.cpp
expect 3 'mine.cpp is the source of a program: compile it' bench --scene cloth2500 --backend ./mine.cpp
for suffixes in :AVX2:x ::4 :4:each; do
  expect 2 "openmp$suffixes: \"$suffixes\" is not a suffix; .* as in openmp:each:4" bench --scene cloth2500 --backend openmp$suffixes
done
expect 2 'openmp:doubel: unknown suffix "doubel" (did you mean double?): known are each, double, .* and a number from 1 to 4096$' \
  bench --scene cloth2500 --backend openmp:doubel
expect 2 'unknown backend "gpu" (did you mean opencl?)' bench --scene cloth2500 --backend gpu
touch mine.py
expect 2 'unknown backend "mine.py": .*\./mine.py$' bench --scene cloth2500 --backend mine.py
expect 2 'no scene is named "cloth350" (did you mean cloth350k?): .*mssim list scenes' bench --scene cloth350
ends 0 bench --suite tables --dry-run
[ "$(grep -c '^\(cloth\|bodies\)[0-9]' "$work/out")" -eq 12 ] || fail "--suite tables is not the tables: $(cat "$work/out")"
ends 0 list scenes --format JSON
