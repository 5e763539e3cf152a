#!/usr/bin/env bash
# Nothing that was measured or traced is lost, whatever ends mssim.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# The tests set it to be quick on few processors. Here one run has it and the others must not.
unset OMP_WAIT_POLICY
scenes=(bench --scene cloth2500,cloth4900 --integrator semi-euler --threads 1)
bench=("${scenes[@]}" --backend serial,openmp --rounds 6)

# rounds FOLDER: the rounds of every row of FOLDER/timings.csv, in one line
rounds() { awk -F, 'NR > 1 { printf "%s ", $10 }' "$1/timings.csv"; }

# whole FOLDER: every file of a result folder is whole: all lines of a CSV file have as many fields, JSON is closed
whole() {
  local file
  for file in "$1"/*.csv; do
    awk -F, -v file="$file" 'NR == 1 { n = NF } NF != n { print file ": line " NR " is cut off"; bad = 1 } END { exit bad || NR == 0 }' \
      "$file" || fail "$file is not whole"
  done
  for file in "$1"/*.json; do
    [ "$(tail -c 2 "$file")" = '}' ] || fail "$file is not whole"
  done
}

# render --scene leaves no trace behind, also if it is ended while it draws.
mkdir temporary
TMPDIR=$work/temporary begins render --scene cloth2500 --duration 0.1 --fps 1000 --size 2048x2048 --movie drawn.webp
soon 60 bash -c 'test -e temporary/mssim-*/scene.xdmf' || fail "render makes no trace: $(cat err)"
sleep 1
is_ended 143 TERM
[ -z "$(ls temporary)" ] || fail "render leaves $(find temporary)"

# SIGINT: what is measured stands in whole files and on stdout, and the exit status says it.
begins "${bench[@]}" --out int
is_ended 130 INT 60 test -e int/timings.csv
warns 'results so far are in int; --resume continues'
grep -q '^cloth2500: ' out && grep -q '^  [a-z0-9-]*  *serial ' out || fail "after SIGINT nothing is printed"
# Others that read the folder hear that nothing has checked the samples.
unchecked='the samples of [1-4] rows* are not checked, because the run was ended before that; bench --resume'
warns "$unchecked"
warning "int: $unchecked" ends 0 compare int int
warning "int: $unchecked" ends 0 history add int --file history.jsonl
whole int
case $(rounds int) in
  '6 6 6 6 ') fail "SIGINT came too late to be tested" ;;
esac
# first_sample: as it was measured; whether it is an outlier is known when there are more
first_sample() { grep '^cloth2500,serial,semi-euler,1,' int/samples.csv | cut -d, -f1-6; }
before=$(first_sample)

# --resume keeps that and measures the rest; a finished folder is left as it is.
ends 0 "${bench[@]}" --out int --resume
[ "$(rounds int)" = '6 6 6 6 ' ] || fail "after --resume the rows have the rounds $(rounds int)"
grep -A 1 '"earlier_starts_utc": \[' int/provenance.json | grep '"20' >/dev/null || fail "the provenance does not tell of the first run"
[ "$(first_sample)" = "$before" ] || fail "--resume has lost a sample"
[ "$(grep -c '^cloth2500,serial,' int/samples.csv)" -eq 6 ] || fail "cloth2500 has not six samples"
whole int
cp int/samples.csv kept
ends 0 "${bench[@]}" --out int --resume
cmp -s kept int/samples.csv || fail "--resume measured a finished folder again"
sed -n '/^cloth4900: /,$p' out | grep -q ' openmp ' || fail "--resume of a finished folder prints no table"

# Results are neither replaced nor mixed unawares.
expect 2 'int already holds results: give another --out, --resume .*or --overwrite' "${bench[@]}" --out int
cmp -s kept int/samples.csv || fail "a refused bench has changed the folder"
warning 'int has other backends or integrators of cloth2500' ends 2 "${scenes[@]}" --backend serial --rounds 6 --out int --resume
# Also before a scene that comes first is measured.
ends 2 bench --scene cloth10k,cloth2500,cloth4900 --integrator semi-euler --threads 1 --backend serial --rounds 1 --out int --resume
warns 'int has other backends or integrators of cloth2500'
! grep -q cloth10k int/timings.csv || fail "a refused --resume has measured cloth10k"
cp -r int moved
sed -i 's/"model": ".*"/"model": "Another CPU"/; s/"asked_for": 1/"asked_for": 8/' moved/provenance.json
expect 2 'cannot continue in moved: the CPU was Another CPU[ ,].*; the number of threads was 8 and is 1; choose another' \
  "${bench[@]}" --out moved --resume
cp -r int rebuilt
sed -i 's/\("program_fnv1a_64": "\)..../\10000/' rebuilt/provenance.json
expect 2 'cannot continue in rebuilt: it is from another build of the program' "${bench[@]}" --out rebuilt --resume
cp -r int elsewhere
sed -i '/"allowed_cpus": \[/,/\]/ s/[0-9][0-9]*/1234/' elsewhere/provenance.json
expect 2 'cannot continue in elsewhere: the CPUs that it may use were 1234.* and are [0-9,]*; choose another' "${bench[@]}" --out elsewhere --resume
OMP_WAIT_POLICY=passive expect 2 'cannot continue in int: the environment of OpenMP was .* and is .*OMP_WAIT_POLICY=passive' \
  "${bench[@]}" --out int --resume
expect 2 'cannot continue in int: --roots was fast and is exact; choose another' "${bench[@]}" --roots exact --out int --resume
OMP_DISPLAY_AFFINITY=false ends 0 "${bench[@]}" --out int --resume
expect 2 'resume' bench --scene cloth2500 --resume
expect 2 'cannot continue in int: it has results of cloth2500, which this command leaves out; choose another' \
  bench --scene cloth4900 --integrator semi-euler --threads 1 --backend serial,openmp --rounds 6 --out int --resume
ends 0 "${scenes[@]}" --backend opencl --rounds 2 --memory copy --out copied
cp copied/timings.csv kept.csv
ends 2 "${scenes[@]}" --backend opencl --rounds 3 --out copied --resume
warns 'cannot continue in copied: --memory was copy and is shared; choose another'
for changed in 's/driver [0-9]/driver 99/:the OpenCL devices or their drivers' 's/"tetgen": .*/"tetgen": "0.1",/:TetGen'; do
  cp -r copied other
  sed -i "${changed%:*}" other/provenance.json
  expect 2 "cannot continue in other: ${changed##*:}.* not the same; choose another" "${scenes[@]}" --backend opencl --rounds 3 \
    --memory copy --out other --resume
  rm -r other
done
cmp -s kept.csv copied/timings.csv || fail "a refused --resume has changed the rows"
expect 2 'overwrite' "${bench[@]}" --out int --resume --overwrite
cp -r int before
for signal in INT:130 KILL:137; do
  begins bench --scene cloth350k --backend serial --out int --overwrite
  is_ended "${signal#*:}" "${signal%:*}" 60 grep -q 'cloth350k (1 of 1)' err
  [ "$signal" = KILL:137 ] || grep -q 'earlier results are still in int' err || fail "SIGINT before there is a row: $(cat err)"
  diff -r before int || fail "--overwrite that is ended by SIG$signal before it has a row changes what is there"
done
begins bench --scene cloth350k --backend serial --out new --overwrite
is_ended 130 INT 60 grep -q 'cloth350k (1 of 1)' err
warns 'nothing was measured yet; --resume continues'
ends 0 bench --scene cloth2500 --backend serial --integrator semi-euler --rounds 1 --out int --overwrite
[ "$(rounds int)" = '1 ' ] || fail "--overwrite left $(rounds int)"
[ "$(wc -l <int/samples.csv)" -eq 2 ] || fail "--overwrite left samples"

# Tables of what scenes are count as results, and what is replaced leaves nothing of what was there.
ends 0 bench --suite table2 --out tables
expect 2 'tables already holds results' bench --scene cloth2500 --out tables
expect 2 'cannot continue in tables: it has results of box-large, box-medium, .*, torus-small, which this command leaves out' bench --scene cloth2500 --out tables --resume
cp -r tables before-tables
begins bench --suite tables --scene cloth350k --backend serial --out tables --overwrite
is_ended 130 INT 60 grep -q '(1 of ' err
diff -r before-tables tables || fail "--overwrite of a table that is ended before it has a row changes what is there"
ends 0 bench --scene jeans1k --backend openmp --rounds 1 --out tables --overwrite
[ ! -e tables/table2.md ] && [ -s tables/figure6.md ] || fail "--overwrite leaves $(ls tables)"

# Two files of one name would share their rows.
mkdir one two
cp "$2/scenes/cloth2500.json" one/mine.json
sed 's/"rows": 50/"rows": 40/' one/mine.json >two/mine.json
expect 2 'two scenes called mine, one/mine.json and two/mine.json; name one of them, or rename a file' \
  bench --scene one/mine.json,two/mine.json

# kill -9 at any moment.
for delay in 0.3 0.7 1.1 1.6; do
  begins "${bench[@]}" --out killed --resume
  sleep "$delay"
  kill -9 "$process" 2>/dev/null || true
  wait "$process" 2>/dev/null || true
  [ ! -e killed/timings.csv ] || whole killed
done
ends 0 "${bench[@]}" --out killed --resume
[ "$(rounds killed)" = '6 6 6 6 ' ] || fail "after kill -9 and --resume the rows have the rounds $(rounds killed)"
[ "$(cut -d, -f1-4 killed/samples.csv | sort | uniq -d | wc -l)" -eq 0 ] || fail "a sample stands twice"
whole killed

# A second bench into the same folder.
begins "${scenes[@]}" --backend serial --rounds 1000 --out shared
soon 60 test -e shared/provenance.json || fail "no folder is begun"
soon 60 grep -q '(1 of 2)' err || fail "no scene is begun"  # it writes nothing more into a file that another run is to write
expect 4 'another mssim is writing into shared' "${bench[@]}" --out shared --resume
is_ended 143 TERM

# A reader of stdout that goes away loses nothing of the folder; a closed stdout is an error.
"$mssim" bench --scene cloth2500 --backend serial,openmp --integrator semi-euler --threads 1 --rounds 1 --out piped 2>err | head -n 1 >out || true
[ "$(rounds piped)" = '1 1 ' ] || fail "a closed pipe costs results"
whole piped
status=0
"$mssim" list methods >&- 2>err || status=$?
[ "$status" -eq 4 ] || fail "a closed stdout gives exit status $status"
warns 'standard output could not be written'

# A disk that is full, as a limit on the size of files: the sentence names the file, and no part of one is left.
on_full_disk 8 'cannot write full/' "${bench[@]}" --out full
[ -z "$(find full -name '*.part')" ] || fail "a full disk leaves a half-written file"
whole full
[ -n "$(rounds full)" ] || fail "a full disk costs what was measured before"

# SIGINT while a simulation is traced: the frames so far are in whole files.
begins run --scene cloth2500 --threads 1 --duration 100 --trace fall.h5 --energy-curve fall.csv
is_ended 130 INT 60 test -e fall.h5.part
[ -s fall.h5 ] && [ ! -e fall.h5.part ] || fail "SIGINT loses a trace"
[ "$(wc -l <fall.csv)" -ge 2 ] || fail "SIGINT loses the energies"
h5dump -d /particles/cloth/position/step fall.h5 >frames || fail "the trace cannot be read"

# The same while a garment is dressed.
begins run --scene jeans16k --backend serial --trace dress.h5 --energy-curve dress.csv
is_ended 130 INT 60 test -e dress.h5.part
[ -s dress.h5 ] && [ -s dress.xdmf ] && [ ! -e dress.h5.part ] || fail "SIGINT loses the trace of a dressing"
frames=$(numbers_of dress.h5 /particles/garment/position/step | wc -l)
[ "$frames" -ge 1 ] && [ "$(grep -c '^[0-9]' dress.csv)" -eq "$frames" ] || fail "$frames frames, energies: $(cat dress.csv)"

# One signal ends it within a long frame, too: it looks for signals every 240 steps.
begins run --scene cloth40k --backend openmp --duration 1000 --fps 0.002 --trace long-frame.h5
is_ended 130 INT 60 test -e long-frame.h5.part
make_scene tiny-steps.json jeans1k 's/"dt_s": [^,]*/"dt_s": 1e-9/'
begins run --scene ./tiny-steps.json --backend openmp --trace long-window.h5
is_ended 143 TERM 60 test -e long-window.h5.part

# A second signal ends it at once, also one of another kind and between these looks, half a minute apart here.
begins run --scene cloth350k --backend serial --integrator rk4 --duration 100 --fps 1 --trace twice.h5
soon 60 test -e twice.h5.part || fail "no trace is begun"
# Before the first step, one signal would end it. Field 14 is its time in user code, in hundredths of a second: the first frame takes less.
begun=$(awk '{ print $14 }' "/proc/$process/stat")
# shellcheck disable=SC2016 # awk expands it
soon 60 awk -v begun="$begun" '{ exit $14 < begun + 300 }' "/proc/$process/stat" || fail "no step is begun"
kill -INT "$process"
is_ended 143 TERM 10 grep -q 'a second signal stops at once' err
[ "$(grep -c 'a second signal stops at once' err)" -eq 1 ] || fail "a second signal is only noted: $(cat err)"
