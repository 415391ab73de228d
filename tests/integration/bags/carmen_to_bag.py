"""Writes a CARMEN log as a bag of ROS, by PyPI's `rosbags`, in any form and compression that it knows."""

import decimal
import math
import pathlib

import numpy
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

FORMS = {
    "bag": ("ros1", None, None),
    "bag-bz2": ("ros1", "BZ2", None),
    "bag-lz4": ("ros1", "LZ4", None),
    "mcap": ("mcap", "NONE", None),
    "mcap-chunks": ("mcap", "STORAGE", None),
    "mcap-file": ("mcap", "FILE", None),
    "mcap-message": ("mcap", "MESSAGE", None),
    "db3": ("sqlite3", "NONE", None),
    "db3-file": ("sqlite3", "FILE", None),
    "db3-message": ("sqlite3", "MESSAGE", None),
}


def stamp_of(text):
    """(seconds, nanoseconds) of decimal seconds, without the rounding of a double."""
    seconds, _, fraction = f"{decimal.Decimal(text):f}".partition(".")
    return int(seconds), int((fraction + "000000000")[:9])


def events_of(log):
    """("scan", stamp, ranges, angles, max range, pose) and ("odom", stamp, pose) in the order of the log, and the laser's place."""
    ahead_m = 0.0
    events = []
    for line in log.splitlines():
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        if words[0] == "PARAM" and words[1] == "robot_frontlaser_offset":
            ahead_m = float(words[2])
        elif words[0] == "ODOM":
            events.append(("odom", stamp_of(words[7]), [float(word) for word in words[1:4]]))
        elif words[0] == "FLASER":
            beams = int(words[1])
            ranges = words[2:2 + beams]
            step = math.pi / (beams - beams % 2)
            rest = words[2 + beams:]
            pose = [float(word) for word in rest[3:6]]
            events.append(("scan", stamp_of(rest[6]), ranges, (-math.pi / 2, step), 1000.0, pose))
        elif words[0] == "ROBOTLASER1":
            beams = int(words[8])
            ranges = words[9:9 + beams]
            rest = words[9 + beams + 1 + int(words[9 + beams]):]
            pose = [float(word) for word in rest[3:6]]
            events.append(("scan", stamp_of(rest[11]), ranges, (float(words[2]), float(words[4])), float(words[5]), pose))
    return events, ahead_m


class Bag:
    """A bag that is being written, in one of FORMS."""

    def __init__(self, path: pathlib.Path, form: str):
        self.form, compression, _ = FORMS[form]
        self.is_ros1 = self.form == "ros1"
        self.types = get_typestore(Stores.ROS1_NOETIC if self.is_ros1 else Stores.ROS2_HUMBLE)
        if self.is_ros1:
            self.types.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage"))
            self.writer = Writer1(path)
            if compression:
                self.writer.set_compression(Writer1.CompressionFormat[compression])
        else:
            self.writer = Writer2(path, version=9, storage_plugin=StoragePlugin[self.form.upper()])
            if compression != "NONE":
                self.writer.set_compression(CompressionMode[compression], CompressionFormat.ZSTD)
        self.connections = {}
        self.sequence = 0

    def __enter__(self):
        self.writer.open()
        return self

    def __exit__(self, *_):
        self.writer.close()

    def type(self, name):
        return self.types.types[name]

    def header(self, stamp, frame):
        time = self.type("builtin_interfaces/msg/Time")(sec=stamp[0], nanosec=stamp[1])
        header = self.type("std_msgs/msg/Header")
        self.sequence += 1
        return header(seq=self.sequence, stamp=time, frame_id=frame) if self.is_ros1 else header(stamp=time, frame_id=frame)

    def write(self, topic, type_name, stamp, message):
        if topic not in self.connections:
            self.connections[topic] = self.writer.add_connection(topic, type_name, typestore=self.types)
        serialize = self.types.serialize_ros1 if self.is_ros1 else self.types.serialize_cdr
        self.writer.write(self.connections[topic], stamp[0] * 10**9 + stamp[1], serialize(message, type_name))

    def quaternion(self, heading_rad):
        return self.type("geometry_msgs/msg/Quaternion")(x=0.0, y=0.0, z=math.sin(heading_rad / 2), w=math.cos(heading_rad / 2))

    def write_static_transform(self, stamp, parent, child, x_m, heading_rad=0.0):
        vector = self.type("geometry_msgs/msg/Vector3")(x=x_m, y=0.0, z=0.0)
        transform = self.type("geometry_msgs/msg/Transform")(translation=vector, rotation=self.quaternion(heading_rad))
        stamped = self.type("geometry_msgs/msg/TransformStamped")(header=self.header(stamp, parent), child_frame_id=child, transform=transform)
        self.write("/tf_static", "tf2_msgs/msg/TFMessage", stamp, self.type("tf2_msgs/msg/TFMessage")(transforms=[stamped]))

    def write_transform(self, stamp, pose):
        vector = self.type("geometry_msgs/msg/Vector3")(x=pose[0], y=pose[1], z=0.0)
        transform = self.type("geometry_msgs/msg/Transform")(translation=vector, rotation=self.quaternion(pose[2]))
        stamped = self.type("geometry_msgs/msg/TransformStamped")(header=self.header(stamp, "odom"), child_frame_id="base_link", transform=transform)
        self.write("/tf", "tf2_msgs/msg/TFMessage", stamp, self.type("tf2_msgs/msg/TFMessage")(transforms=[stamped]))

    def write_odometry(self, stamp, pose):
        point = self.type("geometry_msgs/msg/Point")(x=pose[0], y=pose[1], z=0.0)
        still = self.type("geometry_msgs/msg/Vector3")(x=0.0, y=0.0, z=0.0)
        at = self.type("geometry_msgs/msg/PoseWithCovariance")(
            pose=self.type("geometry_msgs/msg/Pose")(position=point, orientation=self.quaternion(pose[2])), covariance=numpy.zeros(36))
        moves = self.type("geometry_msgs/msg/TwistWithCovariance")(
            twist=self.type("geometry_msgs/msg/Twist")(linear=still, angular=still), covariance=numpy.zeros(36))
        message = self.type("nav_msgs/msg/Odometry")(header=self.header(stamp, "odom"), child_frame_id="base_link", pose=at, twist=moves)
        self.write("/odom", "nav_msgs/msg/Odometry", stamp, message)

    def write_scan(self, stamp, ranges, angles, max_range_m, topic="/scan", frame="laser"):
        first_rad, step_rad = angles
        message = self.type("sensor_msgs/msg/LaserScan")(
            header=self.header(stamp, frame), angle_min=first_rad, angle_max=first_rad + step_rad * (len(ranges) - 1),
            angle_increment=step_rad, time_increment=0.0, scan_time=0.0, range_min=0.0, range_max=max_range_m,
            ranges=numpy.array([float(text) for text in ranges], dtype=numpy.float32), intensities=numpy.zeros(0, dtype=numpy.float32))
        self.write(topic, "sensor_msgs/msg/LaserScan", stamp, message)


def write_bag(log: str, path: pathlib.Path, form: str, odometry="topic"):
    """The log's scans as /scan, all its odometry as /odom or as transforms on /tf, the laser's place as a static transform."""
    events, ahead_m = events_of(log)
    with Bag(path, form) as bag:
        bag.write_static_transform(events[0][1], "base_link", "laser", ahead_m)
        for event in events:
            pose = event[-1]
            if odometry == "topic":
                bag.write_odometry(event[1], pose)
            else:
                bag.write_transform(event[1], pose)
            if event[0] == "scan":
                bag.write_scan(*event[1:5])
