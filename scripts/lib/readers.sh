# shellcheck shell=bash disable=SC2154 # root and exit_missing are prepare.sh's
# The Python that tests read traces with. Sourced after prepare.sh.

# ensure_readers: build/readers with the packages of scripts/readers.txt, from PyPI, or says why not and exits.
ensure_readers() {
  local folder=$root/build/readers list=$root/scripts/readers.txt log=$root/build/readers.log
  ensure_packages readers
  ! cmp -s "$list" "$folder/readers.txt" || return 0
  say "installing Python's readers of traces (log: $log)"
  rm -rf "$folder"
  if /usr/bin/python3 -m venv "$folder" && "$folder/bin/pip" install --only-binary :all: --no-compile -r "$list"; then
    cp "$list" "$folder"
  else
    rm -rf "$folder"
    false
  fi </dev/null >"$log" 2>&1 || {
    say "the Python packages of scripts/readers.txt could not be installed; with network access, run again"
    exit "$exit_missing"
  }
}
