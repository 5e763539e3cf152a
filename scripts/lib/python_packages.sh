# shellcheck shell=bash disable=SC2154 # root is prepare.sh's
# Python packages of pinned versions in build folders. Sourced after prepare.sh.

# ensure_python NAME WHAT: build/NAME with the packages of scripts/NAME.txt, from PyPI, or says why not and exits. WHAT: what they are.
ensure_python() {
  local folder=$root/build/$1 list=$root/scripts/$1.txt log=$root/build/$1.log
  ensure_packages "$1"
  ! cmp -s "$list" "$folder/$1.txt" || return 0
  say "installing $2 (log: $log)"
  rm -rf "$folder"
  make_folder "$root/build"
  if /usr/bin/python3 -m venv "$folder" && "$folder/bin/pip" install --only-binary :all: --no-compile -r "$list"; then
    cp "$list" "$folder"
  else
    rm -rf "$folder"
    false
  fi </dev/null >"$log" 2>&1 || {
    missing "the Python packages of scripts/$1.txt could not be installed; with network access, run again"
  }
}
