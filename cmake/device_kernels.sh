#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Compiles the scalar twin of every kernel for a GPU, nvptx64, by clang: no SDK, nothing is run. What a graphics
# processor would compute is what a CPU computes only if the code has no fused multiply-add, no approximation and no
# flush of denormals, and calls nothing that it does not hold.
#
#   cmake/device_kernels.sh   prints what is wrong and ends with 1, or the number of kernel files
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
folder=$root/build/nvptx64
cd "$root" && mkdir -p "$folder" || exit 1

# Calls that are no part of a row's loop: rare triangles, the borders of an environment's light, the choice of an
# outline's parts; and of the compiler's own library the absolute value of an integer and the store of a byte.
allowed='^(zoneplate::(doubled_area|make_triangle|make_tile_triangle|LightTree::part|sdf::select_pieces)\(|(abs|__atomic_store_1)$)'

# The headers are those of the host, with the macros that they know it by.
mapfile -t folders < <(clang++ -E -v -x c++ /dev/null 2>&1 | sed -n '/^#include <\.\.\.>/,/^End/s/^ //p')
[ ${#folders[@]} -gt 0 ] || { echo "clang++ names no folders of headers" >&2; exit 1; }
options=(--target=nvptx64-nvidia-cuda -std=c++20 -O2 -ffp-contract=off -fno-math-errno -fno-exceptions -fno-rtti -DNDEBUG
  -nostdinc -nostdinc++ "${folders[@]/#/-isystem}" -D__linux__ -D__gnu_linux__ -D_GNU_SOURCE "-D__$(uname -m)__"
  '-D__builtin_ia32_pause()=' -Iinclude -Isrc)

count=0 failed=0
while read -r source; do
  kernel=${source%_simd.cpp}.cpp
  out=$folder/$(tr / _ <<<"${kernel#src/zoneplate/}")
  if ! clang++ "${options[@]}" -S "$kernel" -o "$out.ptx" 2>"$out.err"; then
    echo "$kernel: $(grep -m1 error "$out.err")" >&2
    failed=1
    continue
  fi
  instructions=$(grep -oE '\b(fma\.r[nzmp][a-z0-9.]*|[a-z0-9]+(\.[a-z0-9]+)*\.(approx|full|ftz)[a-z0-9.]*)' "$out.ptx" | sort -u | paste -sd ' ')
  calls=$(sed -nE 's/^\.extern \.func +(\([^)]*\) +)?([A-Za-z_$][A-Za-z0-9_$]*).*/\2/p' "$out.ptx" | sort -u | c++filt |
    grep -vE "$allowed" | paste -sd ';')
  [ -z "$instructions" ] || { echo "$kernel: has $instructions" >&2; failed=1; }
  [ -z "$calls" ] || { echo "$kernel: calls $calls" >&2; failed=1; }
  count=$((count + 1))
done < <(find src -name '*_simd.cpp' | LC_ALL=C sort)
[ "$count" -gt 0 ] && [ "$failed" = 0 ] || exit 1
echo "$count kernel files have no fused, approximate or flushing instruction and call nothing outside"
