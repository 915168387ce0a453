#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Renders $MODELS with $OPTIONS, compares each image with that of its name in $REFERENCES by $METRIC, and puts the images
# into $OUTPUT: the run of action.yml. $NAME is the name of an image, with the placeholders of `zoneplate render`:
# {model}.png by default, {dir}_{model}.png for models of one name in several folders. Exit code 1 if a model cannot be
# rendered, or an image is missing, new, or worse than $THRESHOLD; 2 if two models have one name. The results are also
# written as JUnit XML and as a page for a browser if $JUNIT and $REPORT are names. The program is `zoneplate` on the
# PATH, or that of this source tree.
set -u
program=$(command -v zoneplate || echo "$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")/zoneplate")
mkdir -p "$OUTPUT" || exit 4
shopt -s nullglob globstar
# The words of $MODELS are patterns, those of $OPTIONS arguments.
models=($MODELS)
[ ${#models[@]} -gt 0 ] || { echo "no model matches: $MODELS" >&2; exit 3; }

# A new folder, so that images of an earlier run, of models that are gone or that fail now, are not taken for this one's.
place=$(mktemp -d) || exit 4
trap 'rm -rf "$place"' EXIT
rendered=$place/rendered
mkdir "$rendered"
name=$rendered/${NAME:-'{model}.png'}
plan=$("$program" render "${models[@]}" -o "$name" $OPTIONS --dry-run) || exit 2
failed=0
"$program" render "${models[@]}" -o "$name" $OPTIONS --quiet || failed=1
# The image of a model that is not rendered is empty: the report has it as unreadable, also without a reference.
while IFS= read -r image; do
  [ -e "$image" ] || { mkdir -p "$(dirname "$image")" && : >"$image"; }
done < <(sed -n 's/.*"output":"\([^"]*\)".*/\1/p' <<<"$plan")

if [ -z "$(find "$REFERENCES" -type f -print -quit 2>/dev/null)" ]; then
  echo "$REFERENCES: has no images yet; copy those of $OUTPUT there to accept them" >&2
  failed=3
else
  references=$(realpath "$REFERENCES") junit=$(realpath -m "${JUNIT:-.}") report=$(realpath -m "${REPORT:-.}")
  (cd "$place" && "$program" metrics "$references" rendered --metric "$METRIC" --threshold "$THRESHOLD" \
    ${JUNIT:+--junit "$junit"} ${REPORT:+--report "$report"}) || failed=1
fi
find "$rendered" -type f -empty -delete
cp -R "$rendered/." "$OUTPUT/" || exit 4
exit $failed
