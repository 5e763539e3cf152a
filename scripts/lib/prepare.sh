# shellcheck shell=bash
# Shared functions of the scripts: help, packages and builds. Sourced, with `set -euo pipefail`. Messages go to stderr; without work to do,
# nothing is printed.

# The numbers of mssim and of results have a decimal point, also for awk, sort and printf of a user whose language has a comma.
[[ ! ${LC_ALL-} ]] || export LANG=$LC_ALL
unset LC_ALL
export LC_NUMERIC=C
# cd would print folders that it finds with it.
unset CDPATH

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." >/dev/null && pwd -P)

# Exit code of mssim for a missing device or program.
readonly exit_missing=3

say() { printf '%s: %s\n' "${0##*/}" "$*" >&2; }

# refuse SENTENCE, missing SENTENCE: says it, and exits as mssim does for bad usage or input, and for what is not there.
refuse() { say "$*" && exit 2; }
missing() { say "$*" && exit "$exit_missing"; }

bad_usage() { refuse "$*; see --help"; }

# has_option NAME ARGUMENT...: whether --NAME is among them.
has_option() { [[ " ${*:2} " == *" --$1"[\ =]* ]]; }

# timed PROGRAM ARGUMENT...: runs it, prints its time, and returns its exit code.
timed() {
  local start=$SECONDS code=0
  "$@" || code=$?
  say "$* took $((SECONDS - start)) s"
  return "$code"
}

# measured_on CLONE: for a page of results: the processor, the commit of the clone, ", changed" if files other than results were modified,
# and the time.
measured_on() {
  awk -F ': *' -v processors="$(nproc)" '
    { sub(/[ \t]+$/, "", $1) }
    !($1 in value) { value[$1] = $2 }
    END { if (value["model name"] != "") printf "%s, family %s model %s ", value["model name"], value["cpu family"], value["model"]
          printf "(%d logical CPUs), ", processors }' /proc/cpuinfo
  printf 'commit %s%s, %s' "$(git -C "$1" rev-parse --short=12 HEAD)" \
    "$([[ -z $(git -C "$1" status --porcelain -uno -- . ':!results') ]] || echo ', changed')" "$(date -u +%Y-%m-%dT%H:%M:%SZ)"
}

# commit_of REVISION: its commit, or says that there is none here, and exits.
commit_of() {
  git -C "$root" rev-parse --verify --quiet "$1^{commit}" && return
  refuse "there is no revision $1 here; fetch it first (a shallow clone has few), or name another"
}

# answer_help ARGUMENT...: if one of them is -h or --help, prints the comment at the top of the script, and exits.
answer_help() {
  local argument
  for argument in "$@"; do
    [[ $argument == -h || $argument == --help ]] || continue
    awk 'NR > 1 { if (!sub(/^# ?/, "")) exit; print }' "$0"
    exit 0
  done
}

# packages_for KIND...: the names of the packages of these kinds, except those of another Debian release.
packages_for() {
  local release
  release=$(. /etc/os-release && echo "${VERSION_ID-}")
  awk -v kinds=" $* " -v release="$release" '
    !/^#/ && NF && index(kinds, " " $2 " ") && ($3 !~ /^[0-9]+$/ || $3 == release) { print $1 }' "$root/scripts/packages.txt"
}

# missing_packages KIND...: those of them that are not installed.
missing_packages() {
  local -a wanted
  mapfile -t wanted < <(packages_for "$@")
  # dpkg-query fails if it does not know one of them, but still lists the others.
  comm -23 <(printf '%s\n' "${wanted[@]}" | sort -u) \
    <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null |
      awk '$1 == "installed" { print $2 }' | sort)
}

# can_write FOLDER: whether this user can build in it, or create it.
can_write() {
  local folder=$1
  [[ ! -e $folder/.lock || -w $folder/.lock ]] || return 1
  until [[ -e $folder ]]; do folder=${folder%/*}; done
  [[ -w $folder ]]
}

# make_folder FOLDER: creates a folder for a build, or reports that this user cannot, proposes another place, and exits.
make_folder() {
  can_write "$1" && mkdir -p "$1" && return
  missing "$1 cannot be written by this user; to build elsewhere: cmake --preset release -S ${root@Q} -B ELSEWHERE && ninja -C ELSEWHERE mssim && ELSEWHERE/bin/mssim"
}

# ensure_packages KIND...: installs missing packages, or names them and exits.
ensure_packages() {
  # On other systems than Debian, libraries have other sources, and CMake names a missing one.
  command -v dpkg-query >/dev/null || return 0
  local -a missing as_root=()
  mapfile -t missing < <(missing_packages "$@")
  ((${#missing[@]})) || return 0
  ((EUID == 0)) || as_root=(sudo)
  local update install="install -y --no-install-recommends ${missing[*]}" log=$root/build/packages.log
  "${as_root[@]}" env true </dev/null &>/dev/null || {
    local spare
    spare=$(awk -v missing=" ${missing[*]} " '!/^#/ && $3 == "spare" && index(missing, " " $1 " ") { printf " %s", $1 }' \
      "$root/scripts/packages.txt")
    missing "these Debian packages are missing, and this user may not install packages; ask an administrator for: apt-get $install" \
      "${spare:+(mssim builds and runs without$spare: cmake --preset release -S ${root@Q} -B ELSEWHERE -D BUILD_TESTING=OFF)}"
  }
  make_folder "$root/build"
  say "installing ${missing[*]} (log: $log)"
  # Existing lists of packages often suffice, and fetching them takes seconds. A failed update is no reason to stop, only a failed
  # installation.
  # shellcheck disable=SC2086 # the words of $install are arguments of their own
  for update in true "${as_root[*]} apt-get update"; do
    $update || true
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 $install && return 0
  done </dev/null >"$log" 2>&1
  local apt="${as_root[*]:+sudo }apt-get"
  missing "these Debian packages are missing and could not be installed; with network access, run: $apt update && $apt $install"
}

# Lines of ninja that show compiling or linking.
readonly compiles='^\[[^ ]*\] .*(Building|Linking)'

# follow_build NAME LOG: reads ninja's output, keeps it in LOG, and prints a message once there is something to compile; on a terminal it
# shows the progress of the build.
follow_build() {
  local name=$1 log=$2 line said='' width=${COLUMNS:-80}
  while IFS= read -r line; do
    printf '%s\n' "$line"
    [[ $line =~ $compiles ]] || continue
    [[ $said ]] || say "building $name (log: $log)"
    said=yes
    [[ ! -t 2 ]] || printf '\r\033[K%s' "${line:0:width-1}" >&2
  done >"$log"
  [[ -z $said || ! -t 2 ]] || printf '\r\033[K' >&2
}

# fail_build LOG: prints the cause, and exits.
fail_build() {
  # From the first failure on; everything if CMake failed.
  awk '/^FAILED: / { found = 1 } { line[NR] = $0; if (found && !first) first = NR }
       END { for (i = first ? first : 1; i <= NR; ++i) print line[i] }' "$1" >&2
  missing "the build failed; its whole log is $1"
}

# is_configured FOLDER: whether it builds this source; a folder copied with its repository would still build the original.
is_configured() { grep -qsxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$1/CMakeCache.txt"; }

# is_built PRESET: whether build/PRESET has an mssim that was built here.
is_built() {
  [[ -x $root/build/$1/bin/mssim ]] && is_configured "$root/build/$1"
}

# build PRESET [TARGET...]: updates build/PRESET. Of several at the same time, one builds and the others wait.
build() {
  # A name that no script uses for a folder that it removes at its end: if the build fails, its trap sees this variable.
  local preset=$1 build_folder=$root/build/$1 lock
  shift
  make_folder "$build_folder"
  exec {lock}>"$build_folder/.lock"
  if ! flock --nonblock "$lock"; then
    say "waiting for another build of $build_folder"
    flock "$lock"
  fi
  # CMake reconfigures by itself when a CMakeLists.txt changed, but not for a new preset, nor for a package that came later, such as MPI
  # or the compiler of the page's module.
  local fresh=''
  if [[ ! -e $build_folder/build.ninja || $root/CMakePresets.json -nt $build_folder/build.ninja ]] ||
    ! is_configured "$build_folder"; then
    fresh=--fresh
  fi
  if [[ $fresh || /var/lib/dpkg/status -nt $build_folder/build.ninja ]]; then
    (cd -- "$root" && cmake --preset "$preset" $fresh) </dev/null >"$build_folder/configure.log" 2>&1 ||
      fail_build "$build_folder/configure.log"
  fi
  local start=$SECONDS
  NINJA_STATUS='[%f/%t] ' ninja -C "$build_folder" "$@" </dev/null 2>&1 |
    follow_build "mssim, $preset" "$build_folder/build.log" || fail_build "$build_folder/build.log"
  ! grep -qE "$compiles" "$build_folder/build.log" || ((SECONDS - start < 10)) ||
    say "built mssim, $preset, in $((SECONDS - start)) s"
  exec {lock}>&-
}

# build_release TARGET...: installs the packages for it, and updates build/release.
build_release() {
  ensure_packages build library
  build release "$@"
}
