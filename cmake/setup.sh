# SPDX-License-Identifier: Apache-2.0
# What `zoneplate` and `check` have in common: packages and builds. Sourced by them, with `root` and `program` set.
#
# Everything is said on stderr; a step that fails shows its own output and ends the script with exit code 1.

dpkg_status=/var/lib/dpkg/status # written by every installation

say() { echo "$program: $*" >&2; }

# Runs a command and shows its output, on stderr, only if it fails.
run_quietly() {
  local output status=0
  output=$(mktemp)
  "$@" >"$output" 2>&1 </dev/null || status=$?
  [ "$status" -eq 0 ] || cat "$output" >&2
  rm -f "$output"
  return "$status"
}

# The packages of packages.txt for the given purposes (build, check, all, ...), one a line.
wanted_packages() {
  awk -v purposes=" $* " '
    /^#/ || NF == 0 { next }
    { count = split($2 ~ /^\(.*\)$/ ? substr($2, 2, length($2) - 2) : "build", of, ",") }
    { for (i = 1; i <= count; ++i) if (index(purposes, " " of[i] " ")) { print $1; break } }' "$root/packages.txt"
}

# Installs what is missing of the packages for the given purposes.
install_packages() {
  command -v dpkg-query >/dev/null || { say "no dpkg here: what packages.txt lists is taken to be installed"; return 0; }
  local installed missing
  installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p')
  missing=$(wanted_packages "$@" | grep -vxF "$installed") || return 0
  missing=$(echo $missing)

  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    as_root=(sudo -n)
    if ! sudo -n true 2>/dev/null; then
      say "packages are missing, and installing them needs root:"
      echo "    apt-get install --no-install-recommends $missing" >&2
      exit 1
    fi
  fi
  local apt_get=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300)

  # The package index is fetched only where there is none, or where it turns out to be too old.
  say "installing with apt-get: $missing"
  if apt-cache show $missing >/dev/null 2>&1 &&
    "${apt_get[@]}" install --no-install-recommends $missing >/dev/null 2>&1 </dev/null; then
    return 0
  fi
  run_quietly "${apt_get[@]}" update && run_quietly "${apt_get[@]}" install --no-install-recommends $missing || {
    say "apt-get failed; install by hand: $missing"
    exit 1
  }
}

# The versions of the packages that the build compiles and links, a line each: the program contains their code.
package_versions() {
  dpkg-query -W -f '${Package} ${Version}\n' $(wanted_packages build) libbrotli-dev 'libstdc++-*-dev' 2>/dev/null |
    LC_ALL=C sort
}

# True if build/PRESET was made with other versions of its packages. The versions are compared only after an
# installation: dpkg-query takes longer than a small render.
has_new_packages() {
  local versions=$root/build/$1/.zoneplate-packages
  [ "$dpkg_status" -nt "$versions" ] || return 1
  package_versions | cmp -s - "$versions" || return 0
  touch "$versions" 2>/dev/null # a build that cannot be written to is compared again
  return 1
}

# Removes from a build directory what is made of the packages in lines of "NAME OLD NEW", so that it is built again: the
# objects that include their headers, and all archives, so that programs are linked again. Files of a package have the dates
# of its maker: nothing else says that what they went into is old. The program stays until it is replaced.
remove_outdated() {
  local directory=$1 objects
  objects=$(cd "$directory" && ninja -t deps 2>/dev/null | awk '
    NR == FNR { header[$0]; next }
    /^[^ ].*: #deps/ { object = $0; sub(/: #deps.*/, "", object); found = 1; next }
    NF > 0 {
      sub(/^ +/, "")
      while (sub("/[^/]+/[.][.]/", "/")) { }
      gsub("//+", "/")
      if ($0 in header && !(object in outdated)) { outdated[object]; print object }
    }
    END { exit !found }' <(dpkg -L $(awk '{ print $1 }' <<<"$2") 2>/dev/null) -) ||
    objects=$(cd "$directory" && find . -name '*.o' -o -name '*.gch')
  (cd "$directory" && xargs -r -d '\n' rm -f -- <<<"$objects" && find . -name '*.a' -delete)
}

# True if the arguments request help or the version.
asks_for_help() {
  local argument
  for argument in "$@"; do
    [[ $argument != --help && $argument != -h && $argument != --version ]] || return 0
  done
  [ "${1:-}" = help ]
}

# True if build/PRESET is not there or older than anything it is made from.
is_stale() {
  local stamp=$root/build/$1/.zoneplate-built
  [ -e "$stamp" ] || return 0
  local inputs=(include src web cmake CMakeLists.txt CMakePresets.json packages.txt)
  [ "$1" = release ] || inputs+=(tests fuzz)
  [ -z "$(cd "$root" && find "${inputs[@]}" -newer "$stamp" -print -quit)" ] || return 0
  has_new_packages "$1"
}

# build PRESET PURPOSE...: installs what is missing and brings build/PRESET up to date, if it is not.
build() {
  local preset=$1 directory=$root/build/$1
  shift
  is_stale "$preset" || return 0
  mkdir -p "$directory" || { say "cannot write to $root/build"; exit 1; }
  (
    flock 9 # a second call waits here for the first one's build
    is_stale "$preset" || exit 0
    install_packages "$@"
    touch "$directory/.zoneplate-started" # what is saved during the build counts as newer than it
    local versions=$directory/.zoneplate-packages changes
    if [ -e "$versions" ] && has_new_packages "$preset"; then
      changes=$(package_versions | LC_ALL=C join -a 1 -a 2 -e none -o 0,1.2,2.2 "$versions" - | awk '$2 != $3')
      say "$(awk '{ printf "%s%s %s -> %s", (NR > 1 ? ", " : ""), $1, $2, $3 }' <<<"$changes"): building again"
      rm -f "$directory/.zoneplate-built" # until it is built, also if the build is interrupted
      remove_outdated "$directory" "$changes" || exit 1
    fi
    package_versions >"$versions"
    say "building into build/$preset ($(nproc) jobs; a few minutes the first time)"
    cd "$root" && run_quietly cmake --preset "$preset" || exit 1
    if [ -t 2 ]; then
      cmake --build "$directory" --parallel "$(nproc)" >&2 || exit 1
    else
      run_quietly cmake --build "$directory" --parallel "$(nproc)" || exit 1
    fi
    mv "$directory/.zoneplate-started" "$directory/.zoneplate-built"
  ) 9>"$directory/.zoneplate-lock" || {
    say "could not be built"
    [ ! -x "$directory/zoneplate" ] || say "build/$preset/zoneplate is still that of the last build"
    exit 1
  }
}
