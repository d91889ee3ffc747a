"""Says in a node, once, what it waits for and what to type then, where rospy itself is silent.

For a ROS master, the first image, scan, odometry or pose of a turtle, a service, an action's
server, a frame, a simulator that has ended.
"""

import contextlib
import difflib
import os
import signal
import sys
import threading
from pathlib import PurePath

from node_basics import listening
from node_basics.listening import listens
from terminal_language import translated

TURTLES = "turtlesim/Pose"
SEEN = ("nav_msgs/Odometry", "sensor_msgs/CompressedImage", "sensor_msgs/Image",
        "sensor_msgs/LaserScan", TURTLES)  # by nodes that drive
# Programs that have loaded one of these say themselves which topic is silent.
WATCH_THEMSELVES = {"ai_robot_tracking.detection", "nav_nodes", "run_session"}
SIMULATOR = "gazebo"  # node name, in any namespace
GRACE = 5.0  # s, wall: a node that ends together with its simulator says nothing
OF_A_LAUNCH = "__log:="  # an argument of its nodes, which start before what they wait for
LAUNCH_GRACE = 20.0  # s, wall
NO_MASTER = ("No ROS master at %s. Type %s in another terminal, or start the course there: "
             "%s; this program then goes on by itself.")
ONLY_NO_MASTER = ("No ROS master at %s. Type %s in another terminal; this program then goes on by "
                  "itself.")
NO_MASTER_NOR_TURTLE = ("No ROS master at %s. Type %s in another terminal, and rosrun turtlesim "
                        "turtlesim_node in a third one; this program then goes on by itself.")
NO_SIMULATOR = ("Nothing on %s yet: nobody publishes it, and no simulator runs. Start the course "
                "in another terminal: %s; this program then goes on by itself.")
OTHER_TOPIC = ("Nothing on %s yet: nobody publishes it. If %s is meant, end this program and start "
               "it with %s:=%s.")
NO_SENSOR = "Nothing on %s yet: no robot of the simulator that runs has such a sensor."
NO_TURTLE = ("Nothing on %s yet: there is no turtle %s. Type in another terminal: rosservice call "
             "/spawn 2 2 0 %s; this program then goes on by itself.")
NO_PUBLISHER = ("Nothing on %s yet: nobody publishes it. Type in another terminal: %s; this "
                "program then goes on by itself.")
STILL = "Nothing on %s yet, though it is published: is the simulation paused?"
# With the command that starts who does, and where it is not known.
NO_SERVICE = ("Nobody offers the service %s yet. Type in another terminal: %s; this program then "
              "goes on by itself.",
              "Nobody offers the service %s yet: start the program that does in another terminal; "
              "this one then goes on by itself.")
NO_ACTION = ("Nobody offers the action %s yet. Type in another terminal: %s; this program then "
             "goes on by itself.",
             "Nobody offers the action %s yet: start the program that does in another terminal; "
             "this one then goes on by itself.")
NO_FRAME = ("Nobody publishes the frame %s yet. Type in another terminal: %s; this program then "
            "goes on by itself.",
            "Nobody publishes the frame %s yet: start the program that does in another terminal; "
            "this one then goes on by itself.")
OTHER_SERVICE = "Nobody offers the service %s yet; is %s meant?"
AGAIN = ("The simulator has ended: no more messages on %s. When the course is started again, this "
         "program goes on by itself.")
ALL_AGAIN = ("The simulator and the ROS master have ended: no more messages on %s. Press Ctrl-C; "
             "start the course, then this program again.")
# What starts the course of a package's programs, or of a topic in other programs.
COURSES = {
    "ai_robot_tracking": "roslaunch ai_robot_tracking start_tracking.launch",
    "car_control": "roslaunch racecar_description car_control.launch",
    "lane_keeping": "roslaunch lane_keeping lane.launch",
    "keyboard_control.py": "roslaunch racecar_description car_control.launch keyboard:=false",
    "learning_autorace": "roslaunch learning_autorace autorace.launch",
    "learning_laser": "roslaunch learning_laser hall.launch",
    "motor_control.py": "roslaunch racecar_description racecar.launch",
    "motor_control_page.py": "roslaunch racecar_description racecar.launch",
    "turtlebot3_teleop": "roslaunch turtlebot3_gazebo turtlebot3_world.launch",
    "/camera": "roslaunch lane_keeping lane.launch",
    "/camera/image": "roslaunch learning_autorace autorace.launch",
    "/camera/image_raw": "roslaunch racecar_description car_control.launch"}
LINE_COURSE = "roslaunch learning_topic 0course.launch"
TURTLESIM = "rosrun turtlesim turtlesim_node"
# Packages and programs that need no course: whether they need turtlesim.
NEED_TURTLES = {
    "actionlib_tutorials": False, "learning_action": False, "learning_parameter": True,
    "learning_service": False, "turtle_command_server.py": True, "turtle_spawn.py": True,
    "turtle_switch.py": True, "learning_tf": True, "multi_tf_sub.py": False,
    "static_tf_pub.py": False, "static_tf_sub.py": False, "person_publisher.py": False,
    "person_subscriber.py": False, "pose_subscriber.py": True, "velocity_publisher.py": True,
    "rospy_tutorials": False, "tf": False, "tf2_ros": False, "turtle_actionlib": True,
    "turtle_tf": True, "turtle_tf2": True, "turtlesim": True, "turtlesim_node": False}
# What starts who publishes a topic or a frame, or offers a service or an action, perhaps for a
# program.
STARTED_BY = {
    "/add_two_ints": "rosrun rospy_tutorials add_two_ints_server",
    "/addInts": "rosrun learning_action action01_server.py",
    "/chatter": "rosrun rospy_tutorials talker",
    "/clear": TURTLESIM,
    "/fibonacci": "rosrun actionlib_tutorials fibonacci_server.py",
    "/person_info": "rosrun learning_topic person_publisher.py",
    "/show_person": "rosrun learning_service person_server.py",
    "/spawn": TURTLESIM,
    "/turtle_shape": "rosrun turtle_actionlib shape_server",
    "dynamic_tf_sub.py turtle1": "rosrun learning_tf dynamic_tf_pub.py",
    "radar": "rosrun learning_tf static_tf_pub.py",
    "son1": "rosrun tf2_ros static_transform_publisher 0.2 0.8 0.3 0 0 0 world son1",
    "son2": "rosrun tf2_ros static_transform_publisher 0.5 0 0 0 0 0 world son2",
    "turtle1": "rosrun learning_tf demo04_pub.py turtle1",
    "turtle2": "rosrun learning_tf demo04_pub.py turtle2"}
HEARD = object()
SAID = set()  # forms of lines


def amend_client(client):
    """Let `init_node` say that it waits for a master; `client` is the module rospy.client.

    rospy says in English that it cannot register, and a Ctrl-C before it has is a traceback.
    """
    init = client.init_node

    def init_node(*words, **options):
        try:
            wait_for_master()
            init(*words, **options)
        except KeyboardInterrupt:
            if options.get("disable_signals") or hasattr(sys, "ps1"):
                raise  # for the program, or the prompt that it was typed at
            sys.exit(128 + signal.SIGINT)
        except client.rospy.exceptions.ROSInitException:
            if not client.rospy.core.is_shutdown_requested():
                raise
            sys.exit(128 + signal.SIGINT)  # while it registered

    init_node.__doc__ = init.__doc__
    client.init_node = init_node


def wait_for_master():
    """Print a line if no master listens, and wait for it; end if none can at this URI."""
    import rosgraph
    import rospy

    uri = rosgraph.get_master_uri()
    if rospy.core.is_initialized() or not uri:  # rospy says what is wrong with an empty one
        return
    if fault := listening.fault_of(uri):
        if hasattr(sys, "ps1"):
            raise rospy.exceptions.ROSInitException(translated(fault))
        sys.exit(translated(fault))
    listening.wait_for_master(uri, translated(no_master(uri, listening.roscore(uri))))


def no_master(uri, roscore):
    """The line of this program while there is no master."""
    needs = [NEED_TURTLES[word] for word in words_of_program() if word in NEED_TURTLES]
    if not needs:
        return NO_MASTER % (uri, roscore, course())
    return (NO_MASTER_NOR_TURTLE if needs[0] else ONLY_NO_MASTER) % (uri, roscore)


def amend_services(services):
    """Let `wait_for_service` say what it waits for; `services` is rospy.impl.tcpros_service."""
    wait = services.wait_for_service

    def wait_for_service(service, timeout=None):
        if timeout is not None:  # the program says what it does then
            return wait(service, timeout)
        timer = after_grace(tell_of_service, service)
        try:
            wait(service)
        finally:
            timer.cancel()

    wait_for_service.__doc__ = wait.__doc__
    services.wait_for_service = wait_for_service


def amend_actions(actions):
    """Let `wait_for_server` say what it waits for; `actions` is actionlib.action_client."""
    kind = actions.ActionClient
    wait = kind.wait_for_server

    def wait_for_server(client, timeout=actions.rospy.Duration()):
        if timeout:  # the program says what it does then
            return wait(client, timeout)
        timer = after_grace(tell_of_action, client.ns)
        try:
            return wait(client)
        finally:
            timer.cancel()

    wait_for_server.__doc__ = wait.__doc__
    kind.wait_for_server = wait_for_server


def amend_frames(buffers):
    """Let a lookup say, once, which frame does not come; `buffers` is tf2_ros.buffer."""
    kind, awaited = buffers.Buffer, set()
    look_up = kind.lookup_transform

    def lookup_transform(buffer, target_frame, source_frame, *rest, **options):
        frames = {target_frame, source_frame} - awaited
        if frames:
            awaited.update(frames)
            after_grace(tell_of_frames, buffer, frames)
        return look_up(buffer, target_frame, source_frame, *rest, **options)

    lookup_transform.__doc__ = look_up.__doc__
    kind.lookup_transform = lookup_transform


def amend_topics(topics):
    """Watch the connections of this process's subscribers; `topics` is the module rospy.topics."""
    kind, told, awaited = topics._SubscriberImpl, set(), {}
    begin, remove = kind.__init__, kind.remove_connection

    def __init__(subscriber, *words, **options):
        begin(subscriber, *words, **options)
        name = subscriber.resolved_name
        if awaited.get(name, subscriber) is HEARD or not (
                subscriber.type in SEEN or name in STARTED_BY):
            return
        if name not in awaited:
            after_grace(look, name)
        awaited[name] = subscriber  # the newest: wait_for_message in a loop subscribes often
        receive = subscriber.receive_callback

        def first(*what):
            awaited[name] = HEARD
            receive(*what)

        subscriber.receive_callback = first

    def look(name):
        if awaited[name] is HEARD:
            return
        if awaited[name].closed:
            del awaited[name]
        elif not says_it_itself():
            tell_of_silence(name, awaited[name].type)

    def remove_connection(subscriber, connection):
        remove(subscriber, connection)
        publisher = connection.callerid_pub.rpartition("/")[2]
        if (subscriber.closed or subscriber.type not in SEEN or publisher != SIMULATOR
                or connection.endpoint_id in told or says_it_itself()):
            return
        told.add(connection.endpoint_id)
        later(GRACE, tell, subscriber.resolved_name, connection.endpoint_id)

    kind.__init__, kind.remove_connection = __init__, remove_connection


def after_grace(act, *words):
    """Act later, when what this process waits for should have come."""
    launched = any(word.startswith(OF_A_LAUNCH) for word in sys.argv)
    return later(LAUNCH_GRACE if launched else GRACE, act, *words)


def later(seconds, act, *words):
    """A timer that ends with the process; a master that is gone is no matter of its line."""
    def run():
        import rosgraph

        with contextlib.suppress(OSError, rosgraph.MasterException):
            act(*words)

    timer = threading.Timer(seconds, run)
    timer.daemon = True
    timer.start()
    return timer


def tell_of_silence(name, kind):
    """Log why no message of this type has come on a topic."""
    publishers = dict(asked("getSystemState")[0])
    by_simulators = {topic for topic, nodes in publishers.items()
                     if SIMULATOR in (node.rpartition("/")[2] for node in nodes)}
    of_kind = {topic for topic, its_kind in asked("getPublishedTopics", "") if its_kind == kind}
    alike = of_kind if kind == TURTLES else by_simulators & of_kind
    place, _, end = name.rpartition("/")
    if name in by_simulators:
        tell_once(STILL, name)
    elif name in publishers:  # by a driver, which knows when it has something
        return
    elif name in STARTED_BY:
        tell_once(NO_PUBLISHER, name, STARTED_BY[name])
    elif kind == TURTLES and not alike:
        tell_once(NO_PUBLISHER, name, TURTLESIM)
    elif kind == TURTLES and place and end == "pose":
        turtle = place.rpartition("/")[2]
        tell_once(NO_TURTLE, name, turtle, turtle)
    elif alike:
        meant = difflib.get_close_matches(name, alike, 1, 0.0)[0]
        tell_once(OTHER_TOPIC, name, meant, name, meant)
    elif by_simulators:
        tell_once(NO_SENSOR, name)
    else:
        tell_once(NO_SIMULATOR, name, course(name))


def course(topic=""):
    """The command that starts what this program, or one that reads the topic, is written for."""
    known = [*words_of_program(), topic]
    return next((COURSES[word] for word in known if word in COURSES), LINE_COURSE)


def words_of_program():
    """The names of this program and of the folders above it."""
    return PurePath(os.path.realpath(sys.argv[0])).parts[::-1]


def tell_of_service(service):
    """Log that nobody offers a service, and which one may be meant."""
    import rospy

    name = rospy.resolve_name(service)
    offered = [each for each, _ in asked("getSystemState")[2]]
    if name not in offered:
        close = difflib.get_close_matches(name, offered, 1, 0.8)
        if close:
            tell_once(OTHER_SERVICE, name, *close)
        else:
            tell_once(*missing(NO_SERVICE, name))


def tell_of_action(space):
    """Log that no server of an action runs; `space`: its topics' name."""
    import rospy

    name = rospy.resolve_name(space)
    if f"{name}/status" not in dict(asked("getSystemState")[0]):
        tell_once(*missing(NO_ACTION, name))


def tell_of_frames(buffer, frames):
    """Log the frames that nobody publishes; only those with a command to start them, if any is."""
    lines = [missing(NO_FRAME, frame) for frame in sorted(frames) if not buffer._frameExists(frame)]
    known = [line for line in lines if line[0] == NO_FRAME[0]]
    for line in [] if says_it_itself() else known or lines:
        tell_once(*line)


def missing(forms, name):
    """The line's form and words for a name; `forms`: with a command, and without."""
    command = STARTED_BY.get(f"{PurePath(sys.argv[0]).name} {name}", STARTED_BY.get(name))
    return (forms[0], name, command) if command else (forms[1], name)


def asked(call, *words):
    """The master's answer to a call of its API."""
    import rosgraph
    import rospy

    return getattr(rosgraph.Master(rospy.get_name()), call)(*words)


def says_it_itself():
    return not WATCH_THEMSELVES.isdisjoint(sys.modules)


def tell_once(form, *words):
    """Log a line, unless this node has said it, perhaps of another name, or ends."""
    import rospy

    said = (form, *words) if form in NO_FRAME else form  # each frame may be another program's
    if said not in SAID and not rospy.is_shutdown():
        SAID.add(said)
        rospy.logwarn("%s", translated(form % words))


def tell(topic, simulator):
    """Log the line, unless this node ends, too, or the simulator at this URI runs on."""
    import rosgraph
    import rospy

    if rospy.is_shutdown() or listens(simulator):
        return
    form = AGAIN if listens(rosgraph.get_master_uri()) else ALL_AGAIN
    rospy.logwarn("%s", translated(form % topic))
