#!/bin/bash
# .ci/nightly runs what comes after a part that failed, and says at its end what failed: with stand-ins for its scripts.
# Arguments: mssim (unused), the source folder.
set -euo pipefail

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
mkdir -p "$place/scripts"
cp -r "$2/.ci" "$place"
cp -r "$2/scripts/lib" "$place/scripts"
mapfile -t parts < <(grep -oE 'scripts/[a-z-]+( --[a-z0-9]+( [0-9]+)?)?$' "$2/.ci/nightly")
((${#parts[@]} >= 5)) || { echo "only ${#parts[@]} parts are known" && exit 1; }
for part in "${parts[@]}"; do
  # shellcheck disable=SC2016 # the stand-ins expand it
  printf '#!/bin/sh\necho "scripts/${0##*/}${1:+ $*}" >>"%s/ran"\n! grep -qxF "scripts/${0##*/}${1:+ $*}" "%s/broken"\n' \
    "$place" "$place" >"$place/${part%% *}"
  chmod +x "$place/${part%% *}"
done

# nightly CODE: expects that exit code, and every part to be run.
nightly() {
  local code=0
  : >"$place/ran"
  "$place/.ci/nightly" 2>"$place/err" || code=$?
  [[ $code == "$1" ]] || { echo "exit code $code instead of $1: $(cat "$place/err")" && exit 1; }
  diff "$place/ran" <(printf '%s\n' "${parts[@]}") || { echo 'not every part was run' && exit 1; }
}

: >"$place/broken"
nightly 0
printf '%s\n' "${parts[0]}" "${parts[2]}" >"$place/broken"
nightly 1
[[ $(tail -n 1 "$place/err") == *"failed: ${parts[0]}, ${parts[2]}" ]] || { echo "the end: $(tail -n 1 "$place/err")" && exit 1; }
