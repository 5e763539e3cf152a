#!/bin/bash
# The suite of peers, with those of them that need no Python: C++, compiled here. Arguments: mssim, the source folder, and
# perhaps an emulator.
set -euo pipefail
. "$2/tests/support/command_line.sh"
peers=$source/scripts/lib/peers
export XDG_CONFIG_HOME=$work/config  # no descriptions of the user's

# Without descriptions there is nothing to hold mssim against; the message says where some are.
expect 2 '^mssim: --suite peers compares backends that are described.*scripts/peers' bench --suite peers --dry-run

# mssim reads all descriptions, and all of them are in the suite.
ends 0 bench --suite peers --backend-folder "$peers" --dry-run
described=$(find "$peers" -name '*.json' | wc -l)
[ "$described" -eq 10 ] || fail "there are $described descriptions"
[ "$(grep -c "^bodies38233 .* $((described + 2)) " "$work/out")" -eq 1 ] || fail "not all are in the suite: $(cat "$work/out")"

# Far from the programs that they name, they say who makes them.
mkdir unbuilt
cp "$peers"/*.json unbuilt
ends 0 list backends --backend-folder unbuilt --format csv
[ "$(grep -c 'there is no file.*scripts/peers' "$work/out")" -eq "$described" ] || fail "not all say how to get them: $(cat "$work/out")"

[ $# -lt 3 ] || exit 77 # the peer would be of the machine that emulates
pkg-config --exists hdf5 && command -v c++ >/dev/null || exit 77
root=$source
. "$source/scripts/lib/peers.sh"
for peer in cpp-list cpp-gather; do
  compile_peer $peer "$work/$peer"
  printf '{"command": ["./%s"]}' $peer >"$work/$peer.json"
done

ends 0 bench --suite peers --backend-folder "$work" --rounds 1 --threads 2 --out "$work/peers"
[ "$(grep -c ',openmp,' "$work/peers/peers.csv")" -eq 4 ] || fail "peers.csv: $(cat "$work/peers/peers.csv")"
[ "$(grep -c ',cpp-list,1,.*,true,ok,.*spring list; [0-9]* lines' "$work/peers/peers.csv")" -eq 4 ] ||
  fail "the list is not verified: $(cat "$work/peers/peers.csv")"
# A reader of its row is told of the flag.
[ "$(grep -c ',cpp-gather,2,.*,true,ok,.*-ffast-math.*; [0-9]* lines' "$work/peers/peers.csv")" -eq 3 ] ||
  fail "the gather is not verified on the cloths: $(cat "$work/peers/peers.csv")"
# serial, openmp and the list on four scenes, the gather on the cloths.
[ "$(column_of "$work/peers/peers.csv" times_openmp | awk '$1 > 0' | wc -l)" -eq 15 ] || fail "no ratios: $(cat "$work/peers/peers.csv")"
grep -q '^| .cpp-list. | 1 |' "$work/peers/peers.md" || fail "peers.md: $(cat "$work/peers/peers.md")"
