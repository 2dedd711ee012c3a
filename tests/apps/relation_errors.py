#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the mean errors of a track over hand-checked relations of two scans (Kümmerle et al. 2009), in metres: over
all, and over those of scans 60 s apart.

Usage: relation_errors.py TRACK.csv RELATIONS
"""
import bisect
import csv
import math
import sys

rows = sorted((float(r["t"]), i, *(float(r[k]) for k in ("x", "y", "yaw")))
              for i, r in enumerate(csv.DictReader(open(sys.argv[1]))))
times = [row[0] for row in rows]


def pose_at(time):
    """Returns the last row at a time, or None."""
    i = bisect.bisect_right(times, time + 2e-4) - 1
    return rows[i][2:] if i >= 0 and abs(times[i] - time) < 1e-3 else None


errors, apart = [], []
for line in open(sys.argv[2]):
    values = [float(v) for v in line.split()]
    a, b = pose_at(values[0]), pose_at(values[1])
    if a is None or b is None:
        continue
    c, s = math.cos(a[2]), math.sin(a[2])
    dx, dy = b[0] - a[0], b[1] - a[1]
    error = math.hypot(c * dx + s * dy - values[2], c * dy - s * dx - values[3])
    errors.append(error)
    if abs(values[1] - values[0]) > 60:
        apart.append(error)
print(len(errors), sum(errors) / len(errors), sum(apart) / len(apart))
