#!/bin/bash
# .ci/nightly runs what comes after a part that failed, and says at its end what failed; and only the parts of the words that it gets. With
# stand-ins for its scripts.
# Arguments: mssim (unused), the source folder.
set -euo pipefail
. "$2/tests/support/command_line.sh"

mkdir scripts
cp -r "$source/.ci" .
cp -r "$source/scripts/lib" scripts
mapfile -t parts < <(grep -oE 'scripts/[a-z-]+( --[a-z0-9]+( [0-9]+)?)*$' .ci/nightly)
((${#parts[@]} >= 5)) || fail "only ${#parts[@]} parts are known"
for part in "${parts[@]}"; do
  make_program "${part%% *}" <<END
echo "scripts/\${0##*/}\${1:+ \$*}" >>"$work/ran"
! grep -qxF "scripts/\${0##*/}\${1:+ \$*}" "$work/broken"
END
done

# nightly CODE PARTS [WORD...]: expects that exit code, and these parts to be run, a line each.
nightly() {
  : >ran
  exits "$1" .ci/nightly "${@:3}"
  diff ran <(printf '%s' "$2") || fail "other parts were run with \"${*:3}\""
}
all=$(printf '%s\n' "${parts[@]}")$'\n'

: >broken
nightly 0 "$all"
printf '%s\n' "${parts[0]}" "${parts[2]}" >broken
nightly 1 "$all"
[[ $(tail -n 1 err) == *"failed: ${parts[0]}, ${parts[2]}" ]] || fail "the end: $(tail -n 1 err)"

: >broken
nightly 0 "$(grep -E 'fuzz|arm64' <<<"$all")"$'\n' fuzz arm64
warning nosuchpart nightly 2 '' nosuchpart
