#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The shards of a batch by Dask: one task for each shard, tried again if it is killed or SIGTERM ends it.

    zoneplate plan jobs.jsonl --size 512 --threads 1 --ledger out/ledger
    farm/dask/batch.py 100 jobs.jsonl --size 512 --ledger out/ledger

SCHEDULER in the environment is the address of a cluster; without it the workers are processes of this machine.
"""
import os
import subprocess
import sys

from distributed import Client, LocalCluster, as_completed


def render(shard, shards, words):
    """Renders one shard; what the ledger records is not made again."""
    command = [os.environ.get("ZONEPLATE", "zoneplate"), "render", *words, f"--shard={shard}/{shards}", "--threads=1"]
    code = subprocess.run([*command, "--grace=40", "--retries=2", "--quiet"], check=False).returncode
    if code in (-9, -15, 137, 143):
        raise InterruptedError(f"shard {shard} was ended by a signal")  # tried again
    return shard, code


def main():
    shards, words = int(sys.argv[1]), sys.argv[2:]
    address = os.environ.get("SCHEDULER")
    cluster = None if address else LocalCluster(threads_per_worker=1, dashboard_address=None)
    with Client(address or cluster) as client:
        tasks = client.map(render, range(shards), shards=shards, words=words, retries=20, pure=False)
        failed = {}
        for task in as_completed(tasks):
            shard, code = task.result()
            if code != 0:
                failed[shard] = code
    for shard, code in sorted(failed.items()):
        print(f"shard {shard}: exit code {code}", file=sys.stderr)
    return 5 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
