#!/usr/bin/env bash
# Grades one submission: out/grade/summary.md, junit.xml and a page with pictures.
#
#   scripts/grade.sh --file FILE [--course course|race|lane] [--seeds N] [--rules YAML] [--no-sandbox] [--film] [--out DIR]
#
# Exit code 0: the points reach the rules' pass_points; 1: they do not; 2: there is no program that could be driven, or the
# course could not be run. make ends with 2 for all but 0, and prints the code.
. "$(dirname "${BASH_SOURCE[0]}")/mark.sh"
