"""Says once in a node that its simulator has ended: rospy is silent then, and the node waits."""

import socket
import sys
import threading
from urllib.parse import urlsplit

SEEN = ("sensor_msgs/Image", "sensor_msgs/CompressedImage", "sensor_msgs/LaserScan")  # by drivers
WATCHES_ITSELF = "nav_nodes"  # a program that has loaded this module says which topic is silent
SIMULATOR = "gazebo"  # node name, in any namespace
GRACE = 5.0  # s, wall: a node that ends together with its simulator says nothing
ANSWER_TIME = 1.0  # s, wall
AGAIN = ("The simulator has ended: no more messages on %s. When the course is started again, this "
         "program goes on by itself.")
ALL_AGAIN = ("The simulator and the ROS master have ended: no more messages on %s. Press Ctrl-C; "
             "start the course, then this program again.")


def amend_topics(topics):
    """Watch the connections of this process's subscribers; `topics` is the module rospy.topics."""
    kind, told = topics._SubscriberImpl, set()
    remove = kind.remove_connection

    def remove_connection(subscriber, connection):
        remove(subscriber, connection)
        publisher = connection.callerid_pub.rpartition("/")[2]
        if (subscriber.closed or subscriber.type not in SEEN or publisher != SIMULATOR
                or connection.endpoint_id in told or WATCHES_ITSELF in sys.modules):
            return
        told.add(connection.endpoint_id)
        later = threading.Timer(GRACE, tell, (subscriber.resolved_name, connection.endpoint_id))
        later.daemon = True
        later.start()

    kind.remove_connection = remove_connection


def tell(topic, simulator):
    """Log the line, unless this node ends, too, or the simulator at this URI runs on."""
    import rosgraph
    import rospy

    if rospy.is_shutdown() or listens(simulator):
        return
    rospy.logwarn(AGAIN if listens(rosgraph.get_master_uri()) else ALL_AGAIN, topic)


def listens(uri):
    """Whether something listens at a URI."""
    place = urlsplit(uri)
    try:
        socket.create_connection((place.hostname, place.port), ANSWER_TIME).close()
    except OSError:
        return False
    return True
