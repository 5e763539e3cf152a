#!/bin/bash
# What scripts/mssim does around mssim, with stand-ins for the package manager and the build, which only note how they
# were called. Arguments: mssim (unused), the source folder.
# shellcheck disable=SC2016 # the stand-ins expand what stands in single quotes
set -euo pipefail

place=$(mktemp -d)
trap 'chmod -R u+w "$place"; rm -rf "$place"' EXIT
repository="$place/a clone" tools="$place/tools" notes="$place/notes"
mkdir -p "$repository" "$tools" "$place/elsewhere"
cp -r "$2/scripts" "$2/CMakePresets.json" "$2/CMakeLists.txt" "$2/cmake" "$repository"
mkdir "$repository/src" "$repository/kernels"
ln -s "$repository/scripts/mssim" "$place/elsewhere/link"
repository=$(cd "$repository" && pwd -P)
export PATH="$tools:$PATH" MSSIM_TEST_NOTES=$notes MSSIM_TEST_PLACE=$place

tool() { # NAME: a stand-in, with the script on stdin
  { printf '#!/bin/bash\nset -eu\necho "${0##*/} $*" >>"$MSSIM_TEST_NOTES"\n' && cat; } >"$tools/$1"
  chmod +x "$tools/$1"
}
# Packages named in `absent` are not installed.
tool dpkg-query <<'END'
for package in "${@:4}"; do grep -qxF "$package" "$MSSIM_TEST_PLACE/absent" || echo "installed $package"; done
END
tool sudo <<<'exec "$@"'
tool apt-get <<<'[[ ! -e $MSSIM_TEST_PLACE/offline ]]'
tool cmake <<'END'
mkdir -p build/release
touch build/release/build.ninja
echo "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" >build/release/CMakeCache.txt
END
tool ninja <<'END'
[[ ! -e $MSSIM_TEST_PLACE/broken ]] || { printf '[1/2] Building CXX a\nFAILED: b\nb.cpp: error: nonsense\n'; exit 1; }
mkdir "$MSSIM_TEST_PLACE/building" # fails when another build is under way
sleep 0.1
rmdir "$MSSIM_TEST_PLACE/building"
mkdir -p "$2/bin"
printf '#!/bin/bash\nprintf "<%%s>" "$@"\npwd\nexit 7\n' >"$2/bin/mssim"
chmod +x "$2/bin/mssim"
END

fail() { echo "$1"; printf 'stdout: %s\nstderr: %s\n' "$(cat "$place/out")" "$(cat "$place/err")"; exit 1; } >&2
# runs CODE ARGUMENTS...: calls the wrapper from another folder, through a link, as the user in `as_user`, and expects that exit code.
as_user=()
runs() {
  local expected=$1 code=0
  shift
  : >"$notes"
  (cd "$place/elsewhere" && "${as_user[@]}" ./link "$@") >"$place/out" 2>"$place/err" || code=$?
  [[ $code == "$expected" ]] || fail "exit code $code instead of $expected"
}
noted() { grep -q -- "^$1" "$notes"; } # a stand-in was called so
told() { grep -qF -- "$1" "$place/err"; }

: >"$place/absent"
runs 7 bench --scene 'two words'
[[ $(cat "$place/out") == "<bench><--scene><two words>$(cd "$place/elsewhere" && pwd)" ]] ||
  fail 'arguments, working directory and stdout are mssim'\''s'
noted 'cmake --preset release' || fail 'the first call configures'
! noted apt-get || fail 'nothing is installed when nothing is missing'

runs 7
! noted cmake || fail 'a later call does not configure again'
noted ninja || fail 'a later call builds what changed'
[[ ! -s $place/err ]] || fail 'a wrapper with nothing to do is silent'

touch -d '1 minute' "$repository/CMakePresets.json"
runs 7
noted 'cmake --preset release' || fail 'a changed preset configures anew'
touch -d '1 hour ago' "$repository/CMakePresets.json"

touch -d 2000-01-01 "$repository/CMakePresets.json"
touch -d 2001-01-01 "$repository/build/release/build.ninja"
runs 7
[[ ! -e /var/lib/dpkg/status ]] || { noted 'cmake --preset release' && ! noted 'cmake .*--fresh'; } ||
  fail 'a build looks for packages that came after it, and keeps its cache'

mv "$repository" "$place/moved"
ln -sfn "$place/moved/scripts/mssim" "$place/elsewhere/link"
runs 7
noted 'cmake --preset release' || fail 'a build folder that came from elsewhere is configured anew'

touch "$place/broken"
runs 3
told 'b.cpp: error: nonsense' || fail 'a failed build shows why'
! told 'Building CXX a' || fail 'a failed build shows what failed and not the rest'
[[ ! -s $place/out ]] || fail 'stdout carries the results of mssim alone'
rm "$place/broken"

printf '%s\n' libhwy-dev shellcheck >"$place/absent"
runs 7
noted 'apt-get .*install -y --no-install-recommends libhwy-dev$' || fail 'the missing package is installed, and none that only the lint needs'

touch "$place/offline"
runs 3
told 'apt-get install -y --no-install-recommends libhwy-dev' || fail 'the command that helps is told'
! noted ninja || fail 'without its packages nothing is built'
[[ ! -s $place/out ]] || fail 'stdout carries the results of mssim alone'
: >"$place/absent"
runs 7

# Of two at the same time one builds after the other.
for i in 1 2; do { "$place/elsewhere/link" >"$place/out$i" || echo $? >"$place/code$i"; } & done 2>"$place/err"
wait
[[ $(cat "$place/code1" "$place/code2") == $'7\n7' ]] || fail 'two wrappers at the same time both succeed'

# Another user, to whom the folder does not belong.
chmod -R a-w "$place/moved"
chmod a+rx "$place"
chmod a+rw "$notes"
((EUID)) || as_user=(setpriv --reuid=65534 --regid=65534 --clear-groups)
runs 7 list
[[ $(cat "$place/out") == "<list>"* && ! -s $place/err ]] || fail 'a build that cannot be written is run as it is'
! noted ninja || fail 'nothing is built where nothing can be written'
touch -d '1 minute' "$place/moved/CMakeLists.txt"
runs 7
told "$place/moved/build/release cannot be written by this user: running what is built there, which is older" || fail 'an old build is named'
chmod u+w "$place/moved/build/release/bin"
rm "$place/moved/build/release/bin/mssim"
chmod u-w "$place/moved/build/release/bin"
runs 3
told "$place/moved/build/release cannot be written" || fail 'the folder that cannot be written is named'
told "cmake --preset release -S '$place/moved' -B ELSEWHERE" || fail 'the way to build elsewhere is told'
[[ $(wc -l <"$place/err") == 1 ]] || fail 'one message'

# Another user, who may not install.
printf '%s\n' libhwy-dev tetgen >"$place/absent"
tool sudo <<<'exit 1'
runs 3
told 'this user may not install packages' || fail 'who may not install is told so'
told 'apt-get install -y --no-install-recommends libhwy-dev tetgen' || fail 'what to ask for is told'
told 'runs without tetgen: cmake' || fail 'what mssim does without is told'
! noted apt-get || fail 'nothing is tried that is not allowed'
