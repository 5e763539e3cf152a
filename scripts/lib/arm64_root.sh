# shellcheck shell=bash disable=SC2154 # root is prepare.sh's
# The libraries for arm64 with which scripts/test --arm64 and scripts/package --arm64 link. Sourced after prepare.sh.
#
# They have a folder of their own, and are not installed as packages of a second architecture: dpkg may refuse those, or remove others for
# them, and a foreign architecture remains. Root is not needed.

# extract_packages FOLDER DEB...: their files, and what dpkg-query --admindir=FOLDER/var/lib/dpkg knows of them, without their scripts.
extract_packages() {
  local folder=$1 database=$1/var/lib/dpkg deb
  shift
  mkdir -p "$database/info"
  for deb in "$@"; do
    dpkg-deb --extract "$deb" "$folder" &&
      { dpkg-deb --field "$deb" && printf 'Status: install ok installed\n\n'; } >>"$database/status" &&
      dpkg-deb --fsys-tarfile "$deb" | tar -t | sed 's,^\.,,; s,/$,,; s,^$,/.,' >"$database/info/$(dpkg-deb --field "$deb" Package).list" || return
  done
}

# ensure_arm64_root: fills build/arm64-root, unless it has the packages of scripts/packages.txt already.
ensure_arm64_root() {
  local folder=$root/build/arm64-root new=$root/build/arm64-root.new log=$root/build/arm64-root.log lock
  # libstdc++6 and libgomp1 belong to the compiler, whose package brings them only for this machine's architecture. tetgen goes into an
  # archive, and HDF5 compresses with libaec.
  local -a wanted
  mapfile -t wanted < <(packages_for library && printf '%s\n' libstdc++6 libgomp1 tetgen libaec-dev)
  make_folder "$root/build"
  exec {lock}>"$root/build/.arm64-root.lock"
  flock "$lock"
  if [[ ! -e $folder/packages ]] || ! diff -q "$folder/packages" <(printf '%s\n' "${wanted[@]}") >/dev/null; then
    say "fetching libraries for arm64 into $folder (log: $log)"
    rm -rf "$new"
    mkdir -p "$new/apt/lists/partial" "$new/apt/archives/partial"
    : >"$new/apt/status"
    # A separate state of the package manager, in which nothing is installed.
    local -a apt=(apt-get -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State="$new/apt"
      -o Dir::State::status="$new/apt/status" -o Dir::Cache="$new/apt" -o APT::Sandbox::User="$(id -un)")
    {
      "${apt[@]}" update || true
      "${apt[@]}" install --yes --download-only --no-install-recommends "${wanted[@]}" &&
        extract_packages "$new" "$new"/apt/archives/*.deb
    } </dev/null >"$log" 2>&1 || {
      cat "$log" >&2
      missing "the libraries for arm64 could not be fetched; this needs network access and Debian's package archive"
    }
    # The work of installation scripts.
    [[ -e $new/lib ]] || ln -s usr/lib "$new/lib"
    ln -s hdf5-serial.pc "$new/usr/lib/aarch64-linux-gnu/pkgconfig/hdf5.pc"
    # The linker for PoCL (see run_arm64): a program of this machine that uses the libraries in the folder.
    mkdir "$new/host"
    cat >"$new/host/aarch64-unknown-linux-gnu-ld" <<'END'
#!/bin/sh
root=${0%/host/*}
exec /usr/bin/aarch64-linux-gnu-ld --sysroot="$root" -L"$(echo "$root"/usr/lib/gcc/aarch64-linux-gnu/*)" -L"$root/usr/lib/aarch64-linux-gnu" "$@"
END
    chmod +x "$new/host/aarch64-unknown-linux-gnu-ld"
    rm -rf "$new/apt" "$folder"
    printf '%s\n' "${wanted[@]}" >"$new/packages"
    mv "$new" "$folder"
  fi
  exec {lock}>&-
}
