#!/usr/bin/env bash
# Pictures: which frames of a trace or a scene, from where, and what is refused.
set -euo pipefail
. "$2/tests/support/command_line.sh"

# size_of FILE: WIDTHxHEIGHT of a PNG, from its header
size_of() {
  local -a bytes
  read -ra bytes <<<"$(od -An -tu1 -j16 -N8 "$1" | tr '\n' ' ')"
  echo "$((bytes[2] * 256 + bytes[3]))x$((bytes[6] * 256 + bytes[7]))"
}
# expect_picture FILE WIDTHxHEIGHT
expect_picture() {
  [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$1 is no PNG"
  [ "$(size_of "$1")" = "$2" ] || fail "$1 has $(size_of "$1") pixels instead of $2"
}
# frames_of FILE: how many frames an animated WebP has
frames_of() { grep -abo ANMF "$1" | wc -l; }

ends 0 run --scene cloth2500 --duration 0.2 --fps 20 --trace t.h5
ends 0 render t.h5 --size 200x150
expect_picture t.png 200x150
ends 0 render t.h5 --size 200x150 --frames last --out last.png
cmp -s t.png last.png || fail "the last frame is not what is drawn"
ends 0 render t.h5 --size 200x150 --time 0.21 --out late.png
cmp -s t.png late.png || fail "the frame nearest to 0.21 s is not the last one"
ends 0 render t.h5 --size 200x150 --time 0 --out first.png
cmp -s first.png t.png && fail "the first frame looks like the last"
ends 0 render t.h5 --size 200x150 --threads 1 --out one.png
ends 0 render t.h5 --size 200x150 --threads 3 --out three.png
cmp -s one.png three.png || fail "the picture depends on the number of threads"
for view in front side back three-quarter -20,35; do
  ends 0 render t.h5 --size 120x90 --view "$view" --out "from$view.png"
  expect_picture "from$view.png" 120x90
done
for colour in object panel strain; do
  ends 0 render t.h5 --size 320x240 --colour "$colour" --out "$colour.png"
done
cmp -s object.png panel.png || fail "a cloth has panels"
cmp -s object.png strain.png && fail "strain is not shown"
ends 0 run --scene bodies3858 --threads 1 --duration 0.01 --fps 100 --trace bodies.h5
for colour in object panel; do ends 0 render bodies.h5 --size 320x240 --colour "$colour" --out "bodies-$colour.png"; done
cmp -s bodies-object.png bodies-panel.png || fail "bodies have panels"

ends 0 render t.h5 --sheet 2x2 --size 100x80
expect_picture t-sheet.png 233x227
# A legend takes the last place: of two, one is the moment.
ends 0 render t.h5 --sheet 2x1 --size 320x240 --colour strain --out with-legend.png
[ "$(size_of with-legend.png | cut -dx -f1)" -gt 640 ] || fail "the legend has no place of its own"
# Moments 1 ms apart, which look the same, have different times below them.
make_scene still.json cloth2500 \
  's/"gravity_m_per_s2": 9.81/"gravity_m_per_s2": 0/; s/"ripple": .*/"ripple": {"height_m": 0, "wavelength_m": 0.09, "speed_m_per_s": 0},/'
ends 0 run --scene ./still.json --duration 0.005 --fps 1000 --trace still.h5
for frames in 1,2 2,3; do ends 0 render still.h5 --frames $frames --sheet 2x1 --size 80x60 --out "still-$frames.png"; done
cmp -s still-1,2.png still-2,3.png && fail "the times of 1 to 3 ms are written alike"
ends 0 render t.h5 --movie --size 80x60
[ "$(frames_of t.webp)" -eq 5 ] || fail "the movie has $(frames_of t.webp) frames instead of 5"
ends 0 render t.h5 --movie --size 80x60 --frames 1-2,last --out some.webp
[ "$(frames_of some.webp)" -eq 3 ] || fail "the movie has $(frames_of some.webp) frames instead of 3"
ends 0 render t.h5 --size 80x60 --movie named.webp
cmp -s t.webp named.webp || fail "--movie FILE writes something else than --movie"
# Browsers would show frames of 5 ms for 100 ms: every third is taken, unless --fps says otherwise.
ends 0 run --scene cloth2500 --duration 0.1 --fps 200 --trace fast.h5
ends 0 render fast.h5 --movie --size 80x60
[ "$(frames_of fast.webp)" -eq 7 ] || fail "the movie of 21 frames in 0.1 s has $(frames_of fast.webp) frames instead of 7"
ends 0 render fast.h5 --movie --size 80x60 --fps 200
[ "$(frames_of fast.webp)" -eq 21 ] || fail "--fps leaves out $((21 - $(frames_of fast.webp))) of 21 frames"
# A scene has no more frames than steps, unless --fps names a number.
long_steps=(--scene cloth2500 --integrator implicit-euler --dt 0.04 --duration 0.2 --size 80x60)
ends 0 render "${long_steps[@]}" --movie long.webp
[ "$(frames_of long.webp)" -eq 6 ] || fail "the movie of 5 steps has $(frames_of long.webp) frames instead of 6"
ends 0 render "${long_steps[@]}" --time 0.1 --out long.png
ends 0 render "${long_steps[@]}" --frames 2 --out long.png
ends 0 render --scene cloth2500 --duration 0.00004 --size 80x60 --out short.png
ends 0 render --scene cloth2500 --duration 0.0001 --sheet 3x2 --size 80x60 --out short.png
expect 2 'more than one per step of 0.04 s; give --fps 25 or less' render "${long_steps[@]}" --fps 30 --movie long.webp
expect 2 'put the trace before it' render --movie t.h5
for name in movie.png movie.apng; do
  expect 2 "$name, but .*WebP: give movie.webp" render t.h5 --movie --out "$name"
  expect 2 "$name, but .*WebP: give movie.webp" render t.h5 --movie "$name"
done
expect 2 'PNG: give still.png' render t.h5 --out still.webp
expect 2 '--movie and --out both name the file' render t.h5 --movie a.webp --out b.webp

# Without the font, a picture with letters is refused before anything is simulated; others are drawn.
if unshare --mount --map-root-user mount -t tmpfs none /usr/share/fonts 2>err; then
  # shellcheck disable=SC2016 # the inner shell expands $0 and $@
  without_font() { unshare --mount --map-root-user sh -c 'mount -t tmpfs none /usr/share/fonts && exec "$0" "$@"' "$mssim" "$@"; }
  for with_letters in '--colour strain' '--sheet 2x2'; do
    # shellcheck disable=SC2086 # two words
    exits 3 without_font render --scene cloth350k --duration 1000 $with_letters --out no.png
    warns 'DejaVuSans.ttf: install .*fonts-dejavu-core$'
  done
  [ ! -e no.png ] || fail "a picture is left without the font"
  exits 0 without_font render t.h5 --size 200x150 --out bare.png
  cmp -s t.png bare.png || fail "a picture without letters needs the font"
else
  echo "not tried: no font ($(cat err))"
fi

# A garment that has not settled is drawn, too.
ends 1 render --scene jeans1k --size 160x120 --duration 0.02 --out jeans.png
expect_picture jeans.png 160x120
mkdir scene && cd scene
ends 0 render --scene box-small --size 160x120 --duration 0.01
expect_picture box-small.png 160x120
[ "$(ls)" = box-small.png ] || fail "more than the picture is left: $(ls)"
cd ..

expect 2 'either a trace or --scene' render
expect 2 'no such file' render nope.h5
expect 2 'exclude each other' render t.h5 --scene cloth2500
expect 2 '"top" is not a view; give front' render t.h5 --view top
expect 2 'up to 2048 pixels' render t.h5 --size 3000x10
expect 2 'no frame 99; the last one is 4' render t.h5 --frames 0,99
expect 2 '--frames names 3 frames.*--sheet or --movie' render t.h5 --frames 0-2
# Known before anything is simulated.
expect 2 '--time: 1001 s is after the end of the run, at 1000 s; give a longer --duration or an earlier --time' \
  render --scene cloth350k --duration 1000 --time 1001 --out no.png
expect 2 '--time: 1 s is after the last frame, at 0.2 s; give an earlier one' render t.h5 --time 1 --out no.png
expect 2 '--fps .*--movie' render t.h5 --fps 5
expect 2 '"3" is not a number of pictures' render t.h5 --sheet 3
expect 2 'exclude each other' render t.h5 --movie --sheet 2x2
cp t.h5 same.png
expect 2 'the same file' render same.png --out ./same.png
expect 2 '--out is t.jpg, .*PNG: give t.png' render t.h5 --out t.jpg
expect 2 '--out is t.xdmf, .*PNG: give t.png' render t.h5 --out t.xdmf
expect 4 'cannot write' render t.h5 --out no/folder/t.png
cp "$2/scenes/cloth2500.json" mine.json
cp mine.json mine.png.json
expect 2 '--out is mine.json, .*PNG: give mine.png' render --scene mine.json --out mine.json
cp mine.json mine.png.part
expect 2 'the temporary file of --out and a file of the scene are the same file' render --scene ./mine.png.part --out mine.png
cmp -s mine.json mine.png.part || fail "render has replaced the scene that it reads"
expect 4 'cannot write no/folder/t.png' render --scene cloth350k --duration 1000 --out no/folder/t.png
# Links are followed, also where they lead to what is not there yet; where the system is, nothing is replaced.
mkdir linked
ln -s ../drawn.png linked/link.png
ends 0 render t.h5 --size 80x60 --out linked/link.png
[ -L linked/link.png ] && cmp drawn.png linked/link.png || fail "a link was replaced: $(ls -l linked)"
for place in /dev/stdout /dev/fd/1 /proc/self/fd/1; do expect 4 "cannot write $place: .*choose another file name" render t.h5 --out "$place"; done
cmp -s "$2/scenes/cloth2500.json" mine.json || fail "the scene is written over"
expect 2 'a movie has 0.1 to 1000' render t.h5 --movie --fps 5000
for given in '--backend serial' '--ranks 2' '--launcher srun' '--device 0' '--memory copy' '--roots exact' '--instruction-set avx2'; do
  # shellcheck disable=SC2086 # an option and its value
  expect 2 "${given% *}.*--scene" render t.h5 $given
done
expect 2 'no scene is named' render --scene clth2500
head -c 5000 t.h5 >cut.h5
expect 2 'cut.h5' render cut.h5
