"""A camera that stands at one place of a drawn road and sends what it sees."""

import threading
import time

import rospy
from drawn_road import Road
from sensor_msgs.msg import Image


class StandInCamera:
    """`beside`: m to the left of the line, None shows no road; `sends` False sends nothing."""

    def __init__(self, track, settings):
        self.road, self.beside, self.sends, self.seen = Road(track, settings), 0.0, True, None
        self.publisher = rospy.Publisher("camera/image_raw", Image, queue_size=1)
        threading.Thread(target=self._send, daemon=True).start()

    def _send(self):
        while not rospy.is_shutdown():
            if self.sends:
                self.publisher.publish(self._message())
            time.sleep(1 / 30)

    def _message(self):
        pose = (0.0, 30.0, 0.0) if self.beside is None else self.road.pose(0.0, self.beside)
        if self.seen is None or self.seen[0] != pose:
            self.seen = pose, self.road.view(pose)
        height, width = self.seen[1].shape[:2]
        message = Image(height=height, width=width, encoding="bgr8", step=width * 3)
        message.header.stamp = rospy.Time.now()
        message.data = self.seen[1].tobytes()
        return message
