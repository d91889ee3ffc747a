"""Commands straight to the car's controllers, as `rostopic pub` would give them."""

import rospy
from acceptance_car import HINGES, WHEELS, wait_until
from std_msgs.msg import Float64


class Commands:
    """Publishers of the six command topics."""

    def __init__(self):
        self._publishers = {
            name: rospy.Publisher(f"/racecar/{name}/command", Float64, queue_size=1,
                                  tcp_nodelay=True)
            for name in WHEELS + HINGES}
        wait_until(lambda: all(each.get_num_connections() for each in self._publishers.values()),
                   "six listening controllers")

    def send(self, names, value):
        """rad/s or rad."""
        for name in names:
            self._publishers[name].publish(value)

    def end(self):
        for each in self._publishers.values():
            each.unregister()
