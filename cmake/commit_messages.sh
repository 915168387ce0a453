#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Checks the messages of the commits that descend from the one that added this file: a subject of at most 72 characters, an
# empty line, and a body. Merges are exempt. A copy of the sources without their history has nothing to check.
export LC_ALL=C.UTF-8
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." || exit 1
rule=$(git log --diff-filter=A --format=%H -- cmake/commit_messages.sh 2>/dev/null | tail -n 1)
[ -n "$rule" ] || exit 0
bad=0
for commit in $(git rev-list --no-merges --ancestry-path "$rule..HEAD"); do
  subject=$(git log -1 --format=%s "$commit") body=$(git log -1 --format=%b "$commit")
  short="commit $(git rev-parse --short "$commit") \"$subject\""
  [ ${#subject} -le 72 ] || { echo "$short: a subject of ${#subject} characters, expected at most 72" && bad=1; }
  [ -n "$body" ] || { echo "$short: no body, expected the reason and how it was checked" && bad=1; }
done
exit $bad
