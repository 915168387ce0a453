#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Renders $MODELS with $OPTIONS into $OUTPUT, and compares each image with that of its name in $REFERENCES by $METRIC:
# the run of action.yml. Exit code 1 if an image is missing, new, or worse than $THRESHOLD. The results are also written
# as JUnit XML if $JUNIT is a name. The program is `zoneplate`
# on the PATH, or that of this source tree.
set -u
program=$(command -v zoneplate || echo "$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")/zoneplate")
mkdir -p "$OUTPUT" || exit 4
shopt -s nullglob
# The words of $MODELS are patterns, those of $OPTIONS arguments.
models=($MODELS)
[ ${#models[@]} -gt 0 ] || { echo "no model matches: $MODELS" >&2; exit 3; }
failed=0
for model in "${models[@]}"; do
  name=$(basename "${model%.*}").png
  "$program" render "$model" -o "$OUTPUT/$name" $OPTIONS --quiet || failed=1
done
"$program" metrics "$REFERENCES" "$OUTPUT" --metric "$METRIC" --threshold "$THRESHOLD" ${JUNIT:+--junit "$JUNIT"} || failed=1
exit $failed
