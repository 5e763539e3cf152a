#!/bin/bash
# What scripts/ci-regression builds and runs, with stand-ins for the build, in a repository of its own.
# Arguments: mssim (unused), the source folder.
# shellcheck disable=SC2016 # the stand-ins expand what stands in single quotes
set -euo pipefail
. "$2/tests/support/command_line.sh"

mkdir repository tools
cp -r "$source/scripts" "$source/CMakePresets.json" "$source/.gitignore" repository
repository=$(cd repository && pwd -P)
export PATH=$work/tools:$PATH PLACE=$work
make_program tools/dpkg-query <<<'printf "installed %s\n" "${@:4}"'
make_program tools/cmake <<<'mkdir -p build/release && touch build/release/build.ninja && echo "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" >build/release/CMakeCache.txt'
# The program that it "builds" shows what the source said at that time, and how it is called.
make_program tools/ninja <<'END'
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

# runs CODE ARGUMENTS...
runs() {
  : >"$work/notes"
  exits "$1" "$repository/scripts/ci-regression" "${@:2}"
}

warning 'name the revision' runs 2
runs 2 --scene cloth2500
warning 'there is no revision no-such-revision' runs 2 no-such-revision
[[ ! -s notes ]] || fail 'nothing is built for a revision that is not known'

base=$repository/build/ci-regression/$old/build/release/bin
runs 1 HEAD~1 --threads 2
[[ $(cat out) == "compare
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
[[ $(sed -n 5p out) == --scene=box-small ]] || fail 'a scene that is named replaces the default'
[[ $(sort notes) == "built build/ci-regression/$old/build/release
built build/release" ]] || fail 'the worktree of a revision is used again'
rm -rf "$repository/build/ci-regression"
runs 1 "$old"
[[ $(cat "$base/source") == old ]] || fail 'a worktree that was removed is made again'

# A program of the user's is compared in the folder that this is run from, which the base may lack.
mkdir "$repository/later"
cd "$repository/later"
warning 'HEAD~1 has no folder later/' runs 2 HEAD~1 --mssim "$work/tools/ninja"

# Two comparisons in one repository start their own programs.
starters=()
cd "$repository/scripts"
for name in first second; do
  make_program "$work/tools/$name" <<<'printf "%s\n" "${0##*/}" "$PWD" "$@"; exit 1'
  runs 1 HEAD~1 --mssim="$work/tools/$name" --build=true --backend ./mine
  starters+=("$(sed -n 5p "$work/out")" "$(sed -n 6p "$work/out")")
done
exits 1 "${starters[0]}" measured
[[ $(cat "$work/out") == "first
$repository/build/ci-regression/$old/scripts
measured" ]] || fail 'the second comparison changes what the first one starts for its base'
[[ $("${starters[3]}" || true) == "second
$repository/scripts" ]] || fail 'the program is started in the present tree'
