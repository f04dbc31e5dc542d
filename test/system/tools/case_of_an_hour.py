#!/usr/bin/python3
"""Writes the bags of a case as record.launch does, for scripts/measure_screen: pictures and results 25 times a second, commands and poses 50
times, states 20 times; every minute the region is covered, every ten lost, and the arm stopped.

  case_of_an_hour.py FOLDER SECONDS
"""
import pathlib
import sys

import cv2
import numpy as np
import rosbag
import rospy
from geometry_msgs.msg import PoseStamped
from laparoscope_servo.msg import ControllerState, Homography, OperatingState, ScopeVelocity
from sensor_msgs.msg import CompressedImage
from std_msgs.msg import String

SPLIT = 600.0  # s, a file


def picture():
    """One of 640x480 with texture and a sensor's noise, as JPEG 90."""
    random = np.random.default_rng(1)
    coarse = cv2.resize(random.uniform(60, 200, (60, 80, 3)).astype(np.float32), (640, 480), interpolation=cv2.INTER_CUBIC)
    noisy = np.clip(coarse + random.normal(0, 3, coarse.shape), 0, 255).astype(np.uint8)
    return cv2.imencode(".jpg", noisy, [cv2.IMWRITE_JPEG_QUALITY, 90])[1].tobytes()


def messages_at(k, stamp, jpeg):
    """All of one fiftieth of a second: topic and message."""
    time = 0.02 * k
    lost, covered = time % 600 > 590, time % 60 > 50
    stopped = time % 600 > 580
    command = ScopeVelocity(pan=0.0 if stopped else 0.02 * np.sin(time), tilt=0.0 if stopped else 0.01 * np.cos(time))
    command.header.stamp = stamp
    yield "/servo_command", command
    pose = PoseStamped()
    pose.header.stamp = stamp
    pose.pose.position.x, pose.pose.position.y = 0.02 * np.sin(time / 7), 0.02 * np.cos(time / 5)
    yield "/aesop/measured_cp", pose
    if k % 2 == 0:
        image = CompressedImage(format="bgr8; jpeg compressed bgr8", data=jpeg)
        image.header.stamp = stamp
        yield "/camera/image_raw/compressed", image
        result = Homography(state=3 if lost else 1, visible_fraction=0.4 if covered else 0.97, processing_time=0.004, corner_error=0.3)
        result.header.stamp = stamp
        result.reference_stamp = rospy.Time(1000)
        result.corners = [200, 150, 360, 150, 360, 290, 200, 290]
        yield "/tracker/homography", result
    if k % 50 == 0:
        state = "HOLD" if lost else "IDLE" if stopped else "SERVO"
        yield "/controller/state", ControllerState(state=state, task="HOLD_VIEW", reason="" if state == "SERVO" else "stopped by STOP")
    if k % 5 == 0:
        yield "/aesop/operating_state", OperatingState(state="DISABLED" if stopped else "ENABLED", reason="stopped by STOP" if stopped else "")


def main():
    folder, seconds = pathlib.Path(sys.argv[1]), float(sys.argv[2])
    jpeg, bag, count = picture(), None, 0
    for k in range(int(50 * seconds)):
        stamp = rospy.Time.from_sec(1000.0 + 0.02 * k)
        if k % int(50 * SPLIT) == 0:
            if bag:
                bag.close()
            bag = rosbag.Bag(folder / f"case_{k // int(50 * SPLIT):03d}.bag", "w")
            bag.write("/session", String(data="versions: {}"), stamp)
        for topic, message in messages_at(k, stamp, jpeg):
            bag.write(topic, message, stamp + rospy.Duration.from_sec(0.01))
            count += 1
    bag.close()
    print(f"{count} messages, pictures of {len(jpeg) / 1000:.0f} kB")


if __name__ == "__main__":
    main()
