# SPDX-License-Identifier: Apache-2.0
"""Bags of ROS 2 by an encoder of their own, written after the specifications: CDR (OMG DDSI-RTPS 2.3, section 10),
MCAP (https://mcap.dev/spec), rosbag2 (its SQLite schemas of Foxy and Jazzy), Zstandard (RFC 8878), LZ4 frames.
"""

import math
import os
import sqlite3
import struct
import subprocess
import warnings
from pathlib import Path

import numpy as np
import pytest

import waymark

POSES = [(100 + 0.25 * i, 2 * math.sin(0.1 * i), 2 - 2 * math.cos(0.1 * i), 0.1 * i) for i in range(24)]


class Cdr:
    def __init__(self, big=False):
        self.order = ">" if big else "<"
        self.body = b""

    def put(self, kind, *values):
        size = struct.calcsize(self.order + kind)
        for value in values:
            self.body += b"\0" * (-len(self.body) % size) + struct.pack(self.order + kind, value)
        return self

    def string(self, text):
        raw = text.encode() + b"\0"
        self.put("I", len(raw))
        self.body += raw
        return self

    def message(self):
        return (b"\0\0\0\0" if self.order == ">" else b"\0\1\0\0") + self.body


def odometry(pose, big=False, frame="odom", body="base_link"):
    t, x, y, yaw = pose
    cdr = Cdr(big).put("i", int(t)).put("I", round((t % 1) * 1e9)).string(frame).string(body)
    cdr.put("d", x, y, 0, 0, 0, math.sin(yaw / 2), math.cos(yaw / 2)).put("d", *[0.01] * 36)
    return ("/odom", "nav_msgs/msg/Odometry", int(t * 1e9), cdr.put("d", *[0.0] * 6).put("d", *[0.0] * 36).message())


def drive(**how):
    return [odometry(pose, **how) for pose in POSES]


def chatter(n=3):
    return [("/chatter", "std_msgs/msg/String", 10**11 + i, Cdr().string(f"hello {i}").message()) for i in range(n)]


def zstd(content):
    """A frame of raw blocks; one segment, with its size in 4 bytes."""
    out = b"\x28\xb5\x2f\xfd" + b"\xa0" + struct.pack("<I", len(content))
    blocks = [content[i:i + 100_000] for i in range(0, len(content), 100_000)]
    for i, block in enumerate(blocks):
        out += struct.pack("<I", len(block) << 3 | (i == len(blocks) - 1))[:3] + block
    return out


def xxh32(data, seed=0):
    p1, p2, p3, p4, p5 = 2654435761, 2246822519, 3266489917, 668265263, 374761393
    mask, rotate = 0xFFFFFFFF, lambda v, n: ((v << n) | (v & 0xFFFFFFFF) >> (32 - n)) & 0xFFFFFFFF
    assert len(data) < 4
    value = (seed + p5 + len(data)) & mask
    for byte in data:
        value = rotate((value + byte * p5) & mask, 11) * p1 & mask
    value = (value ^ value >> 15) * p2 & mask
    value = (value ^ value >> 13) * p3 & mask
    return value ^ value >> 16


def lz4(content):
    """A frame of stored blocks of 64 kB."""
    about = b"\x60\x40"
    out = b"\x04\x22\x4d\x18" + about + bytes([xxh32(about) >> 8 & 255])
    for i in range(0, len(content), 65536):
        block = content[i:i + 65536]
        out += struct.pack("<I", len(block) | 1 << 31) + block
    return out + b"\0\0\0\0"


MAGIC = b"\x89MCAP0\r\n"


def record(opcode, content):
    return struct.pack("<BQ", opcode, len(content)) + content


def text(value):
    raw = value.encode()
    return struct.pack("<I", len(raw)) + raw


def table(pairs):
    raw = b"".join(text(key) + text(value) for key, value in pairs)
    return struct.pack("<I", len(raw)) + raw


def mcap(messages, chunk=0, compression="", pack=bytes, encoding="cdr", summary=True):
    """An MCAP file with every kind of record of the specification; with `chunk`, so many messages share a chunk."""
    topics = {}
    for topic, kind, _, _ in messages:
        topics.setdefault(topic, (len(topics) + 1, kind))
    schemas = b"".join(record(3, struct.pack("<H", n) + text(kind) + text("ros2msg") + text("string data"))
                       for n, kind in topics.values())
    channels = b"".join(record(4, struct.pack("<HH", n, n) + text(topic) + text(encoding)
                               + table([("offered_qos_profiles", "")]))
                        for topic, (n, kind) in topics.items())
    out = MAGIC + record(1, text("ros2") + text("test")) + record(12, text("rosbag2") + table([("a", "b")]))
    out += record(9, struct.pack("<QQ", 1, 2) + text("notes.txt") + text("text/plain")
                  + struct.pack("<Q", 5) + b"hello" + struct.pack("<I", 0)) + record(0x81, b"private")
    if not chunk:
        out += schemas + channels
    indices = b""
    for first in range(0, len(messages), chunk or len(messages)):
        part = messages[first:first + (chunk or len(messages))]
        inside, index = (schemas + channels if chunk and not first else b""), {}
        for i, (topic, _, time, body) in enumerate(part):
            index.setdefault(topics[topic][0], []).append(struct.pack("<QQ", time, len(inside)))
            inside += record(5, struct.pack("<HIQQ", topics[topic][0], first + i, time, time) + body)
        if not chunk:
            out += inside
            continue
        times = [time for _, _, time, _ in part]
        packed, at = pack(inside), len(out)
        out += record(6, struct.pack("<QQQI", min(times), max(times), len(inside), 0) + text(compression)
                      + struct.pack("<Q", len(packed)) + packed)
        size, offsets, at_index = len(out) - at, {}, len(out)
        for n, entries in index.items():
            offsets[n] = len(out)
            raw = b"".join(entries)
            out += record(7, struct.pack("<HI", n, len(raw)) + raw)
        where = b"".join(struct.pack("<HQ", n, offset) for n, offset in offsets.items())
        indices += record(8, struct.pack("<QQQQI", min(times), max(times), at, size, len(where)) + where
                          + struct.pack("<Q", len(out) - at_index) + text(compression)
                          + struct.pack("<QQ", len(packed), len(inside)))
    out += record(15, struct.pack("<I", 0))
    if not summary:
        return out + record(2, struct.pack("<QQI", 0, 0, 0)) + MAGIC
    start = len(out)
    out += schemas + channels + indices
    return out + record(14, struct.pack("<BQQ", 3, start, len(schemas))) \
        + record(2, struct.pack("<QQI", start, len(out), 0)) + MAGIC


def db3(path, messages, schema="jazzy"):
    path.unlink(missing_ok=True)
    with sqlite3.connect(path) as bag:
        if schema == "foxy":
            bag.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
                        "serialization_format TEXT NOT NULL)")
        else:
            bag.execute("CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL)")
            bag.execute("CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, "
                        "metadata TEXT NOT NULL)")
            bag.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
                        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL, "
                        "type_description_hash TEXT NOT NULL)")
        bag.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
                    "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
        bag.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
        topics = {}
        for topic, kind, time, body in messages:
            if topic not in topics:
                topics[topic] = len(topics) + 1
                row = (topics[topic], topic, kind, "cdr") + (() if schema == "foxy" else ("", "RIHS01_"))
                bag.execute(f"INSERT INTO topics VALUES ({','.join('?' * len(row))})", row)
            bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)",
                        (topics[topic], time, body))
    bag.close()
    return path


def track_of(bag):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", waymark.Warning)
        return waymark.localize("none", bag, method="odometry", start=(0, 0, 0)).track


def assert_is_the_drive(bag, poses=POSES):
    """Each pose but the first, where the track starts, is in the track at its time."""
    track = {round(row["t"], 6): row for row in track_of(bag)}
    expected = {round(t, 6): pose for t, *pose in poses}
    assert set(list(expected)[1:]) <= set(track) <= set(expected)
    for t, row in track.items():
        np.testing.assert_allclose([row["x"], row["y"], row["yaw"]], expected[t], atol=1e-9)


@pytest.mark.parametrize("big", [False, True])
@pytest.mark.parametrize("letters", range(8))
def test_numbers_of_eight_bytes_are_aligned_behind_any_name(tmp_path, big, letters):
    messages = drive(big=big, frame="o" * (letters + 1), body="base_link"[: 1 + letters % 3])
    (tmp_path / "a.mcap").write_bytes(mcap(messages))
    assert_is_the_drive(tmp_path / "a.mcap")


@pytest.mark.parametrize("summary", [True, False])
@pytest.mark.parametrize("chunk, compression, pack", [
    (0, "", bytes), (1, "", bytes), (5, "zstd", zstd), (5, "lz4", lz4), (1000, "zstd", zstd), (1000, "lz4", lz4)])
def test_mcap_with_every_record_of_the_specification(tmp_path, chunk, compression, pack, summary):
    bag = tmp_path / "a.mcap"
    bag.write_bytes(mcap(drive() + chatter(), chunk, compression, pack, summary=summary))
    assert_is_the_drive(bag)


def test_mcap_is_known_by_its_contents(tmp_path):
    (tmp_path / "recording").write_bytes(mcap(drive()))
    assert_is_the_drive(tmp_path / "recording")


@pytest.mark.parametrize("cut, chunks", [(1, 6), (9, 6), (2000, 5), (6000, 4)])  # a chunk has 3 kB
def test_mcap_that_is_cut_off_is_read_up_to_the_last_whole_chunk(tmp_path, cut, chunks):
    """As a recorder leaves it that was killed: no index of the file, no footer, half a record."""
    whole = mcap(drive(), chunk=4)
    (tmp_path / "a.mcap").write_bytes(whole[:whole.rindex(record(15, bytes(4))) - cut])
    with pytest.warns(waymark.Warning, match="cut off"):
        waymark.localize("none", tmp_path / "a.mcap", method="odometry", start=(0, 0, 0)).track
    assert_is_the_drive(tmp_path / "a.mcap", POSES[:4 * chunks])


@pytest.mark.parametrize("schema", ["foxy", "jazzy"])
def test_rosbag2_of_each_schema(tmp_path, schema):
    assert_is_the_drive(db3(tmp_path / "a.db3", drive() + chatter(), schema))


@pytest.mark.parametrize("storage", ["db3", "mcap"])
def test_messages_compressed_one_by_one(tmp_path, storage):
    messages = [(*about, zstd(body)) for *about, body in drive()]
    bag = tmp_path / f"a.{storage}"
    db3(bag, messages) if storage == "db3" else bag.write_bytes(mcap(messages, 7))
    assert_is_the_drive(bag)


def metadata(files, compressed):
    return ("rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  relative_file_paths:\n"
            + "".join(f"    - {name}\n" for name in files)
            + f"  compression_format: \"{'zstd' if compressed else ''}\"\n"
            + f"  compression_mode: \"{'FILE' if compressed else ''}\"\n")


@pytest.mark.parametrize("storage", ["db3", "mcap"])
@pytest.mark.parametrize("compressed", [False, True])
def test_a_recording_of_many_files(tmp_path, storage, compressed):
    folder, names = tmp_path / "recording", []
    folder.mkdir()
    for i, message in enumerate(drive()):  # _2 sorts behind _10
        file = folder / f"recording_{i}.{storage}"
        db3(file, [message]) if storage == "db3" else file.write_bytes(mcap([message]))
        if compressed:
            packed = Path(f"{file}.zstd")
            packed.write_bytes(zstd(file.read_bytes()))
            if i != 3:  # as if it had been unpacked to be played
                file.unlink()
            file = packed
        names.append(file.name)
    (folder / "metadata.yaml").write_text(metadata(names, compressed))
    assert_is_the_drive(folder)


def test_a_clock_that_jumps_back_is_a_warning(tmp_path):
    (tmp_path / "a.mcap").write_bytes(mcap(drive() + drive()))
    with pytest.warns(waymark.Warning, match="the clock of /odom jumps back by 5.75 s"):
        waymark.localize("none", tmp_path / "a.mcap", method="odometry", start=(0, 0, 0)).track


def refusal(bag):
    track = Path(bag).with_name("track.csv")
    done = subprocess.run([os.environ["WAYMARK"], "localize", "none", bag, "--method", "odometry", "-o", track],
                          capture_output=True, text=True)
    assert done.returncode == 1, done.stderr
    return done.stderr


def test_a_bag_without_odometry_is_refused_with_its_topics(tmp_path):
    (tmp_path / "a.mcap").write_bytes(mcap(chatter(4)))
    assert "/chatter of std_msgs/msg/String (4)" in refusal(tmp_path / "a.mcap")
    (tmp_path / "a.mcap").write_bytes(mcap(drive(), encoding="ros1"))
    assert "/odom of nav_msgs/msg/Odometry (encoded as ros1) (24)" in refusal(tmp_path / "a.mcap")


def test_damaged_zstd_is_refused(tmp_path):
    packed = tmp_path / "a.db3.zstd"
    packed.write_bytes(zstd(db3(tmp_path / "a.db3", drive()).read_bytes())[:-500])
    assert "the bag cannot be unpacked" in refusal(packed)


def test_a_bag_of_ros_1_is_named_as_such(tmp_path):
    (tmp_path / "a.bag").write_bytes(b"#ROSBAG V2.0\n" + bytes(100))
    said = refusal(tmp_path / "a.bag")
    assert "bag of ROS 1" in said and "rosbags-convert" in said
