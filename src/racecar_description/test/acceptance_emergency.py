"""The plugin's own emergency stop (<eStopTopic>): no joint gets any effort while it is on."""

import unittest

import rospy
from acceptance_car import WHEELS, ControllerStates, Truth, call, wait_until
from acceptance_commands import Commands
from acceptance_tools import spawn_all
from gazebo_msgs.srv import DeleteModel, SpawnModel
from geometry_msgs.msg import Pose
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool

RATE = 40.0  # rad/s: 2 m/s
TYPE = "<robotSimType>"


class Emergency(unittest.TestCase):
    def setUp(self):
        """The car anew, with the tag in its plugin."""
        urdf = rospy.get_param("/robot_description")
        self.addCleanup(rospy.set_param, "/robot_description", urdf)
        with_stop = urdf.replace(TYPE, f"<eStopTopic>stop</eStopTopic>{TYPE}")
        self.assertNotEqual(with_stop, urdf)
        self.assertTrue(call("/gazebo/delete_model", DeleteModel, "racecar").success)
        rospy.set_param("/robot_description", with_stop)
        answer = call("/gazebo/spawn_urdf_model", SpawnModel, "racecar", with_stop, "", Pose(), "")
        self.assertTrue(answer.success, answer.status_message)
        self.addCleanup(spawn_all().end)
        self.truth, self.states, self.commands = Truth(), ControllerStates(), Commands()
        self.addCleanup(self.commands.end)
        self.efforts = []  # s, N m: the greatest of the axles'
        joints = rospy.Subscriber("/racecar/joint_states", JointState, self.take, tcp_nodelay=True)
        self.addCleanup(joints.unregister)

    def take(self, msg):
        axles = [abs(effort) for name, effort in zip(msg.name, msg.effort) if "axle" in name]
        self.efforts.append((msg.header.stamp.to_sec(), max(axles)))

    def test_it_takes_all_effort_and_its_end_gives_it_back(self):
        stop = rospy.Publisher("/racecar/stop", Bool, queue_size=1, tcp_nodelay=True)
        wait_until(stop.get_num_connections, "a listener on the plugin's eStopTopic")
        self.commands.send(WHEELS, RATE)
        self.truth.wait_for_speed(2.0)
        begin = rospy.get_time()
        stop.publish(True)

        def without():
            return [time for time, effort in self.efforts if time > begin and effort == 0]

        wait_until(without, "axles without effort")
        self.commands.send(WHEELS, 2 * RATE)
        self.truth.pass_time(0.5)
        stopped = without()
        rospy.loginfo("the plugin's emergency stop: no effort after %.2f s; it rolls on: %.2f m/s "
                      "0.5 s later", stopped[0] - begin, self.truth.now.speed)
        self.assertLess(stopped[0] - begin, 0.1)
        later = [effort for time, effort in self.efforts if time > stopped[0]]
        self.assertEqual(set(later), {0.0})
        self.assertLess(self.truth.now.speed, 2.02)
        stop.publish(False)  # controllers start anew, with 0 as their command
        self.truth.time_until_standing(rospy.get_time())
