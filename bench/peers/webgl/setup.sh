# SPDX-License-Identifier: Apache-2.0
# Sourced by the programs that compare with WebGL in Chromium, with `root` and `program` set: installs packages, and with
# npm, into build/webgl, what package.json names; sets `modules` to that folder.
. "$root/cmake/setup.sh"

purposes=(build check bench)
command -v chromium >/dev/null && command -v node >/dev/null && command -v npm >/dev/null || purposes+=(filters)
install_packages "${purposes[@]}"
modules=$root/build/webgl
mkdir -p "$modules" || exit 1
if ! cmp -s "$root/bench/peers/webgl/package.json" "$modules/package.json"; then
  say "fetching three.js and postprocessing with npm into build/webgl"
  cp "$root/bench/peers/webgl/package.json" "$modules/package.json.new"
  (cd "$modules" && mv package.json.new package.json && run_quietly npm install --no-audit --no-fund --ignore-scripts) ||
    { rm -f "$modules/package.json"; exit 1; }
fi
