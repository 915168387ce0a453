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
cat >"$work/bin/dpkg" <<END
#!/bin/bash
[ "\$*" != "-L png-dev" ] || printf '%s\n' /usr/include/png.h /usr/include/png
END
cat >"$work/bin/ninja" <<END
#!/bin/bash
cat $work/deps
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

# A library was updated: what includes its headers is built again, although they are older than the program, which stays.
release=$root/build/release
cat >"$work/deps" <<END
dir/png.o: #deps 2, deps mtime 1 (VALID)
    ../src/png.cpp
    /usr/lib/../include/png.h

dir/other.o: #deps 1, deps mtime 1 (VALID)
    /usr/include/stdio.h

pch.gch: #deps 1, deps mtime 1 (VALID)
    /usr/include//png.h
END
make_files() { mkdir -p "$release/dir" && touch "$release"/{dir/png.o,dir/other.o,pch.gch,libz.a,zoneplate}; }
there() { (cd "$release" && find . -type f ! -name '.*' -printf '%P\n' | LC_ALL=C sort | paste -sd ' '); }
update() { echo "png-dev $1" >"$work/versions"; touch -d '1 hour' "$dpkg_status"; }
make_files
update 1.1
say() { echo "said: $*" >>"$work/calls"; }
[[ $(calls) == *said:\ png-dev\ 1.0\ -\>\ 1.1:\ building\ again*--build* ]] || fail "the package is named: $(cat "$work/calls")"
[[ $(there) == "dir/other.o zoneplate" ]] || fail "only what is made of the package is removed: $(there)"
touch -d '1 minute ago' "$dpkg_status"
[[ -z $(calls) ]] || fail "and that is noted"

# Without the lists of headers all objects are built again.
make_files
update 1.2
: >"$work/deps"
[[ $(calls) == *--build* ]] || fail "it is built again"
[[ $(there) == zoneplate ]] || fail "all objects are removed, and the program stays: $(there)"

# A build that fails leaves the program, and the next one continues it: what it has built is not removed again.
make_files
update 1.3
printf '#!/bin/bash\n[[ $* != *--build* ]]\n' >"$work/bin/cmake"
(build release build) 2>/dev/null && fail "a failure is one"
[[ -e $release/zoneplate ]] || fail "the program stays"
make_files
(build release build) 2>/dev/null && fail "it is built again"
[[ $(there) == "dir/other.o dir/png.o libz.a pch.gch zoneplate" ]] || fail "what was built stays: $(there)"

# Help is that of the program that is there, however old, and is built only if there is none.
cp "$sources/cmake/setup.sh" "$root/cmake/"
cp "$sources/zoneplate" "$root/"
printf '#!/bin/bash\necho program "$@"\n' >"$release/zoneplate"
chmod +x "$release/zoneplate"
rm -f "$release/.zoneplate-built"
for question in --help -h --version help "help render" "render --help"; do
  [[ $("$root/zoneplate" $question 2>/dev/null) == "program $question" ]] || fail "$question needs no build"
done
"$root/zoneplate" render 2>"$work/err" && fail "what is old is not used for images"
grep -q 'is still that of the last build' "$work/err" || fail "the program that stays is named: $(cat "$work/err")"
rm "$release/zoneplate"
"$root/zoneplate" --help 2>/dev/null && fail "without a program help needs a build"
true
