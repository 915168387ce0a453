#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Unpacks the sources of Debian 12's libraries, for processors for which Debian has no compiled ones:
# library_sources.sh FOLDER PACKAGE...  makes FOLDER/PACKAGE. APT checks the signatures; its own lists do not change.
set -eu
folder=$(realpath -m "$1")
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/parts" "$work/lists/partial" "$work/cache/archives/partial" "$work/unpacked" "$folder"
chmod -R a+rX "$work"
cat >"$work/parts/debian.sources" <<END
Types: deb-src
URIs: http://deb.debian.org/debian
Suites: bookworm
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
END
apt_get=(apt-get -q -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts="$work/parts" -o Dir::State::Lists="$work/lists"
  -o Dir::Cache="$work/cache")
"${apt_get[@]}" update
for package in "$@"; do
  (cd "$work" && "${apt_get[@]}" source --download-only "$package" && dpkg-source -x "$package"_*.dsc "unpacked/$package")
  rm -rf "${folder:?}/$package"
  mv "$work/unpacked/$package" "$folder/$package"
done
