#!/bin/bash
# What scripts/package makes of a build runs from anywhere without this machine's libraries in PATH or environment, with a TetGen of its
# own; it has the same bytes when made twice; a wheel installs; a Debian package says what it needs. Arguments: the built mssim, the source
# folder, and what runs a program that was built.
set -euo pipefail
(($# < 3)) || { echo "skipped: needs programs that run by themselves" && exit 77; }
for program in patchelf dpkg-shlibdeps tetgen; do
  command -v "$program" >/dev/null || { echo "skipped: needs $program" && exit 77; }
done
[[ -e /usr/share/doc/libaec-dev ]] || { echo "skipped: needs libaec-dev" && exit 77; }
build=$(dirname "$(dirname "$1")")

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
fail() { echo "$1" && cat "$place/err" && exit 1; } >&2
package=$2/scripts/package
# make WHAT FOLDER
make() { "$package" "$1" --build "$build" --out "$place/$2" 2>"$place/err" || fail "scripts/package $1: exit code $?"; }
# refuses CODE PATTERN ARGUMENT...
refuses() {
  local expected=$1 pattern=$2 code=0
  shift 2
  "$package" "$@" --out "$place/never" >"$place/out" 2>"$place/err" || code=$?
  [[ $code == "$expected" ]] || fail "$*: exit code $code instead of $expected"
  grep -q -- "$pattern" "$place/err" || fail "$*: stderr does not say \"$pattern\""
  [[ ! -e $place/never ]] || fail "$*: made $(ls "$place/never")"
}
refuses 2 'name what to make'
refuses 2 'rpm' rpm
refuses 2 'wheel' archive wheel
refuses 2 'with --check' archive 12
refuses 2 '--arm64 goes with archive, wheel or --check' deb --arm64
refuses 2 "$place.* has no bin/mssim" archive --build "$place"
mkdir "$place/tree"
cp -r "$2/scripts" "$place/tree"
package=$place/tree/scripts/package refuses 3 'no commit; set SOURCE_DATE_EPOCH' archive --build "$build"

# A release is of a commit, of its own build, with its version in CITATION.cff and CHANGELOG.md. Another program says such a version here.
tree=$place/tree
cp "$2/CITATION.cff" "$2/CHANGELOG.md" "$2/.gitignore" "$tree"
git_there() { git -C "$tree" -c user.name=test -c user.email=test@example.org "$@" >/dev/null; }
releases() { package=$tree/scripts/package DEBEMAIL=test@example.org refuses 3 "$1" release --build "${2-$place/other}"; }
mkdir -p "$place/other/bin"
# shellcheck disable=SC2016 # that shell expands it
printf '#!/bin/sh\necho "mssim 9.8.7 ($(git -C %q rev-parse HEAD))"\n' "$tree" >"$place/other/bin/mssim"
chmod +x "$place/other/bin/mssim"
releases 'this tree has no commit' "$build"
git_there init --quiet && git_there add . && git_there commit --quiet -m test
releases "$build was built from .*, not from this commit" "$build"
releases 'CITATION.cff does not have version 9.8.7'
echo 'version: 9.8.7' >>"$tree/CITATION.cff"
releases 'not committed'
git_there commit --quiet -a -m version
releases 'CHANGELOG.md has no section \[9.8.7\]'

for kind in archive wheel deb recipes; do
  for folder in first second; do make "$kind" "$folder"; done
done
diff -r "$place/first" "$place/second" || fail 'packages made twice differ'
cd "$place/first"

# A driver may run a linker.
mkdir "$place/programs"
ln -s /usr/bin/* "$place/programs"
rm -f "$place/programs/tetgen"
# runs PROGRAM: it measures a cloth and a body, without a TetGen in PATH.
runs() {
  local program=$1 folder=$place/results
  rm -rf "$folder"
  env -i PATH="$place/programs" HOME="$place" POCL_CACHE_DIR="$build/pocl" XDG_CACHE_HOME="$place/cache" \
    "$program" bench --scene cloth2500,torus-small --backend "$backends" --integrator semi-euler --rounds 2 --out "$folder" \
    >"$place/out" 2>"$place/err" || fail "$program: exit code $?"
  [[ $(grep -c ',true,ok' "$folder/timings.csv") == $((2 * $(tr ',' '\n' <<<"$backends" | wc -l))) ]] ||
    fail "$program: not all are verified: $(cat "$place/out")"
}
backends=serial,openmp
! grep -qs pocl /etc/OpenCL/vendors/*.icd || backends+=,opencl

mkdir "$place/a place"
tar -C "$place/a place" -xzf mssim-*-linux-*.tar.gz
tree=$(echo "$place/a place"/mssim-*)
runs "$tree/bin/mssim"
# Every library but the C library's is its own, or, of those that drivers share, the system's.
ldd "$tree/bin/mssim" "$tree"/libexec/mssim/* | awk '$2 == "=>" { print $1, $3, $4 }' | sort -u >"$place/libraries"
strange=$(grep -vF "$tree/" "$place/libraries" | grep -vE '^lib(c|m|stdc\+\+|gcc_s|pthread|dl|rt|resolv)\.so' || true)
[[ ! $strange ]] || fail "not its own: $strange"
grep -qF "$tree/" "$place/libraries" || fail 'it has no libraries of its own'
[[ -e $tree/share/doc/mssim/licences/tetgen && -s $tree/share/doc/mssim/licences/libhdf5-dev ]] || fail 'licences are missing'
[[ -z $(find "$tree" -xtype l) ]] || fail 'links lead nowhere'
/usr/bin/python3 - "$tree/share/doc/mssim/mssim.spdx.json" <<'PYTHON' || fail 'the list of what is inside'
import json, sys
listed = json.load(open(sys.argv[1]))
names = {package["SPDXID"]: package for package in listed["packages"]}
assert len(names) == len(listed["packages"]) and {"tetgen", "libgomp1"} <= {package["name"] for package in names.values()}
assert all(relation["relatedSpdxElement"] in names for relation in listed["relationships"])
assert len(listed["relationships"]) == len(names)
assert all(package["versionInfo"] for package in names.values())
PYTHON

# A wheel, where Debian's Python can make an environment.
if /usr/bin/python3 -m venv "$place/venv" >/dev/null 2>&1; then
  "$place/venv/bin/pip" install --no-index --quiet mssim-*.whl >"$place/out" 2>"$place/err" || fail "pip: $(cat "$place/out")"
  runs "$place/venv/bin/mssim"
  "$place/venv/bin/python" -c 'import importlib.util as u, mssim; assert u.find_spec("mssim_backend") and mssim.program.exists()' ||
    fail 'the modules of the wheel'
  for page in man/man1/mssim.1 bash-completion/completions/mssim fish/vendor_completions.d/mssim.fish zsh/site-functions/_mssim; do
    [[ -s $place/venv/share/$page ]] || fail "the wheel has no share/$page where it is looked for"
  done
  "$place/venv/bin/pip" uninstall --yes --quiet mssim
  [[ -z $(find "$place/venv" -name '*mssim*') ]] || fail "left behind: $(find "$place/venv" -name '*mssim*')"
fi

deb=$(echo mssim_*.deb)
# of FIELD [PACKAGE]
of() { dpkg-deb --field "${2-$deb}" "$1"; }
[[ "$(of Package)_$(of Version)_$(of Architecture).deb" == "$deb" ]] || fail "$deb is named like another"
for name in libc6 tetgen 'pocl-opencl-icd | opencl-icd'; do
  [[ ", $(of Depends)" == *", $name"* ]] || fail "it does not depend on $name: $(of Depends)"
done
# Names of libraries of one release of Debian only.
[[ $(of Depends) != *libfmt* && $(of Depends) != *libhdf5* ]] || fail "it depends on one release: $(of Depends)"
dpkg-deb --contents "$deb" >"$place/out"
for file in bin/mssim share/mssim/scenes/cloth2500.json share/doc/mssim/copyright libexec/mssim/supervise; do
  grep -q "root/root .* ./usr/$file$" "$place/out" || fail "there is no $file"
done
! grep -q 'mssim-mpi$' "$place/out" || fail 'mssim-mpi is in the first package'
if [[ -x $build/libexec/mssim/mssim-mpi ]]; then
  mpi=$(echo mssim-mpi_*.deb)
  [[ $(of Depends "$mpi") == *"mssim (= $(of Version))"*openmpi-bin* ]] || fail "mssim-mpi depends on $(of Depends "$mpi")"
fi
if command -v lintian >/dev/null; then
  lintian --fail-on error ./*.deb >"$place/err" 2>&1 || fail 'lintian finds errors'
fi
for recipe in Dockerfile mssim.def; do grep -qF "/tmp/$deb" "$recipe" || fail "$recipe does not install the package"; done
diff <(sed -n 's/^RUN //p' Dockerfile) <(sed -n '/^%post$/,/^%/s/^ *apt/apt/p' mssim.def) || fail "the recipes differ"
