#!/usr/bin/env bash
# Programs of the user's are backends, and whatever they do wrong is one sentence in their row.
set -euo pipefail
. "$2/tests/support/command_line.sh"
export XDG_CONFIG_HOME=$work/config TMPDIR=$work/tmp
mkdir -p tmp backends config/mssim/backends
program=${mssim%/*}/../bin/own_backend  # tests/support/own_backend.cpp
ln -s "$(realpath "$program")" spring_list

# describe NAME [FIELDS]: a description of the program that makes the mistake of that name
describe() {
  printf '{"command": ["%s", "%s"]%s}\n' "$work/spring_list" "$1" "${2:+, $2}" >"backends/$1.json"
}

has_no_process() { ! pgrep -f "^$work/spring_list" >/dev/null; }
# nothing_left WHAT: no process of the program, and no folder of mssim's for one
nothing_left() {
  soon 2 has_no_process || fail "$1 leaves a process"
  [ -z "$(ls tmp)" ] || fail "$1 leaves $(ls tmp)"
}

bench=(bench --scene cloth2500 --integrator semi-euler --rounds 2 --threads 1)

# A right program, by its path, has every integrator, and its rows hold what it said of itself.
explicit=$(explicit_integrators | paste -sd,) explicit_count=$(explicit_integrators | wc -l)
ends 0 bench --scene cloth2500 --backend serial,./spring_list --integrator "$explicit" --rounds 2 --threads 1 --out right
all_verified right $((2 * explicit_count))
[ "$(column_of right/timings.csv backend | grep -c '^spring_list$')" -eq "$explicit_count" ] || fail "the rows are not called spring_list"
[ "$(column_of right/timings.csv note | grep -cE '^double precision; a list of springs($|; )')" -eq "$explicit_count" ] || fail "the notes are lost"
column_of right/timings.csv processors_used | are 'x > 0 && x < 1.5' ||
  fail "processors_used is $(column_of right/timings.csv processors_used | xargs)"
grep -A 3 '"spring_list"' right/provenance.json | grep -q '"./spring_list"' || fail "the provenance does not name the program"
[ ! -e right/programs ] || fail "a program that writes nothing has a file of it"
nothing_left "a right program"
ends 3 bench --scene cloth2500 --integrator implicit-euler --rounds 2 --threads 1 --backend serial,./spring_list --out implicit
grep -q 'unsupported: it has no implicit-euler' implicit/timings.csv || fail "a program without implicit integrators is not told so"

# A program that only listens, and writes down how mssim begins. Each line is in docs/protocol.md.
cat >listen <<PYTHON
#!/usr/bin/python3
import os, socket
mssim = socket.socket(socket.AF_UNIX)
mssim.connect(os.environ["MSSIM_SOCKET"])
with open("$work/heard", "wb") as heard:
    for line in mssim.makefile("rb"):
        heard.write(line)
        if line == b"prepare\n": break
mssim.sendall(b"unavailable it only listens\n")
PYTHON
chmod +x listen
ends 3 bench --scene cloth2500 --integrator semi-euler --rounds 2 --threads 1 --backend serial,./listen --out listening
sed -i 's# \(/.*\)/[^/]*$# \1#; s#/[^ ]*#PATH#' heard
diff - heard <<'END' || fail "mssim begins in another way than docs/protocol.md says"
mssim-backend 1
scene cloth2500
dt 5.0000000000000002e-05
threads 1
integrator semi-euler
stage x v
assign v_next 1 0 v 1 1 a
assign x_next 1 0 x 1 1 v_next
system PATH
state PATH
prepare
END

# What programs do wrong (more of it in tests/backends/process): each has its sentence, and the rows beside it are measured.
mistakes=(unsupported unavailable fails-early many-notes crashes hangs-early ends-early exits hangs ignores-signals leaves-children
  binary nan floods tells-time idle lazy huge-costs)
for mistake in "${mistakes[@]}"; do describe "$mistake"; done
ends 1 "${bench[@]}" --backend "serial$(printf ',%s' "${mistakes[@]}")" --backend-folder backends --backend-limit 2 \
  --out wrong
nothing_left "programs that are wrong"

# row NAME TEXT: the program's row says that, as a part of its line
row() {
  grep "^cloth2500,[0-9,]*,$1," wrong/timings.csv | grep -qF -- "$2" ||
    fail "$1: $(grep "^cloth2500,[0-9,]*,$1," wrong/timings.csv)"
}
row serial ,true,ok,
row unsupported ',unsupported: it has only red springs,'
row unavailable ',unavailable: there is no such chip here,'
row fails-early 'failed: fails-early failed at ""prepare"": the licence has run out'
row many-notes 'failed: many-notes answered ""prepare"" with more than 100 lines'
row crashes 'failed: crashes was ended by signal 11 (Segmentation fault) before it answered ""prepare""'
row hangs-early 'failed: hangs-early did not answer ""prepare"" within 2 s'
row ends-early 'failed: ends-early ended with exit code 0 before it connected to MSSIM_SOCKET'
row exits 'failed: exits ended with exit code 3 before it answered ""step 1""; its last line: out of cake'
for mistake in hangs ignores-signals leaves-children; do
  row "$mistake" "failed: $mistake did not answer \"\"step 1\"\" within 2 s"
done
row binary 'to ""step 1"", where done, or failed and a reason, is expected'
row nan 'failed: blew up at step 1 (t = 5e-05 s): node 7 is not finite'
row floods ,true,ok,
row tells-time ,true,ok,
row idle 'failed: position error '
row lazy 'failed: position error '
row huge-costs 'failed: bytes_per_step is beyond 1e300'

# What they wrote last stays.
[ "$(cat wrong/programs/cloth2500-exits-semi-euler.txt)" = 'out of cake' ] || fail "the output of exits is lost"
[ "$(tail -n 1 wrong/programs/cloth2500-floods-semi-euler.txt)" = 'flood number 99999' ] || fail "the output of floods is lost"
[ "$(wc -c <wrong/programs/cloth2500-floods-semi-euler.txt)" -le 65536 ] || fail "the output of floods is too long"
[ "$(find wrong/programs -type f | wc -l)" -eq 2 ] || fail "wrong/programs holds $(ls wrong/programs)"

# A finished folder is left as it is; another program under the same name is another result.
describe floods '"environment": {"A": "1"}'
ends 0 "${bench[@]}" --backend serial,floods --backend-folder backends --out again
grep -A 1 '"environment": {' again/provenance.json | grep -q '"A": "1"' || fail "the provenance does not tell of a description's variables"
cp again/timings.csv before
ends 0 "${bench[@]}" --backend serial,floods --backend-folder backends --out again --resume
cmp -s before again/timings.csv || fail "--resume changes a finished folder"
describe floods '"environment": {"A": "2"}'
expect 2 'a program that is a backend is not the same' "${bench[@]}" --backend serial,floods --backend-folder backends --out again --resume
expect 2 'the program floods is not the same' "${bench[@]}" --backend serial,floods --backend-folder backends --verified again
printf '{"command": ["%s"]}' "$work/spring_list" >backends/floods.json
expect 2 'a program that is a backend is not the same' "${bench[@]}" --backend serial,floods --backend-folder backends --out again --resume
mkdir again/programs/mine
echo mine | tee again/programs/mine/file >again/notes.txt
ends 0 "${bench[@]}" --backend serial,floods --backend-folder backends --out again --overwrite
[ "$(find again/programs again/notes.txt -type f -printf '%p ')" = 'again/programs/mine/file again/notes.txt ' ] || fail "--overwrite leaves, of programs and the user: $(find again/programs)"

# Ctrl-C and Ctrl-\ end a wait, without --backend-limit of two minutes, and leave nothing; nor does SIGKILL.
describe hangs
nothing_of_it() { [ ! -e "$state" ] && [ -z "$(ls tmp)" ]; }
for signal in INT:130 QUIT:131 KILL:137; do
  begins "${bench[@]}" --backend serial,hangs --backend-folder backends --out "stopped$signal"
  soon 10 pgrep -f "^$work/spring_list hangs" >/dev/null || fail "no program is begun"
  sleep 0.5
  state=$(tr '\0' '\n' <"/proc/$(pgrep -f "^[^ ]*/supervise .*$work/spring_list hangs")/cmdline" | grep -m 1 '^/dev/shm/mssim-' || true)
  seconds=$SECONDS
  is_ended "${signal#*:}" "${signal%:*}"
  ((SECONDS - seconds <= 6)) || fail "SIG$signal does not end a wait"
  soon 2 nothing_of_it || true
  nothing_left "SIG$signal"
  [ ! -e "$state" ] || fail "SIG$signal leaves $state"
done

# A program that cannot be started fails alone; a comma may be part of a path; folders of mssim's may have long or relative names.
printf '#!/usr/bin/env python3\r\n' >crlf
chmod +x crlf
ln -s spring_list a,b
ends 1 "${bench[@]}" --backend serial,./crlf,./a,b --out unstarted
[ "$(grep -c '\(,serial,\|,"a,b",\).*,true,ok,' unstarted/timings.csv)" -eq 2 ] || fail "beside them there is: $(cat unstarted/timings.csv)"
grep -q 'failed: cannot run .*crlf: .*CR LF' unstarted/timings.csv || fail "crlf: $(cat unstarted/timings.csv)"
mkdir "$(printf 'long%.0s' {1..25})"
for folder in tmp "$PWD"/long*; do
  TMPDIR=$folder ends 0 "${bench[@]}" --backend serial,floods --backend-folder backends
  [ -z "$(ls "$folder")" ] || fail "$folder holds $(ls "$folder")"
done
broken=$'a\nfolder'
mkdir "$broken"
TMPDIR=$PWD/$broken ends 1 "${bench[@]}" --backend serial,./spring_list --out broken
grep -q 'failed: .*line break; set TMPDIR' broken/timings.csv || fail "a line break in TMPDIR: $(cat broken/timings.csv)"
TMPDIR=$work/none "$mssim" "${bench[@]}" --backend serial,./spring_list --out nowhere >out 2>err && fail "a missing TMPDIR is not told"
grep -q '^cloth2500,[0-9,]*,serial,.*,true,ok,' nowhere/timings.csv || fail "a missing TMPDIR costs serial: $(cat err)"

mkdir twin
printf '{"command": ["true"]}' >twin/serial.json
printf '{"command": ["true"]}' >twin/here.json
printf '{"comand": ["true"]}' >wrong.json
echo text >wrong.txt

# Descriptions: found in the folder, in the user's own, and beside a scene's file.
describe here '"description": "a list of springs", "scenes": ["bodies"], "integrators": ["rk4"]'
cp backends/here.json config/mssim/backends/mine.json
ends 0 list backends --backend-folder backends --format csv
grep -q '^here,bodies,,true,a list of springs,$' "$work/out" && grep -q '^mine,bodies,,true,' "$work/out" || fail "list backends: $(cat "$work/out")"
XDG_CONFIG_HOME=config HOME=$work ends 0 list backends --format csv
! grep '^mine,' "$work/out" || fail "a relative XDG_CONFIG_HOME counts"
warning 'mine, semi-euler: unsupported: it steps bodies only$' ends 3 "${bench[@]}" --backend mine
cp "$2/scenes/cloth2500.json" small.json
printf '{"command": ["./spring_list"]}' >beside.json
ends 0 bench --scene ./small.json --backend beside --integrator semi-euler --rounds 2
expect 2 '(did you mean here?)' "${bench[@]}" --backend heer --backend-folder backends
expect 2 'there are two backends called here' "${bench[@]}" --backend here --backend-folder backends,twin
expect 2 "has the same name as mssim's backend serial" "${bench[@]}" --backend serial --backend-folder twin
mkdir odd
for name in 'openmp:1' 'serial:double' 'x,y'; do
  printf '{"command": ["../spring_list"]}' >"odd/$name.json"
  expect 2 "$name.json: in the name of a backend" "${bench[@]}" --backend "./odd/$name.json"
done
# One that cannot be used costs no other its place in a list, nor in a message. A folder may be named twice.
cp wrong.json odd/broken.json
cp backends/here.json odd
ln -s nothing odd/dangling.json
saying '^here ' ends 0 list backends --backend-folder odd,./odd
[ "$(grep -c '^here ' "$work/out")" -eq 1 ] || fail "a folder that is named twice has a backend twice: $(cat "$work/out")"
for reason in 'broken.json: /comand is not a known key' 'dangling.json' 'openmp:1.json: in the name of a backend' 'x,y.json: in the name of a backend'; do
  warns "a backend is not shown: .*$reason"
done
expect 2 '(did you mean here?)' "${bench[@]}" --backend heer --backend-folder odd
expect 2 'broken.json: /comand is not a known key' "${bench[@]}" --backend broken --backend-folder odd
expect 2 'dangling.json' "${bench[@]}" --backend dangling --backend-folder odd
expect 2 'no-folder is not a folder: give one' "${bench[@]}" --backend here --backend-folder no-folder
expect 2 'integrator all stands for every integrator: give no other' bench --scene cloth2500 --integrator all,rk4
# One file in two spellings is one backend, and no other has the name of one of mssim's.
ends 0 "${bench[@]}" --backend "./spring_list,$work/spring_list" --out spellings
[ "$(column_of spellings/timings.csv backend | xargs)" = spring_list ] || fail "one file is two backends: $(cat spellings/timings.csv)"
cp spring_list mpi
expect 2 "has the same name as mssim's backend mpi; rename it" "${bench[@]}" --backend ./mpi
expect 2 './spring_list:2 has a suffix, .*: give ./spring_list, .*--threads 1,2' "${bench[@]}" --backend ./spring_list:2
expect 2 '/comand is not a known key' "${bench[@]}" --backend ./wrong.json
expect 3 'there is no program ./nothing' "${bench[@]}" --backend ./nothing
expect 3 'wrong.txt .*chmod +x' "${bench[@]}" --backend ./wrong.txt

# Two programs of mssim are compared by how they time one.
ends 0 compare --ab "$mssim" "$mssim" --scene cloth2500 --backend ./spring_list --time-budget 10
says 'spring_list'

# run has them too.
ends 0 run --scene cloth2500 --backend ./spring_list --duration 0.02 --trace fall.h5
says ' spring_list '
warning 'exits ended with exit code 3 before it answered' ends 1 run --scene cloth2500 --backend exits --backend-folder backends
warns '^out of cake$'  # all that it has printed
# Its reasons name the backend as it was asked for, and the scenes and integrators that the backend has.
expect 2 '^mssim: here: .*bodies' run --scene cloth2500 --backend here --backend-folder backends
describe slow '"integrators": ["rk4", "xpbd"]'
expect 2 '^mssim: slow: .*midpoint.*rk4 and xpbd' run --scene cloth2500 --integrator midpoint --backend slow --backend-folder backends
expect 2 '^mssim: ./spring_list: .*xpbd.*explicit' run --scene cloth2500 --integrator xpbd --backend ./spring_list
expect 2 '^mssim: algorithm1: .*garments' run --scene cloth2500 --backend algorithm1
printf '{"command": ["no-such-program"]}' >backends/gone.json
expect 3 '^mssim: gone: .*no-such-program' run --scene cloth2500 --backend gone --backend-folder backends
nothing_left "run"
# The frames before a failure are kept: the start and those of two requests.
ends 1 run --scene cloth2500 --backend exits --backend-folder backends --duration 0.02 --fps 1000 --trace cut.h5 --energy-curve cut.csv
warns 'exits ended with exit code 3 before it answered "step '
warns 'wrote cut.h5 and cut.xdmf'
[ -s cut.h5 ] && [ ! -e cut.h5.part ] && [ "$(grep -c '^[0-9]' cut.csv)" -eq 3 ] || fail "a failure costs frames: $(ls cut*; cat cut.csv)"
