#!/bin/bash
# What scripts/package makes of a build runs from anywhere without this machine's libraries in PATH or environment, with a TetGen of its
# own; it has the same bytes when made twice; a wheel installs; a Debian package says what it needs. Arguments: the built mssim, the source
# folder, and what runs a program that was built.
set -euo pipefail
. "$2/tests/support/command_line.sh"
(($# < 3)) || skip "needs programs that run by themselves"
for program in patchelf dpkg-shlibdeps tetgen; do
  command -v "$program" >/dev/null || skip "needs $program"
done
[[ -e /usr/share/doc/libaec-dev ]] || skip "needs libaec-dev"
build=$(dirname "$(dirname "$mssim")") package=$source/scripts/package

# makes_nothing CODE PATTERN ARGUMENT...
makes_nothing() {
  warning "$2" exits "$1" "$package" "${@:3}" --out "$work/never"
  [[ ! -e $work/never ]] || fail "${*:3}: made $(ls "$work/never")"
}
makes_nothing 2 'name what to make'
makes_nothing 2 'rpm' rpm
makes_nothing 2 'wheel' archive wheel
makes_nothing 2 'with --check' archive 12
makes_nothing 2 '--arm64 goes with archive, wheel or --check' deb --arm64
makes_nothing 2 "$work.* has no bin/mssim" archive --build "$work"
mkdir "$work/tree"
cp -r "$source/scripts" "$work/tree"
package=$work/tree/scripts/package makes_nothing 3 'no commit; set SOURCE_DATE_EPOCH' archive --build "$build"

# A release is of a commit, of its own build, with its version in CITATION.cff and CHANGELOG.md. Another program says such a version here.
tree=$work/tree
cp "$source/CITATION.cff" "$source/CHANGELOG.md" "$source/.gitignore" "$tree"
git_there() { git -C "$tree" -c user.name=test -c user.email=test@example.org "$@" >/dev/null; }
releases() { package=$tree/scripts/package DEBEMAIL=test@example.org makes_nothing 3 "$1" release --build "${2-$work/other}"; }
mkdir -p "$work/other/bin"
make_program "$work/other/bin/mssim" <<<"echo \"mssim 9.8.7 (\$(git -C '$tree' rev-parse HEAD))\""
releases 'this tree has no commit' "$build"
git_there init --quiet && git_there add . && git_there commit --quiet -m test
releases "$build was built from .*, not from this commit" "$build"
releases 'CITATION.cff does not have version 9.8.7'
echo 'version: 9.8.7' >>"$tree/CITATION.cff"
releases 'not committed'
git_there commit --quiet -a -m version
releases 'CHANGELOG.md has no section \[9.8.7\]'

for kind in archive wheel deb recipes; do
  for folder in first second; do exits 0 "$package" "$kind" --build "$build" --out "$work/$folder"; done
done
diff -r "$work/first" "$work/second" || fail 'packages made twice differ'
cd "$work/first"

# A driver may run a linker.
mkdir "$work/programs"
ln -s /usr/bin/* "$work/programs"
rm -f "$work/programs/tetgen"
# runs PROGRAM: it measures a cloth and a body, without a TetGen in PATH.
runs() {
  local program=$1 folder=$work/results
  rm -rf "$folder"
  exits 0 env -i PATH="$work/programs" HOME="$work" POCL_CACHE_DIR="$build/pocl" XDG_CACHE_HOME="$work/cache" \
    "$program" bench --scene cloth2500,torus-small --backend "$backends" --integrator semi-euler --rounds 2 --out "$folder"
  [[ $(grep -c ',true,ok' "$folder/timings.csv") == $((2 * $(tr ',' '\n' <<<"$backends" | wc -l))) ]] ||
    fail "$program: not all are verified: $(cat "$work/out")"
}
backends=serial,openmp
! grep -qs pocl /etc/OpenCL/vendors/*.icd || backends+=,opencl

mkdir "$work/a place"
tar -C "$work/a place" -xzf mssim-*-linux-*.tar.gz
tree=$(echo "$work/a place"/mssim-*)
runs "$tree/bin/mssim"
# Every library but the C library's is its own, or, of those that drivers share, the system's.
ldd "$tree/bin/mssim" "$tree"/libexec/mssim/* | awk '$2 == "=>" { print $1, $3, $4 }' | sort -u >"$work/libraries"
strange=$(grep -vF "$tree/" "$work/libraries" | grep -vE '^lib(c|m|stdc\+\+|gcc_s|pthread|dl|rt|resolv)\.so' || true)
[[ ! $strange ]] || fail "not its own: $strange"
grep -qF "$tree/" "$work/libraries" || fail 'it has no libraries of its own'
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
if /usr/bin/python3 -m venv "$work/venv" >/dev/null 2>&1; then
  exits 0 "$work/venv/bin/pip" install --no-index --quiet mssim-*.whl
  runs "$work/venv/bin/mssim"
  "$work/venv/bin/python" -c 'import importlib.util as u, mssim; assert u.find_spec("mssim_backend") and mssim.program.exists()' ||
    fail 'the modules of the wheel'
  for page in man/man1/mssim.1 bash-completion/completions/mssim fish/vendor_completions.d/mssim.fish zsh/site-functions/_mssim; do
    [[ -s $work/venv/share/$page ]] || fail "the wheel has no share/$page where it is looked for"
  done
  "$work/venv/bin/pip" uninstall --yes --quiet mssim
  [[ -z $(find "$work/venv" -name '*mssim*') ]] || fail "left behind: $(find "$work/venv" -name '*mssim*')"
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
dpkg-deb --contents "$deb" >"$work/out"
for file in bin/mssim share/mssim/scenes/cloth2500.json share/doc/mssim/copyright libexec/mssim/supervise; do
  grep -q "root/root .* ./usr/$file$" "$work/out" || fail "there is no $file"
done
! grep -q 'mssim-mpi$' "$work/out" || fail 'mssim-mpi is in the first package'
if [[ -x $build/libexec/mssim/mssim-mpi ]]; then
  mpi=$(echo mssim-mpi_*.deb)
  [[ $(of Depends "$mpi") == *"mssim (= $(of Version))"*openmpi-bin* ]] || fail "mssim-mpi depends on $(of Depends "$mpi")"
fi
if command -v lintian >/dev/null; then
  exits 0 lintian --fail-on error ./*.deb
fi
for recipe in Dockerfile mssim.def; do grep -qF "/tmp/$deb" "$recipe" || fail "$recipe does not install the package"; done
diff <(sed -n 's/^RUN //p' Dockerfile) <(sed -n '/^%post$/,/^%/s/^ *apt/apt/p' mssim.def) || fail "the recipes differ"
