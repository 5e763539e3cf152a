#!/bin/bash
# Every committed scene is valid by scenes/scene.schema.json, and damaged ones are not, as an independent validator
# (Debian's python3-jsonschema) sees it. Arguments: mssim (unused), the source folder.
set -euo pipefail
. "$2/tests/support/command_line.sh"

cd -- "$source/scenes"
valid=(/usr/bin/python3 -W ignore ../tests/support/check_json.py scene.schema.json)

mapfile -t scenes < <(find . -name '*.json' ! -name '*.schema.json')
exits 0 "${valid[@]}" "${scenes[@]}" --optional "\$schema,cloth,pins,turn,expected,waistband,seams,layers"

exits 0 "${valid[@]}" cloth2500.json --optional "\$schema,pins" \
  --right 'dt_s="auto"' cloth/pins "\$schema" cloth/springs/shear/stiffness_n_per_m=0 cloth/rows=5e1 floor/height_m=-1 \
  --wrong dt_s=0 dt_s=2 'dt_s="automatic"' dt_s=null 'kind="tent"' 'kind="bodies"' 'bodies={}' \
  'description="two\nlines"' "description=\"$(printf 'x%.0s' {1..201})\"" \
  gravity_m_per_s2=-9.81 'gravity_m_per_s2="9.81"' viscous_damping_per_s=-1 floor/restitution=1.5 floor/friction=-0.1 \
  cloth/rows={1,50.5,1000001} 'cloth/columns="50"' cloth/spacing_m=0 cloth/areal_density_kg_per_m2=0 'cloth/ceiling_height_m=[]' \
  'cloth/pins={}' cloth/pins/row=-1 cloth/pins/every_columns=0 cloth/ripple/wavelength_m=0 cloth/ripple/height_m=-1 \
  cloth/springs/structural/stiffness_n_per_m=0 cloth/springs/bending/damping_n_s_per_m=-1

body=bodies/list/0
exits 0 "${valid[@]}" box-small.json --optional "\$schema,turn,expected" \
  --right $body/turn $body/box/expected $body/swell_per_s=-1 $body/centre_m/1=-3 \
  --wrong bodies/density_kg_per_m3=0 bodies/springs/stiffness_n_per_m=0 'bodies/list=[]' 'bodies/list={}' $body=5 \
  $body/shape='"ball"' $body/shape='"sphere"' $body/sphere='{"radius_m": 1}' $body/box/size_m='[1, 2]' $body/box/size_m/1=0 \
  $body/box/cells_x=0.5 $body/box/interior/jitter=0.6 $body/box/expected/nodes=0 $body/centre_m='[0, 1, 2, 3]'
