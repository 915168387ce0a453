#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Which commits cmake/commit_messages.sh refuses: in a history of its own.
set -e
sources=$1
command -v git >/dev/null || exit 0 # without git there is no history to check
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE
export GIT_CONFIG_GLOBAL=/dev/null GIT_AUTHOR_NAME=a GIT_AUTHOR_EMAIL=a@b.c GIT_COMMITTER_NAME=a GIT_COMMITTER_EMAIL=a@b.c

fail() { echo "line ${BASH_LINENO[0]}: $*" >&2; exit 1; }
commit() { git -C "$work" commit -q --allow-empty "$@"; }
messages() { "$work/cmake/commit_messages.sh"; }
mkdir "$work/cmake" && cp "$sources/cmake/commit_messages.sh" "$work/cmake"
of72=$(printf '×%.0s' {1..72})

messages || fail "sources without a history have nothing to check"
git -C "$work" init -q
messages || fail "a history without commits has nothing to check"
commit -m "${of72}x"
git -C "$work" branch old
git -C "$work" add cmake && commit -m "Add the rule"
messages || fail "commits up to the rule are not checked"
commit -m "$of72" -m "The reason."
messages || fail "a subject of 72 characters with a body is accepted"

git -C "$work" checkout -q old && commit -m "${of72}xx" && git -C "$work" checkout -q -
git -C "$work" merge -q --no-ff -m "Merge branch 'old'" old
messages || fail "merges, and commits that do not descend from the rule, are not checked"

commit -m "No reason"
[[ $(messages) == *'"No reason": no body'* ]] || fail "a commit without a body is refused"
commit --amend -m "${of72}x" -m "The reason."
! messages >/dev/null || fail "a subject of 73 characters is refused"
commit --amend -m "Short" -m "The reason."
messages || fail "an amended message is accepted"

git clone -q --depth 1 "file://$work" "$work/clone"
"$work/clone/cmake/commit_messages.sh" || fail "a clone of the last commit has nothing to check"
