#!/bin/bash
# An installed mssim runs from anywhere. Arguments: the built mssim, the source folder.
set -euo pipefail
build=$(dirname "$(dirname "$1")")

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cmake --install "$build" --prefix "$place/first" >/dev/null
# Moved, so that a path fixed at build time or at installation does not go unnoticed.
mv "$place/first" "$place/second"
cd /

diff <("$place/second/bin/mssim" --version) <("$1" --version)
diff <("$place/second/bin/mssim" list scenes --format csv) <("$1" list scenes --format csv)
[[ $("$place/second/bin/mssim" list scenes --format csv | wc -l) -gt 6 ]]
[[ -z $(find "$place/second" -xtype l) ]]
