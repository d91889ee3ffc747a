#!/usr/bin/env python3
"""Drives a follower round the course without a screen, scores it and writes a report (--help)."""

from evaluation.start import start

if __name__ == "__main__":
    start("course_run.main", "CourseRun")
