#!/usr/bin/env bash
# What mssim run writes: one writer a file, no file over another, everything that was recorded kept.
set -euo pipefail
. "$2/tests/support/command_line.sh"

fall=(run --scene cloth2500 --threads 1)

# frames TRACE: how many frames it has
frames() { numbers_of "$1" /particles/cloth/position/step | wc -l; }

# A second run into files that are being written: told so, and the first one's are whole.
begins "${fall[@]}" --duration 10000 --fps 5 --trace tw.h5 --energy-curve tw.csv
soon 30 test -s tw.csv.part && soon 30 test -e tw.h5.part || fail "no files are begun"
expect 4 'another mssim is writing tw.h5; wait until it has ended, or choose another file name' \
  "${fall[@]}" --duration 0.01 --trace tw.h5
expect 4 'another mssim is writing tw.csv; wait until' "${fall[@]}" --duration 0.01 --energy-curve tw.csv
expect 4 'another mssim is writing ./tw.csv' "${fall[@]}" --duration 0.01 --trace other.h5 --energy-curve ./tw.csv
[ ! -e other.h5.part ] || fail "a refused run leaves a file"
sleep 0.5
is_ended 130 INT
[ "$(frames tw.h5)" -ge 2 ] || fail "the trace of the first run is broken"
[ "$(frames tw.h5)" -eq "$(grep -c '^[0-9]' tw.csv)" ] || fail "the trace and the curve of the first run differ"

# One name for two files.
expect 2 '--trace and --energy-curve are the same file, ./x.h5; give them different names' \
  "${fall[@]}" --trace ./x.h5 --energy-curve x.h5
expect 2 'the XDMF beside --trace and --energy-curve are the same file' "${fall[@]}" --trace x.h5 --energy-curve x.xdmf
expect 2 '--energy-curve is curve.png, .*CSV: give curve.csv' "${fall[@]}" --energy-curve curve.png
cp "$source/scenes/cloth2500.json" mine.json
expect 2 '--energy-curve and a file of the scene are the same file' run --scene ./mine.json --energy-curve mine.json
cmp -s mine.json "$source/scenes/cloth2500.json" || fail "a scene was overwritten"
# The mesh of another scene, whose shape the scene takes.
mkdir other
printf '4 3 0 0\n1 0 0 0\n2 3 0 0\n3 0 3 0\n4 0 0 3\n' >other/one.node
printf '1 4 0\n1 1 2 3 4\n' >other/one.ele
python3 - "$source/scenes/box-small.json" <<'PYTHON'
import json, sys

scene = json.load(open(sys.argv[1]))
body = scene["bodies"]["list"][0]
del body["box"]
body.update(shape="tetgen", tetgen={"node_file": "one.node", "ele_file": "one.ele", "unit_m": 0.01})
json.dump(scene, open("other/one.json", "w"))
del body["tetgen"]
body.update(shape="scene", scene={"name": "other/one.json"})
json.dump(scene, open("same-shape.json", "w"))
PYTHON
ends 0 run --scene ./same-shape.json --threads 1 --duration 0.01 --energy-curve good.csv
for file in one.node one.ele one.json; do
  before=$(<"other/$file")
  expect 2 "--energy-curve and a file of the scene are the same file, other/$file" \
    run --scene ./same-shape.json --energy-curve "other/$file"
  [ "$(<"other/$file")" = "$before" ] || fail "$file of another scene was overwritten"
done
# The user's program, its description and what its command names.
mkdir own
printf '#!/bin/sh\nexit 3\n' | tee own/prog >own/script
chmod +x own/prog
echo '{"command": ["./prog", "script"]}' >own/mine.json
before=$(cat own/*)
by_own=("${fall[@]}" --duration 0.001 --backend)
expect 2 '--energy-curve and the program of the backend are the same file' "${by_own[@]}" ./own/prog --energy-curve own/prog
expect 2 '--energy-curve and the program of the backend are the same file' "${by_own[@]}" own/mine.json --energy-curve own/prog
expect 2 '--energy-curve and the description of the backend are the same file' "${by_own[@]}" own/mine.json --energy-curve own/mine.json
expect 2 "--energy-curve and a file of the backend's command are the same file" "${by_own[@]}" mine --backend-folder own --energy-curve own/script
cp own/prog own/prog.png
expect 2 '--out and the program of the backend are the same file' render --scene cloth2500 --backend ./own/prog.png --out own/prog.png
rm own/prog.png
[ "$(cat own/*)" = "$before" ] || fail "a file of the backend was overwritten"
expect 2 '--trace and --pictures are the same file, x.h5' "${fall[@]}" --trace x.h5 --pictures x.h5
[ -z "$(find . -name 'x.*')" ] || fail "a refused run leaves a file"

# A link in the place of the trace is followed.
mkdir elsewhere
ln -s elsewhere/real.h5 link.h5
ends 0 "${fall[@]}" --duration 0.01 --trace link.h5
[ -L link.h5 ] && [ -s elsewhere/real.xdmf ] && [ "$(frames elsewhere/real.h5)" -ge 1 ] || fail "a link is not followed: $(ls -l . elsewhere)"

# Pictures while it runs: one a frame, into a folder of their own, and the last is what the trace shows at the end.
ends 0 "${fall[@]}" --duration 0.1 --fps 20 --pictures new/shots --size 160x120 --view side --trace shots.h5
[ "$(cd new/shots && echo *)" = 'frame-000000.png frame-000001.png frame-000002.png' ] ||
  fail "the folder of pictures holds $(ls new/shots)"
[ "$(cat err)" = $'mssim: wrote shots.h5 and shots.xdmf\nmssim: wrote 3 pictures into new/shots' ] || fail "a run says it wrote $(cat err)"
ends 0 render shots.h5 --frames 0 --size 160x120 --view side --out start.png
cmp -s start.png new/shots/frame-000000.png || fail "the first picture is not the trace's first frame"
expect 2 'new/shots, which is not empty; empty it or choose another folder' \
  "${fall[@]}" --duration 0.01 --pictures new/shots --trace refused.h5
[ -z "$(find . -name 'refused*')" ] || fail "a refused run leaves a file"
expect 2 '--size needs --pictures' "${fall[@]}" --size 160x120
expect 2 '"up" is not a view' "${fall[@]}" --pictures unseen --view up
[ ! -e unseen ] || fail "a refused run leaves a folder"

# Steps that are too long: a simulation may blow up in finite numbers. The remedy of too many frames works as it is printed.
ends 1 "${fall[@]}" --duration 0.01 --dt 1e-3 --energy-curve grown.csv
warns 'blew up: its energy has grown by .* J at 0.01 s, and the scene has .* J that can move; take a smaller --dt'
[ "$(grep -c '^[0-9]' grown.csv)" -eq 2 ] || fail "the curve of a simulation that blew up: $(cat grown.csv)"
expect 2 'give --fps 1.66666e+06 or less' "${fall[@]}" --dt 6e-7 --fps 1e9 --duration 3e-6
ends 0 "${fall[@]}" --dt 6e-7 --fps 1.66666e+06 --duration 3e-6

# A disk that is full: the trace and the energies of its frames are kept.
on_full_disk 2000 'cannot write full.h5: .*full.h5.part keeps the frames .*; full.csv.part keeps the energies written before: ' \
  "${fall[@]}" --duration 10 --trace full.h5 --energy-curve full.csv
kept=$(frames full.h5.part)
[ "$kept" -ge 1 ] && [ "$(grep -c '^[0-9]' full.csv.part)" -ge "$kept" ] || fail "$kept frames, energies: $(cat full.csv.part)"
[ ! -e full.h5 ] && [ ! -e full.csv ] || fail "a full disk leaves files under their names"

# An XDMF that cannot be written is noticed before the simulation.
ln -s elsewhere blocked.xdmf.part
expect 4 'blocked.xdmf.part is a link' "${fall[@]}" --duration 1000 --trace blocked.h5
[ ! -e blocked.h5 ] && [ ! -e blocked.h5.part ] || fail "a refused run leaves a trace"

# Double precision is stored as such; springs stand with what a strain is computed from.
"$mssim" "${fall[@]}" --backend serial --precision double --duration 0.01 --fps 200 --trace double.h5 >out
h5dump -H -d /particles/cloth/position/value double.h5 | grep H5T_IEEE_F64LE >/dev/null || fail "double is stored as single"
"$mssim" "${fall[@]}" --backend openmp:double --duration 0.01 --fps 200 --trace vectors.h5 >out
h5dump -H -d /particles/cloth/position/value vectors.h5 | grep H5T_IEEE_F64LE >/dev/null || fail "openmp:double is stored as single"
grep -q 'NumberType="Float" Precision="8".*/xdmf/position/' double.xdmf || fail "the XDMF of double precision: $(head -n 9 double.xdmf)"
"$mssim" "${fall[@]}" --duration 0.01 --fps 200 --trace single.h5 >out
h5dump -H -d /particles/cloth/position/value single.h5 | grep H5T_IEEE_F32LE >/dev/null || fail "single is stored as double"
for number in rest_length stiffness damping; do
  h5dump -H -d "/parameters/springs/$number" single.h5 | grep 'SIMPLE { ( 14502 ) ' >/dev/null || fail "no $number a spring"
done

# On a terminal a run says how far it is, and takes the line away; elsewhere it says nothing.
export TERM=xterm
script -qec "'$mssim' run --scene cloth2500 --threads 1 --duration 1" /dev/null </dev/null >terminal
grep -q 'cloth2500  \[.*\]  about 0:[0-9][0-9] left  step [0-9]* of 20000' terminal || fail "no progress: $(head -c 500 terminal)"
script -qec "'$mssim' run --scene jeans1k --threads 1" /dev/null </dev/null >terminal
grep -q 'jeans1k  \[ *\]  draping, [0-9.]* s simulated of at most 4' terminal || fail "no progress of a dressing"
script -qec "stty cols 80; '$mssim' run --scene cloth2500 --threads 1 --duration 0.01" /dev/null </dev/null | tr -d '\r' >terminal
grep -q '^integrator  *semi-euler$' terminal && grep -q '^wall_s  *[0-9.]*$' terminal || fail "the result on a terminal: $(tail -n 20 terminal)"
! grep -q 'damping_loss_j' terminal || fail "a terminal shows what a run has not"
"$mssim" "${fall[@]}" --duration 0.1 >out 2>err
[ ! -s err ] || fail "a run that is no terminal's writes to stderr: $(cat err)"
