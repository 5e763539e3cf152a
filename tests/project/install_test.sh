#!/bin/bash
# An installed mssim runs from anywhere. Arguments: the built mssim, the source folder, and what runs a program that was
# built (nothing where it runs by itself).
set -euo pipefail
. "$2/tests/support/command_line.sh"
run=("${@:3}")
build=$(dirname "$(dirname "$mssim")")

cmake --install "$build" --prefix "$work/first" >/dev/null
# Moved, so that a path fixed at build time or at installation does not go unnoticed.
mv "$work/first" "$work/second"
cd /

diff <("${run[@]}" "$work/second/bin/mssim" --version) <("$1" --version)
"${run[@]}" "$work/second/bin/mssim" list scenes --format csv >"$work/scenes"
diff "$work/scenes" <("$1" list scenes --format csv)
# It finds the program by which it asks for devices; the kernel cannot run that where it needs an emulator.
[[ ${#run[@]} -gt 0 ]] || diff <("$work/second/bin/mssim" list devices) <("$1" list devices)
[[ $(wc -l <"$work/scenes") -gt 6 ]]
# What backends of one's own start from, and are compiled and run with.
"${run[@]}" "$work/second/bin/mssim" new-backend mine --language c++ --out "$work" >"$work/commands" 2>&1
cmp "$work/mssim_backend.h" "$work/second/include/mssim_backend.h"
cmp "$work/second/share/mssim/python/mssim_backend.py" "$2/src/starters/python/mssim_backend.py"
cmp "$work/second/share/mssim/schemas/bench.schema.json" <("$1" list bench-schema)
# What shells and man look for.
share=$work/second/share
cmp "$share/man/man1/mssim.1" <("$1" help --manual)
cmp "$share/bash-completion/completions/mssim" "$2/src/completion/mssim.bash"
cmp "$share/zsh/site-functions/_mssim" "$2/src/completion/_mssim"
cmp "$share/fish/vendor_completions.d/mssim.fish" "$2/src/completion/mssim.fish"
[[ -z $(find "$work/second" -xtype l) ]]
