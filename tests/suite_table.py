#!/usr/bin/env python3
"""Markdown tables of a suite's report: by family, then case by case.

    tessera verify --suite extreme --usual-way --json suite.json
    tests/suite_table.py suite.json
"""
import json
import sys


def short(value):
    """Two digits; numbers that JSON cannot say are text already."""
    if isinstance(value, str):
        return value
    return "0" if value == 0 else f"{value:.2g}"


def usual(case, key):
    return case.get("usual_way", {}).get(key, 0)


def print_families(cases):
    print("| family | cases | checks | failed | violations | largest error, ulp | pixels | cracks the usual way | triangles lost the usual way |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---:|")
    for family in dict.fromkeys(case["family"] for case in cases):
        run = [case for case in cases if case["family"] == family and "skipped" not in case]
        floats = [case for case in run if not isinstance(case["error_ulp"], str)]
        print(f"| {family} | {len(run)} | {sum(case['checks'] for case in run):,} | {sum(not case['passed'] for case in run)} "
              f"| {sum(case['violations'] for case in run)} | {short(max((case['error_ulp'] for case in floats), default=0))} "
              f"| {short(max((case['error_px'] for case in floats), default=0))} | {sum(usual(case, 'cracks') for case in run):,} "
              f"| {sum(usual(case, 'lost_triangles') for case in run):,} |")


def print_cases(cases):
    print("| case | expected | checks | worst | bound | passed | error, ulp | pixels | run time, s | cracks the usual way | lost the usual way |")
    print("|---|---|---:|---:|---:|---|---:|---:|---:|---:|---:|")
    for case in cases:
        if "skipped" in case:
            print(f"| {case['case']} | skipped: {case['skipped']} | | | | | | | | | |")
            continue
        print(f"| {case['case']} | {case['expected']} | {case['checks']} | {short(case['worst'])} | {short(case['bound'])} "
              f"| {'yes' if case['passed'] else 'NO'} | {short(case['error_ulp'])} | {short(case['error_px'])} | {case['seconds']:.1f} "
              f"| {usual(case, 'cracks'):,} | {usual(case, 'lost_triangles'):,} |")


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: tests/suite_table.py suite.json")
    with open(sys.argv[1], encoding="utf-8") as file:
        report = json.load(file)
    print(f"Suite {report['suite']} on {report['device']['name']}, driver {report['device']['driver']}.\n")
    print_families(report["cases"])
    print()
    print_cases(report["cases"])


main()
