#!/usr/bin/env python3
"""Counts the tests of one ctest run: tools/test_results.py RESULTS FAILURES

The folder RESULTS holds ctest.xml, ctest's own report, and PROGRAM-GROUP.xml, GoogleTest's report of each group of
tests that ran in one process. Prints a line "passed<TAB>COUNT" and lines "failed<TAB>NAME" and "skipped<TAB>NAME".
Writes the output of failed tests to the file FAILURES. A group that crashed or timed out has no report and counts as
one failed test.
"""
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree


def outcomes_of_group(path):
    """Yields (name, "passed" | "failed" | "skipped", message) of each test in GoogleTest's report."""
    for case in ElementTree.parse(path).getroot().iter("testcase"):
        name = f'{case.get("classname")}.{case.get("name")}'
        failures = [failure.get("message", "") for failure in case.findall("failure")]
        if failures:
            yield name, "failed", "\n".join(failures)
        elif case.find("skipped") is not None:
            yield name, "skipped", ""
        elif case.get("status") == "run":
            yield name, "passed", ""


def outcomes(results):
    for case in ElementTree.parse(results / "ctest.xml").getroot().iter("testcase"):
        name, status = case.get("name"), case.get("status")
        group = results / (name.replace("/", "-") + ".xml")
        if re.fullmatch(r"weir_tests_\w+/\d+", name) and group.exists():
            found = list(outcomes_of_group(group))
            yield from found
            if status != "fail" or any(kind == "failed" for _, kind, _ in found):
                continue  # otherwise the group failed after its last test, and is reported below
        output = case.findtext("system-out") or ""
        kind = {"run": "passed", "fail": "failed"}.get(status, "skipped")
        yield name, kind, output[-8000:]


def main():
    results, failures = map(pathlib.Path, sys.argv[1:])
    passed = 0
    with failures.open("w") as said:
        for name, kind, message in outcomes(results):
            if kind == "passed":
                passed += 1
                continue
            print(kind, name, sep="\t")
            if kind == "failed":
                said.write(f"{name}\n{message}\n\n")
    print("passed", passed, sep="\t")


main()
