#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Parses the recipes of engines that cannot be run here, and compares what they do with our exit codes.

    farm/test/files.py FARM
"""
import json
import pathlib
import re
import sys

import yaml


def check(condition, message):
    if not condition:
        sys.exit(f"files.py: {message}")


def kubernetes_action(job, code):
    """What a Job does with a pod whose container ended with this code."""
    for rule in job["spec"]["podFailurePolicy"]["rules"]:
        codes = rule.get("onExitCodes")
        if codes and (code in codes["values"]) == (codes["operator"] == "In"):
            return rule["action"]
    return "Count"


def aws_action(definition, code):
    for rule in definition["retryStrategy"]["evaluateOnExit"]:
        if re.fullmatch(rule.get("onExitCode", "").replace("*", ".*"), str(code)):
            return rule["action"]
    return "RETRY"


def main():
    farm = pathlib.Path(sys.argv[1])
    job = yaml.safe_load((farm / "kubernetes/job.yaml").read_text())
    spec = job["spec"]
    check((job["apiVersion"], job["kind"]) == ("batch/v1", "Job"), "job.yaml: not a Job")
    check(spec["completionMode"] == "Indexed" and "backoffLimitPerIndex" in spec, "job.yaml: not indexed")
    check(spec["template"]["spec"]["restartPolicy"] == "Never", "job.yaml: a failure policy needs restartPolicy Never")
    container = spec["template"]["spec"]["containers"][0]
    check(all(rule.get("onExitCodes", {}).get("containerName", container["name"]) == container["name"]
              and 0 not in rule.get("onExitCodes", {}).get("values", [])
              for rule in spec["podFailurePolicy"]["rules"]), "job.yaml: rules of another container, or of success")
    check({code: kubernetes_action(job, code) for code in (1, 2, 3, 4, 5, 143)} ==
          {1: "Count", 2: "FailIndex", 3: "FailIndex", 4: "Count", 5: "Count", 143: "Ignore"},
          "job.yaml: exit codes")
    grace = next(int(a.removeprefix("--grace=")) for a in container["args"] if a.startswith("--grace="))
    check(grace < spec["template"]["spec"]["terminationGracePeriodSeconds"], "job.yaml: --grace is too long")

    definition = json.loads((farm / "aws-batch/job-definition.json").read_text())
    submission = json.loads((farm / "aws-batch/submit-job.json").read_text())
    check(definition["type"] == "container" and 2 <= submission["arrayProperties"]["size"] <= 10_000, "aws-batch")
    check(len(definition["retryStrategy"]["evaluateOnExit"]) <= 5, "job-definition.json: more than five conditions")
    check({code: aws_action(definition, code) for code in (2, 3, 5, 137, 143)} ==
          {2: "EXIT", 3: "EXIT", 5: "EXIT", 137: "RETRY", 143: "RETRY"}, "job-definition.json: exit codes")

    template = yaml.safe_load((farm / "openjd/template.yaml").read_text())
    check(template["specificationVersion"] == "jobtemplate-2023-09", "template.yaml: version")
    names = {"Param." + parameter["name"] for parameter in template["parameterDefinitions"]}
    for step in template["steps"]:
        own = {"Task.Param." + p["name"] for p in step.get("parameterSpace", {}).get("taskParameterDefinitions", [])}
        used = set(re.findall(r"\{\{ *([\w.]+) *\}\}", json.dumps(step)))
        check(used <= names | own, f"template.yaml: {used - names - own} are not defined")
    print("files.py: Kubernetes, AWS Batch and Open Job Description are as they should be")


main()
