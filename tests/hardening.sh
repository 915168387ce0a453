#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The program is built with the checks of cmake/sources.cmake: position-independent, tables of addresses read-only after
# they were bound at the start, a guard on stacks, and the checking functions of the C library.
program=$1
failed=0
expect() {
  grep -qE "$2" <<<"$3" || { echo "$program: not $1" >&2; failed=1; }
}
expect "position-independent (ELF type DYN)" '^ *Type: +DYN' "$(readelf -hW "$program")"
expect "read-only after relocation (GNU_RELRO)" ' GNU_RELRO ' "$(readelf -lW "$program")"
expect "bound at the start (BIND_NOW)" 'BIND_NOW|FLAGS_1.* NOW' "$(readelf -dW "$program")"
symbols=$(readelf -W --dyn-syms "$program")
expect "guarded against overflows of the stack" ' __stack_chk_fail' "$symbols"
expect "built with _FORTIFY_SOURCE" ' __[a-z]+_chk\b' "$(grep -v stack_chk <<<"$symbols")"
expect "checks of the standard library in readers (_GLIBCXX_ASSERTIONS)" ' _ZSt21__glibcxx_assert_fail' "$symbols"
exit $failed
