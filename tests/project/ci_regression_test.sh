#!/bin/bash
# What scripts/ci-regression builds and runs, with stand-ins for the build, in a repository of its own.
# Arguments: mssim (unused), the source folder.
# shellcheck disable=SC2016 # the stand-ins expand what stands in single quotes
set -euo pipefail

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
repository=$place/repository tools=$place/tools
mkdir -p "$repository" "$tools"
cp -r "$2/scripts" "$2/CMakePresets.json" "$2/.gitignore" "$repository"
repository=$(cd "$repository" && pwd -P)
export PATH=$tools:$PATH PLACE=$place
tool() { # NAME: a stand-in, with the script on stdin
  { echo '#!/bin/bash' && cat; } >"$tools/$1"
  chmod +x "$tools/$1"
}
tool dpkg-query <<<'printf "installed %s\n" "${@:4}"'
tool cmake <<<'mkdir -p build/release && touch build/release/build.ninja && echo "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" >build/release/CMakeCache.txt'
# The program that it "builds" shows what the source said at that time, and how it is called.
tool ninja <<'END'
echo "built ${2#"$PLACE"/repository/}" >>"$PLACE/notes"
mkdir -p "$2/bin"
printf '#!/bin/bash\nprintf "%%s\\n" "$@"\nexit 1\n' >"$2/bin/mssim"
chmod +x "$2/bin/mssim"
cp "$2/../../source" "$2/bin/source"
END
git=(git -C "$repository" -c user.name=t -c user.email=t@localhost)
"${git[@]}" init -q
echo old >"$repository/source"
"${git[@]}" add -A
"${git[@]}" commit -qm old
old=$("${git[@]}" rev-parse HEAD)
echo new >"$repository/source"
"${git[@]}" commit -qam new
echo changed >"$repository/source"

fail() { echo "$1"; printf 'stdout: %s\nstderr: %s\n' "$(cat "$place/out")" "$(cat "$place/err")"; exit 1; } >&2
# runs CODE ARGUMENTS...
runs() {
  local expected=$1 code=0
  shift
  : >"$place/notes"
  "$repository/scripts/ci-regression" "$@" >"$place/out" 2>"$place/err" || code=$?
  [[ $code == "$expected" ]] || fail "ci-regression $*: exit code $code instead of $expected"
}

runs 2
grep -q 'name the revision' "$place/err" || fail 'it says what is missing'
runs 2 --scene cloth2500
runs 2 no-such-revision
grep -q 'there is no revision no-such-revision' "$place/err" || fail 'it names the revision that it does not know'
[[ ! -s $place/notes ]] || fail 'nothing is built for a revision that is not known'

base=$repository/build/ci-regression/$old/build/release/bin
runs 1 HEAD~1 --threads 2
[[ $(cat "$place/out") == "compare
--ab
$base/mssim
$repository/build/release/bin/mssim
--scene
cloth40k
--threads
2" ]] || fail 'the two programs, the scene and the options are handed on, and the exit code comes back'
[[ $(cat "$base/source") == old ]] || fail 'the base is the revision'
[[ $(cat "$repository/build/release/bin/source") == changed ]] || fail 'the present one is the tree as it is'

runs 1 "$old" --scene=box-small
[[ $(sed -n 5p "$place/out") == --scene=box-small ]] || fail 'a scene that is named replaces the default'
[[ $(sort "$place/notes") == "built build/ci-regression/$old/build/release
built build/release" ]] || fail 'the worktree of a revision is used again'
rm -rf "$repository/build/ci-regression"
runs 1 "$old"
[[ $(cat "$base/source") == old ]] || fail 'a worktree that was removed is made again'

# A program of the user's is compared in the folder that this is run from, which the base may lack.
mkdir "$repository/later"
(cd "$repository/later" && runs 2 HEAD~1 --mssim "$tools/ninja")
grep -q 'HEAD~1 has no folder later/' "$place/err" || fail 'it says which folder is missing'

# Two comparisons in one repository start their own programs.
starters=()
for name in first second; do
  tool "$name" <<<'printf "%s\n" "${0##*/}" "$PWD" "$@"; exit 1'
  (cd "$repository/scripts" && runs 1 HEAD~1 --mssim="$tools/$name" --build=true --backend ./mine)
  starters+=("$(sed -n 5p "$place/out")" "$(sed -n 6p "$place/out")")
done
code=0
"${starters[0]}" measured >"$place/out" || code=$?
[[ $code == 1 && $(cat "$place/out") == "first
$repository/build/ci-regression/$old/scripts
measured" ]] || fail 'the second comparison changes what the first one starts for its base'
[[ $("${starters[3]}" || true) == "second
$repository/scripts" ]] || fail 'the program is started in the present tree'
