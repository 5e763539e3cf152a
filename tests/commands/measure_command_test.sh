#!/bin/bash
# mssim measure at the command line: what it finds, the scenes that it writes, and what it refuses.
set -euo pipefail
. "$2/tests/support/command_line.sh"
scenes=$source/scenes

# A person of closed tubes through ellipses: trunk with head, legs, feet and arms. "neck" leaves the top open, "waist" cuts
# the trunk off and leaves it open, "hip" cuts it off lower and closes it, and with "thighs" the thighs touch.
person() {
  /usr/bin/python3 - "$@" <<'PYTHON'
import math, sys
unit, axes, cut = float(sys.argv[1]), sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else ""
points, faces = [], []


def tube(sections, open_top=False):
    """Sections: height, x, z, half width, half depth."""
    n, first, last = 24, len(points) + 1, len(sections) - 1
    middle = first + len(sections) * n
    points.extend((x + a * math.cos(2 * math.pi * j / n), y, z + b * math.sin(2 * math.pi * j / n))
                  for y, x, z, a, b in sections for j in range(n))
    points.extend((x, y, z) for y, x, z, _, _ in (sections[0], sections[-1]))
    at = lambda ring, j: first + ring * n + j % n
    for j in range(n):
        faces.extend((at(ring, j), at(ring + 1, j), at(ring + 1, j + 1), at(ring, j + 1)) for ring in range(last))
        faces.append((middle, at(0, j), at(0, j + 1)))
        if not open_top:
            faces.append((middle + 1, at(last, j + 1), at(last, j)))


trunk = [(0.77, 0, -0.01, 0.09, 0.03), (0.79, 0, -0.01, 0.155, 0.075), (0.82, 0, -0.01, 0.172, 0.105),
         (0.86, 0, -0.01, 0.181, 0.130), (0.95, 0, 0, 0.160, 0.120), (1.04, 0, 0, 0.132, 0.103),
         (1.15, 0, 0, 0.144, 0.108), (1.28, 0, 0, 0.166, 0.119), (1.38, 0, 0, 0.150, 0.080),
         (1.44, 0, 0, 0.062, 0.060), (1.53, 0, 0, 0.062, 0.060), (1.60, 0, 0.01, 0.075, 0.095),
         (1.68, 0, 0.01, 0.060, 0.080)]
cuts = {"neck": 1.5, "waist": 1.1, "hip": 1}
tube([s for s in trunk if s[0] < cuts.get(cut, 2)], cut in ("neck", "waist"))
if cut == "thighs":
    tube([(0.62, 0, 0, 0.04, 0.05), (0.80, 0, 0, 0.04, 0.05)])
for side in (1, -1):
    leg = [(0.05, 0.125, 0, 0.037, 0.040), (0.09, 0.125, 0, 0.036, 0.040), (0.32, 0.113, -0.01, 0.054, 0.060),
           (0.46, 0.107, 0, 0.057, 0.061), (0.62, 0.099, 0, 0.076, 0.080), (0.76, 0.094, 0, 0.088, 0.090),
           (0.84, 0.080, 0, 0.060, 0.060)]
    tube([(y, side * x, z, a, b) for y, x, z, a, b in leg])
    tube([(0, side * 0.13, 0.05, 0.042, 0.11), (0.05, side * 0.13, 0.05, 0.040, 0.10), (0.07, side * 0.125, 0, 0.03, 0.04)])
    if not cut:
        tube([(0.72, side * 0.30, 0.02, 0.03, 0.05), (0.85, side * 0.275, 0.01, 0.03, 0.035),
              (1.10, side * 0.235, 0, 0.042, 0.045), (1.36, side * 0.16, 0, 0.045, 0.045)])
print("\ufeff# a person\nmtllib a.mtl\no body\nusemtl skin\ns 1\nTexture a b")
for p in points:
    print("v", *(f"{float(sign + '1') * p['xyz'.index(axis)] / unit:.6g}" for sign, axis in zip(axes[::2], axes[1::2])))
for face in faces:
    print("f", *face)
PYTHON
}
# of_listing FILE MEASURE: its value in a CSV listing
of_listing() { awk -F, -v name="$2" '$1 == name { print $2 }' "$1"; }
near() { awk -v a="$1" -v b="$2" -v d="$3" 'BEGIN { exit !(a - b <= d && b - a <= d) }'; }

# What is found, in another unit, with z up, facing -y; and in the formats.
person 1 +x+y+z >"$work/person.obj"
person 0.001 +x-z+y >"$work/scan.obj"
ends 0 measure "$work/scan.obj" --format csv
! grep -q 'not certain' "$work/err" || fail "a person is not certain: $(cat "$work/err")"
warns 'garments ignore all but trunk and legs'
[ "$(of_listing "$work/out" unit) $(of_listing "$work/out" up) $(of_listing "$work/out" facing)" = "0.001 z -y" ] ||
  fail "the stance of a scan: $(cat "$work/out")"
for measure in height:1.68:.001 waist_height:1.04:.02 waist_girth:.74:.02 hip_height:.86:.02 hip_girth:.98:.02 \
  crotch_height:.77:.01 knee_girth:.37:.02 ankle_girth:.24:.02; do
  IFS=: read -r name expected within <<<"$measure"
  near "$(of_listing "$work/out" "$name")" "$expected" "$within" || fail "$name: $(cat "$work/out")"
done
ends 0 measure "$work/scan.obj" --format json
/usr/bin/python3 -c 'import json, sys; rows = json.load(sys.stdin); assert any(r["measure"] == "hip_girth" and r["unit"] == "m" for r in rows)' \
  <"$work/out" || fail "the JSON of a body"
ends 0 measure jeans4k
says '^hip_girth  *0.98 '

person 0.1 +x+y+z >"$work/makehuman.obj"
ends 0 measure "$work/makehuman.obj" --format csv
[ "$(of_listing "$work/out" unit)" = 0.1 ] || fail "decimetres: $(cat "$work/out")"
! grep -q 'not certain' "$work/err" || fail "decimetres are not certain: $(cat "$work/err")"

# What is not found is said, and why.
person 1 +x+y+z hip >"$work/hip.obj"
ends 0 measure "$work/hip.obj" --unit m
says '^waist_height .*estimated by proportion$'
says '^waist_girth .*the body ends below that height$'
person 1 +x+y+z thighs >"$work/thighs.obj"
ends 0 measure "$work/thighs.obj" --format csv
near "$(of_listing "$work/out" crotch_height)" .62 .001 || fail "thighs that touch: $(cat "$work/out")"
warns 'not certain of crotch_height: it is 0.37 of the height, .* thighs apart'

# What is given beats what is found.
ends 0 measure "$work/scan.obj" --unit mm --up z --facing -y --format csv
[ "$(of_listing "$work/out" facing)" = -y ] || fail "a facing that is given"
for value in unit up facing; do grep -q "^$value,.*given" "$work/out" || fail "$value is not called given: $(cat "$work/out")"; done
ends 0 measure "$work/person.obj" --facing=-z --format csv
[ "$(of_listing "$work/out" facing)" = -z ] || fail "a facing that is given wrongly"
ends 0 measure "$work/person.obj" --unit 0.5 --format csv
[ "$(of_listing "$work/out" unit)" = 0.5 ] || fail "a unit in metres"
warns 'not certain of unit: the body is 0.84 m high'

# The scene that is written names the body from where it stands, is valid, and dresses it.
mkdir "$work/scenes"
warning "mssim run --scene '$work/scenes/my own.json' dresses it" ends 0 measure "$work/scan.obj" --scene "$work/scenes/my own.json"
warning "wrote $work/scenes/my.json; mssim run --scene" ends 0 measure "$work/scan.obj" --scene "$work/scenes/my.json"
grep -q '"file": "../scan.obj"' "$work/scenes/my.json" || fail "the path of the body: $(cat "$work/scenes/my.json")"
/usr/bin/python3 -c 'import json, jsonschema, sys
jsonschema.Draft7Validator(json.load(open(sys.argv[1]))).validate(json.load(open(sys.argv[2])))' \
  "$scenes/scene.schema.json" "$work/scenes/my.json" || fail "the scene is not valid by the schema"
(cd "$work/scenes" && exec timeout 120 "$mssim" run --scene my.json >"$work/out" 2>"$work/err") ||
  fail "the body is not dressed: $? $(cat "$work/err" "$work/out")"

ln -s ../scan.obj "$work/scenes/today.obj"
ends 0 measure "$work/scenes/today.obj" --scene "$work/scenes/today.json"
grep -q '"file": "today.obj"' "$work/scenes/today.json" || fail "a link to a body: $(cat "$work/scenes/today.json")"

# Nothing is replaced unasked, and nothing is written where something is wrong.
echo mine >"$work/mine.json"
expect 2 'already exists: give another --scene, or --overwrite' measure "$work/scan.obj" --scene "$work/mine.json"
[ "$(cat "$work/mine.json")" = mine ] || fail "a scene was replaced unasked"
ends 0 measure "$work/scan.obj" --scene "$work/mine.json" --overwrite
grep -q surface_file "$work/mine.json" || fail "--overwrite does not replace"
expect 2 'give a file that ends in .json' measure "$work/scan.obj" --scene "$work/scan.obj" --overwrite
warning 'cannot write' ends 4 measure "$work/scan.obj" --scene "$work/none/my.json"
expect 2 'b.obj: there is no such file' measure "$work/b.obj"
expect 2 'no scene is named' measure jeans4
echo binary >"$work/t.h5"
for file in "$work/t.h5" "$work/scan.ply" "$work/scan"; do expect 2 "$file ends in neither .obj nor .stl: give .* \.json" measure "$file"; done
expect 2 'cloth2500 is a scene without a body to dress' measure cloth2500
expect 2 'leave out --unit' measure jeans4k --unit mm
expect 2 '--unit is "mile": give m, dm, cm, mm, inch, foot, or the metres' measure "$work/scan.obj" --unit mile
expect 2 'cannot look along z' measure "$work/scan.obj" --up z --facing +z
# The axes of a remedy are the file's, and the file is named once.
warning 'scan.obj cannot be measured: .*upright in z and faces +x: .*--up and --facing' ends 2 measure "$work/scan.obj" --facing +x
echo 'v 0 0 zero' >"$work/word.obj"
for name in none word; do
  ends 2 measure "$work/$name.obj"
  [ "$(grep -o "$name.obj" err | wc -l)" -eq 1 ] || fail "the file's name: $(cat err)"
done

# Openings: a neck is closed, a waist is not.
person 0.01 +x+y+z neck >"$work/neck.obj"
person 0.01 +x+y+z waist >"$work/waist.obj"
warning 'it has 1 opening: close it where the surface was made, or give --close-holes' ends 2 measure "$work/neck.obj" --scene "$work/neck.json"
says '^opening_1 .*24 edges around (.*, open'
[ ! -e "$work/neck.json" ] || fail "a scene of an open body is written"
ends 0 measure "$work/neck.obj" --close-holes --scene "$work/neck.json"
says '^opening_1 .*24 edges around (.*, closed'
grep -q '"close_holes_m": 0.2' "$work/neck.json" || fail "the scene does not close the hole: $(cat "$work/neck.json")"
ends 2 measure "$work/waist.obj" --close-holes --unit cm
warns 'the opening of 24 edges around (.* is 0.2[0-9]* m across, and at most 0.2 m are closed'

# Triangles of an STL file whose corners differ in their last digits join; farther apart they are no openings to close.
loose() {
  /usr/bin/python3 - "$1" "$2" <<'PYTHON'
import random, sys
random.seed(1)
points = []
print("solid person")
for words in map(str.split, open(sys.argv[1], encoding="utf-8-sig")):
    if words[:1] == ["v"]:
        points.append([float(x) for x in words[1:]])
    elif words[:1] == ["f"]:
        corners = [points[int(w) - 1] for w in words[1:]]
        for i in range(2, len(corners)):
            print("facet normal 0 0 0\nouter loop")
            for p in (corners[0], corners[i - 1], corners[i]):
                print("vertex " + " ".join(f"{x + random.uniform(-1, 1) * float(sys.argv[2]):.8f}" for x in p))
            print("endloop\nendfacet")
print("endsolid person")
PYTHON
}
loose "$work/person.obj" 1e-6 >"$work/loose.stl"
ends 0 measure "$work/person.obj" --format csv
cp "$work/out" "$work/whole"
warning 'loose.stl: [0-9]* points were merged with others' ends 0 measure "$work/loose.stl" --format csv --scene "$work/scenes/loose.json"
for measure in waist_girth hip_girth crotch_height knee_girth; do
  near "$(of_listing "$work/out" "$measure")" "$(of_listing "$work/whole" "$measure")" .0002 || fail "$measure of loose triangles: $(cat "$work/out")"
done
loose "$work/person.obj" 1e-4 >"$work/apart.stl"
for close in '' --close-holes; do
  # shellcheck disable=SC2086
  warning 'its triangles do not join: ' ends 2 measure "$work/apart.stl" $close
  ! grep -q 'close-holes' "$work/err" || fail "closing is recommended: $(cat "$work/err")"
done

# Scenes whose body is not as they say name the field.
# wrong NAME CHANGE PATTERN
wrong() {
  sed "$2" "$work/scenes/my.json" >"$work/scenes/$1.json"
  expect 2 "$3" run --scene "$work/scenes/$1.json"
}
wrong metres 's/"unit_m": 0.001/"unit_m": 1/' \
  '/garment/surface_file/unit_m is 1, which makes the body 16.* m high: give .*, 0.001 if the body is a person in mm'
wrong lying 's/"up": "z"/"up": "y"/' '/garment/surface_file/facing is "-y", the axis along which the body stands upright'
wrong sideways 's/"facing": "-y"/"facing": "+x"/' '/garment/surface_file has no leg on each side of x = 0'
wrong high 's/"waist_height_m": [0-9.]*/"waist_height_m": 1.7/' \
  '/garment/jeans/waist_height_m is 1.7, .* the body ends at the height 1.68 m.*: give a smaller height'
wrong low 's/"hem_height_m": [0-9.]*/"hem_height_m": 1/' "the knee's height, knee_height_m, "
wrong hip 's/"hip_height_m": [0-9.]*/"hip_height_m": 0.7/' "the hip's height, hip_height_m, "
sed 's/"file": [^,]*/"file": "..\/neck.obj"/; s/"unit_m": 0.001/"unit_m": 0.01/; s/"up": "z"/"up": "y"/; s/"facing": "-y"/"facing": "+z"/' \
  "$work/scenes/my.json" >"$work/scenes/open.json"
expect 2 'it has 1 opening of 24 edges around .* or give "close_holes_m"' run --scene "$work/scenes/open.json"
