#!/bin/bash
# Every committed scene is valid by scenes/scene.schema.json, and changed ones are not, as an independent validator
# (Debian's python3-jsonschema) sees it. Arguments: mssim (unused), the source folder.
set -euo pipefail
scenes=$2/scenes

# Debian's own interpreter, whatever else is first in PATH: its packages are the ones that get installed.
if ! /usr/bin/python3 -c 'import jsonschema' 2>/dev/null; then
  echo 'schema_test: /usr/bin/python3 has no module jsonschema: install the Debian package python3-jsonschema' >&2
  exit 1
fi

/usr/bin/python3 - "$scenes" <<'PYTHON'
import glob, json, os, sys
import jsonschema

folder = sys.argv[1]
schema = json.load(open(os.path.join(folder, "scene.schema.json")))
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)
failures = []

files = sorted(f for f in glob.glob(os.path.join(folder, "*.json")) if not f.endswith(".schema.json"))
if not files:
    failures.append(f"no scenes in {folder}")
for file in files:
    for error in validator.iter_errors(json.load(open(file))):
        failures.append(f"{file}: {error.json_path}: {error.message}")

REMOVED = object()


def changed(name, pointer, value):
    scene = json.load(open(os.path.join(folder, name + ".json")))
    *parents, key = [int(word) if word.isdigit() else word for word in pointer.split("/")[1:]]
    part = scene
    for parent in parents:
        part = part[parent]
    if value is REMOVED:
        del part[key]
    else:
        part[key] = value
    return scene


bad = {"cloth2500": [
    ("/dt_s", 0), ("/dt_s", 2), ("/dt_s", "automatic"), ("/dt_s", None), ("/dt_s", REMOVED),
    ("/kind", "tent"), ("/kind", REMOVED), ("/description", "two\nlines"), ("/description", "x" * 201),
    ("/gravity", 9.81), ("/gravity_m_per_s2", -9.81), ("/gravity_m_per_s2", "9.81"), ("/viscous_damping_per_s", -1),
    ("/floor", REMOVED), ("/floor/restitution", 1.5), ("/floor/friction", -0.1), ("/floor/height", 0),
    ("/cloth/rows", 1), ("/cloth/rows", 50.5), ("/cloth/rows", 1000001), ("/cloth/columns", "50"),
    ("/cloth/spacing_m", 0), ("/cloth/areal_density_kg_per_m2", 0), ("/cloth/ceiling_height_m", []),
    ("/cloth/pins", {}), ("/cloth/pins/row", -1), ("/cloth/pins/every_columns", 0), ("/cloth/pins/rows", 0),
    ("/cloth/ripple", REMOVED), ("/cloth/ripple/wavelength_m", 0), ("/cloth/ripple/height_m", -1),
    ("/cloth/springs/structural/stiffness_n_per_m", 0), ("/cloth/springs/shear", REMOVED),
    ("/cloth/springs/bending/damping_n_s_per_m", -1), ("/cloth/springs/bend", {}),
    ("/cloth", REMOVED), ("/kind", "bodies"), ("/bodies", {}),
], "box-small": [
    ("/bodies", REMOVED), ("/bodies/density_kg_per_m3", 0), ("/bodies/springs/stiffness_n_per_m", 0),
    ("/bodies/list", []), ("/bodies/list", {}), ("/bodies/list/0", 5), ("/bodies/list/0/shape", "ball"),
    ("/bodies/list/0/shape", "sphere"), ("/bodies/list/0/shape", REMOVED), ("/bodies/list/0/box", REMOVED),
    ("/bodies/list/0/sphere", {"radius_m": 1}), ("/bodies/list/0/box/size_m", [1, 2]),
    ("/bodies/list/0/box/size_m/1", 0), ("/bodies/list/0/box/cells_x", 0.5), ("/bodies/list/0/box/interior/jitter", 0.6),
    ("/bodies/list/0/box/expected/nodes", 0), ("/bodies/list/0/centre_m", [0, 1, 2, 3]),
    ("/bodies/list/0/turn/axis", REMOVED), ("/bodies/list/0/swell_per_s", REMOVED), ("/bodies/list/0/spin", 1),
]}
for name, changes in bad.items():
    for pointer, value in changes:
        if validator.is_valid(changed(name, pointer, value)):
            shown = "removed" if value is REMOVED else f"set to {json.dumps(value)}"
            failures.append(f"{name} with {pointer} {shown} is valid by the schema")

good_too = {"cloth2500": [
    ("/dt_s", "auto"), ("/cloth/pins", REMOVED), ("/$schema", REMOVED), ("/cloth/springs/shear/stiffness_n_per_m", 0),
    ("/cloth/rows", 5e1), ("/floor/height_m", -1),
], "box-small": [
    ("/bodies/list/0/turn", REMOVED), ("/bodies/list/0/box/expected", REMOVED), ("/bodies/list/0/swell_per_s", -1),
    ("/bodies/list/0/centre_m/1", -3),
]}
for name, changes in good_too.items():
    for pointer, value in changes:
        if not validator.is_valid(changed(name, pointer, value)):
            failures.append(f"{name} with {pointer} changed to {value!r} is not valid by the schema")

for failure in failures:
    print("schema_test:", failure, file=sys.stderr)
sys.exit(1 if failures else 0)
PYTHON
echo "schema_test: $(find "$scenes" -name '*.json' ! -name '*.schema.json' | wc -l) scenes are valid, changed ones are not"
