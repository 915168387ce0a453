#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The shards of a batch by GNU parallel, on one machine or, with its options in PARALLEL (as --sshloginfile), on several
# with a common file system:
#
#   zoneplate plan jobs.jsonl --size 512 --threads 1 --ledger out/ledger
#   farm/gnu-parallel/batch.sh 100 jobs.jsonl --size 512 --ledger out/ledger
#
# A shard whose exit code is not 0 is tried again, at most 20 times in all: what the ledger records is not made again.
# Ctrl-C ends all of them between two items; the same command goes on.
shards=$1
shift
seq 0 $((shards - 1)) |
  parallel --quote --joblog "${JOBLOG:-zoneplate-shards.log}" --retries 20 --termseq TERM,45000,KILL,1000 \
    "${ZONEPLATE:-zoneplate}" render "$@" --shard "{}/$shards" --threads 1 --grace 40 --retries 2
