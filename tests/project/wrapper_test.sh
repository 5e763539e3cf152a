#!/bin/bash
# What scripts/mssim does around mssim, with stand-ins for the package manager and the build, which only note how they
# were called. Arguments: mssim (unused), the source folder.
# shellcheck disable=SC2016 # the stand-ins expand what stands in single quotes
set -euo pipefail
. "$2/tests/support/command_line.sh"
trap 'finish $? chmod -R u+w "$work"' EXIT

mkdir 'a clone' tools elsewhere
cp -r "$source/scripts" "$source/CMakePresets.json" "$source/CMakeLists.txt" "$source/cmake" 'a clone'
mkdir 'a clone/src' 'a clone/kernels'
ln -s "$work/a clone/scripts/mssim" elsewhere/link
repository=$(cd 'a clone' && pwd -P)
export PATH="$work/tools:$PATH" MSSIM_TEST_PLACE=$work

tool() { # NAME: a stand-in, with the script on stdin
  { printf 'set -eu\necho "${0##*/} $*" >>"$MSSIM_TEST_PLACE/notes"\n' && cat; } | make_program "tools/$1"
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

# runs CODE ARGUMENTS...: calls the wrapper from another folder, through a link, as the user in `as_user`, and expects that exit code.
as_user=()
runs() {
  : >notes
  exits "$1" from_elsewhere "${@:2}"
}
from_elsewhere() { (cd elsewhere && "${as_user[@]}" ./link "$@"); }
noted() { grep -q -- "^$1" notes; } # a stand-in was called so

: >absent
runs 7 bench --scene 'two words'
[[ $(cat out) == "<bench><--scene><two words>$(cd elsewhere && pwd)" ]] ||
  fail 'arguments, working directory and stdout are mssim'\''s'
noted 'cmake --preset release' || fail 'the first call configures'
! noted apt-get || fail 'nothing is installed when nothing is missing'

runs 7
! noted cmake || fail 'a later call does not configure again'
noted ninja || fail 'a later call builds what changed'
[[ ! -s err ]] || fail 'a wrapper with nothing to do is silent'

touch -d '1 minute' "$repository/CMakePresets.json"
runs 7
noted 'cmake --preset release' || fail 'a changed preset configures anew'
touch -d '1 hour ago' "$repository/CMakePresets.json"

touch -d 2000-01-01 "$repository/CMakePresets.json"
touch -d 2001-01-01 "$repository/build/release/build.ninja"
runs 7
[[ ! -e /var/lib/dpkg/status ]] || { noted 'cmake --preset release' && ! noted 'cmake .*--fresh'; } ||
  fail 'a build looks for packages that came after it, and keeps its cache'

mv "$repository" "$work/moved"
ln -sfn "$work/moved/scripts/mssim" elsewhere/link
runs 7
noted 'cmake --preset release' || fail 'a build folder that came from elsewhere is configured anew'

touch broken
runs 3
warns 'b.cpp: error: nonsense'
! grep -q 'Building CXX a' err || fail 'a failed build shows what failed and not the rest'
[[ ! -s out ]] || fail 'stdout carries the results of mssim alone'
rm broken

printf '%s\n' libhwy-dev shellcheck >absent
runs 7
noted 'apt-get .*install -y --no-install-recommends libhwy-dev$' || fail 'the missing package is installed, and none that only the lint needs'

touch offline
runs 3
warns 'apt-get install -y --no-install-recommends libhwy-dev'
! noted ninja || fail 'without its packages nothing is built'
[[ ! -s out ]] || fail 'stdout carries the results of mssim alone'
: >absent
runs 7

# Of two at the same time one builds after the other.
for i in 1 2; do { elsewhere/link >out$i || echo $? >code$i; } & done 2>err
wait
[[ $(cat code1 code2) == $'7\n7' ]] || fail 'two wrappers at the same time both succeed'

# Another user, to whom the folder does not belong.
chmod -R a-w "$work/moved"
chmod a+rx "$work"
chmod a+rw notes
((EUID)) || as_user=(setpriv --reuid=65534 --regid=65534 --clear-groups)
runs 7 list
[[ $(cat out) == "<list>"* && ! -s err ]] || fail 'a build that cannot be written is run as it is'
! noted ninja || fail 'nothing is built where nothing can be written'
touch -d '1 minute' "$work/moved/CMakeLists.txt"
runs 7
warns "$work/moved/build/release cannot be written by this user: running what is built there, which is older"
chmod u+w "$work/moved/build/release/bin"
rm "$work/moved/build/release/bin/mssim"
chmod u-w "$work/moved/build/release/bin"
runs 3
warns "$work/moved/build/release cannot be written"
warns "cmake --preset release -S '$work/moved' -B ELSEWHERE"
[[ $(wc -l <err) == 1 ]] || fail 'one message'

# Another user, who may not install.
printf '%s\n' libhwy-dev tetgen >absent
tool sudo <<<'exit 1'
runs 3
warns 'this user may not install packages'
warns 'apt-get install -y --no-install-recommends libhwy-dev tetgen'
warns 'runs without tetgen: cmake'
! noted apt-get || fail 'nothing is tried that is not allowed'
