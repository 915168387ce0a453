#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fails if an object given as an argument defines a function that the linker may merge with another object's.
#
# A *_simd.cpp is compiled for one instruction set. An inline function or template that it shares with ordinary
# objects (of std, or of a header of ours) is emitted in both, the linker keeps either, and with the newer one a program
# dies on an older processor. Only functions inside a namespace made for the instruction set (N_SSE4, N_AVX2, N_AVX3) are
# safe. Constants may be shared: they are the same bytes.
bad=$(for object in "$@"; do
  [[ $object == *.pch ]] || nm --defined-only -C "$object" # a precompiled header of clang is no object
done |
  grep -E '^[0-9a-f]+ W ' | grep -vE 'N_(SSE4|AVX2|AVX3)|DW\.ref\.__gxx_personality_v0' | sort -u)
[ -z "$bad" ] || { echo "shared with other objects:"; echo "$bad"; exit 1; }
