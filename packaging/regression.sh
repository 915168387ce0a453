#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# A render-regression test: renders models, compares each image with the reference of its name, and fails unless every
# model renders and every image is near its reference. action.yml and examples/ci run it.
usage='usage: regression.sh --models PATTERNS --references DIR [OPTION VALUE]...

  --models PATTERNS    models, as patterns separated by spaces: "models/*.glb parts/**/*.stl"
  --references DIR     the expected images
  --output DIR         where the rendered images are put; default rendered
  --name NAME          names of images, with placeholders of zoneplate render; default {model}.png
  --options OPTIONS    options of zoneplate render; default --size 512x512
  --metric METRIC      metric of zoneplate metrics; default flip
  --threshold VALUE    the value that each image must reach; default 0.01
  --ignore REGIONS     regions or masks that are not compared, separated by spaces (zoneplate metrics --ignore)
  --junit FILE         write the results as JUnit XML
  --report FILE.html   write a page with all images that fail
  --update             accept the rendered images: copy them to the references, if every model renders

A variable of the environment sets a default: MODELS, REFERENCES, ..., UPDATE=true. The program is zoneplate on the PATH,
or that of this source tree. Exit codes: 0 every image is near its reference; 1 a model does not render, two models have
one name, or an image is missing, new, or not near; 2 wrong usage of this script.'
set -u
fail() { echo "regression: $2" >&2; exit "$1"; }
while [ $# -gt 0 ]; do
  case "$1" in
    --models | --references | --output | --name | --options | --metric | --threshold | --ignore | --junit | --report)
      [ $# -gt 1 ] || fail 2 "$1 needs a value"
      option=${1#--}
      printf -v "${option^^}" %s "$2"
      shift 2
      ;;
    --update) UPDATE=true; shift ;;
    --help) echo "$usage"; exit 0 ;;
    *) echo "$usage" >&2; fail 2 "unknown argument '$1'" ;;
  esac
done
[ -n "${MODELS:-}" ] && [ -n "${REFERENCES:-}" ] || { echo "$usage" >&2; fail 2 "needs --models and --references"; }
OUTPUT=${OUTPUT:-rendered}
program=$(realpath "$(command -v zoneplate || echo "$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")/zoneplate")")
# A name that begins with a dash is not an option.
for name in OUTPUT REFERENCES JUNIT REPORT; do [[ ${!name:-} != -* ]] || printf -v "$name" ./%s "${!name}"; done

# The words of $MODELS are patterns, those of $OPTIONS and $IGNORE arguments. A pattern that matches nothing is an error:
# a test of no model would pass for ever.
shopt -s nullglob globstar
models=()
read -r -d '' -a patterns <<<"$MODELS"
for pattern in "${patterns[@]}"; do
  matches=($pattern)
  [ ${#matches[@]} -gt 0 ] && [ -e "${matches[0]}" ] || fail 1 "no model matches $pattern"
  models+=("${matches[@]/#-/./-}")
done
set -f
ignored=()
# One mask may have spaces in its name.
if [ -e "${IGNORE:-}" ]; then regions=("$IGNORE"); else regions=(${IGNORE:-}); fi
for region in ${regions[@]+"${regions[@]}"}; do ignored+=(--ignore "$([ -e "$region" ] && realpath "$region" || echo "$region")"); done

# A new folder, so that images of an earlier run, of models that are gone or that fail now, are not taken for this one's.
place=$(mktemp -d) || exit 1
trap 'rm -rf "$place"' EXIT
mkdir "$place/rendered" "$place/none" && mkdir -p "$OUTPUT" || exit 1
rm -f ${JUNIT:+"$JUNIT"} ${REPORT:+"$REPORT"}
failed=0
"$program" render "${models[@]}" -o "$place/rendered/${NAME:-{model\}.png}" ${OPTIONS:---size 512x512} --json --progress none \
  >"$place/render.jsonl"
case $? in
  0) ;;
  2) fail 1 "nothing was rendered, for the reason above (models of one name need --name '{dir}_{model}.png')" ;;
  *) failed=1 ;;
esac
cp -R "$place/rendered/." "$OUTPUT/" || exit 1

if [ "${UPDATE:-false}" = true ]; then
  [ "$failed" -eq 0 ] || fail 1 "not every model renders: no image is accepted"
  mkdir -p "$REFERENCES" && cp -R "$place/rendered/." "$REFERENCES/" || exit 1
  echo "images accepted in $REFERENCES: $(find "$place/rendered" -type f -printf . | wc -c)"
fi
references=$place/none
if find "$REFERENCES" -type f 2>/dev/null | grep -qiE '\.(png|jpe?g|webp|hdr|exr|pfm)$'; then
  references=$(realpath "$REFERENCES")
else
  echo "regression: $REFERENCES: has no images yet. Look at those in $OUTPUT; accept them with --update (in a workflow," \
    "UPDATE or update: true), and commit $REFERENCES" >&2
fi
junit=$(realpath -m "${JUNIT:-.}") report=$(realpath -m "${REPORT:-.}")
(cd "$place" && "$program" metrics "$references" rendered --rendered render.jsonl --metric "${METRIC:-flip}" \
  --threshold "${THRESHOLD:-0.01}" ${ignored[@]+"${ignored[@]}"} ${JUNIT:+--junit "$junit"} ${REPORT:+--report "$report"}) ||
  failed=1
exit $failed
