#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# When cmake/setup.sh builds again: a tree of its own, with programs that only note how they were called.
set -e
sources=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/tree
mkdir -p "$root"/{include,src,web,cmake,build} "$work/bin"
touch "$root"/{CMakeLists.txt,CMakePresets.json}
printf 'png-dev   PNG in and out\ngtest-dev (check) tests\n' >"$root/packages.txt"
cat >"$work/bin/dpkg-query" <<END
#!/bin/bash
[ "\$3" != '\${db:Status-Status} \${Package}\n' ] || { echo installed png-dev; exit; }
echo dpkg-query >>$work/calls
cat $work/versions
END
cat >"$work/bin/cmake" <<END
#!/bin/bash
echo cmake "\$@" >>$work/calls
END
chmod +x "$work"/bin/*
PATH=$work/bin:$PATH

program=test
. "$sources/cmake/setup.sh"
dpkg_status=$work/status
say() { :; }

fail() { echo "line ${BASH_LINENO[0]}: $*" >&2; exit 1; }
old() { touch -d '1 hour ago' "$@"; }
calls() { : >"$work/calls"; build release build; cat "$work/calls"; }

echo 'png-dev 1.0' >"$work/versions"
old "$dpkg_status" "$root"/{include,src,web,cmake,CMakeLists.txt,CMakePresets.json,packages.txt}
[[ $(calls) == *--build* ]] || fail "the first call builds"
[[ $(cat "$root/build/release/.zoneplate-packages") == 'png-dev 1.0' ]] || fail "the versions are kept"
[[ -z $(calls) ]] || fail "nothing is new, and dpkg-query is not called"

# An installation of something else: the versions are compared once, and nothing is built.
touch -d '1 hour' "$dpkg_status"
[[ $(calls) == dpkg-query ]] || fail "the versions are compared"
touch -d '1 minute ago' "$dpkg_status"
[[ -z $(calls) ]] || fail "they were compared already"

# A library was updated: all of the program is built again, although its files are older than the program.
echo 'png-dev 1.1' >"$work/versions"
touch -d '1 hour' "$dpkg_status"
[[ $(calls) == *--target\ clean*--build* ]] || fail "the program is built again from nothing"
touch -d '1 minute ago' "$dpkg_status"
[[ -z $(calls) ]] || fail "and that is noted"
