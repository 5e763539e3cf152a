#!/bin/bash
# .ci/nightly runs what comes after a part that failed, and says at its end what failed; and only the parts of the words that it gets. With
# stand-ins for its scripts.
# Arguments: mssim (unused), the source folder.
set -euo pipefail

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
mkdir -p "$place/scripts"
cp -r "$2/.ci" "$place"
cp -r "$2/scripts/lib" "$place/scripts"
mapfile -t parts < <(grep -oE 'scripts/[a-z-]+( --[a-z0-9]+( [0-9]+)?)*$' "$2/.ci/nightly")
((${#parts[@]} >= 5)) || { echo "only ${#parts[@]} parts are known" && exit 1; }
for part in "${parts[@]}"; do
  # shellcheck disable=SC2016 # the stand-ins expand it
  printf '#!/bin/sh\necho "scripts/${0##*/}${1:+ $*}" >>"%s/ran"\n! grep -qxF "scripts/${0##*/}${1:+ $*}" "%s/broken"\n' \
    "$place" "$place" >"$place/${part%% *}"
  chmod +x "$place/${part%% *}"
done

# nightly CODE PARTS [WORD...]: expects that exit code, and these parts to be run, a line each.
nightly() {
  local code=0
  : >"$place/ran"
  "$place/.ci/nightly" "${@:3}" 2>"$place/err" || code=$?
  [[ $code == "$1" ]] || { echo "exit code $code instead of $1: $(cat "$place/err")" && exit 1; }
  diff "$place/ran" <(printf '%s' "$2") || { echo "other parts were run with \"${*:3}\"" && exit 1; }
}
all=$(printf '%s\n' "${parts[@]}")$'\n'

: >"$place/broken"
nightly 0 "$all"
printf '%s\n' "${parts[0]}" "${parts[2]}" >"$place/broken"
nightly 1 "$all"
[[ $(tail -n 1 "$place/err") == *"failed: ${parts[0]}, ${parts[2]}" ]] || { echo "the end: $(tail -n 1 "$place/err")" && exit 1; }

: >"$place/broken"
nightly 0 "$(grep -E 'fuzz|arm64' <<<"$all")"$'\n' fuzz arm64
nightly 2 '' nosuchpart
[[ $(<"$place/err") == *nosuchpart* ]] || { echo "an unknown word: $(<"$place/err")" && exit 1; }
