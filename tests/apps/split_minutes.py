#!/usr/bin/python3
"""Unpacks the log of the Intel lab and writes its reference poses of the even minutes, and those of the odd minutes
within 1 m of them.

usage: split_minutes.py FOLDER_OF_THE_DATA OUTPUT_FOLDER
"""
import bz2
import collections
import csv
import gzip
import pathlib
import sys

data, out = map(pathlib.Path, sys.argv[1:])
(out / "intel.clf").write_bytes(bz2.decompress((data / "intel.clf.bz2").read_bytes()))
with gzip.open(data / "truth.csv.gz", "rt") as table:
    poses = list(csv.DictReader(table))
first = float(poses[0]["t"])
minutes = ([], [])
for pose in poses:
    minutes[int((float(pose["t"]) - first) // 60) % 2].append(pose)

cells = collections.defaultdict(list)
for pose in minutes[0]:
    x, y = float(pose["x"]), float(pose["y"])
    cells[int(x // 1), int(y // 1)].append((x, y))


def is_covered(pose):
    x, y = float(pose["x"]), float(pose["y"])
    return any((x - a) ** 2 + (y - b) ** 2 <= 1 for i in (-1, 0, 1) for j in (-1, 0, 1)
               for a, b in cells.get((int(x // 1) + i, int(y // 1) + j), ()))


for name, rows in (("even", minutes[0]), ("odd", filter(is_covered, minutes[1]))):
    with open(out / f"{name}.csv", "w") as table:
        writer = csv.DictWriter(table, ("t", "x", "y", "yaw"), extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
