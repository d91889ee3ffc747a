"""Says in a node, once, that nobody listens to the commands that it sends, and what to type."""

import difflib

from python_amendments.waiting import (
    SEEN,
    TURTLESIM,
    after_grace,
    asked,
    course,
    says_it_itself,
    tell_once,
)

TWIST = "geometry_msgs/Twist"
OF_A_JOINT = "_controller/command"  # the end of a topic's name
OF_THE_CAR = "roslaunch racecar_description car_control.launch"  # its controllers, too
UNHEARD = ("Nobody listens to %s yet. Type in another terminal: %s; this program then goes on by "
           "itself.")
OTHER_LISTENED = ("Nobody listens to %s yet. If %s is meant, end this program and start it with "
                  "%s:=%s.")


def amend_publishers(topics):
    """Look at this process's commands to a robot or turtle; `topics` is the module rospy.topics."""
    kind = topics._PublisherImpl
    begin = kind.__init__

    def __init__(publisher, *words, **options):
        begin(publisher, *words, **options)
        if publisher.type == TWIST or publisher.resolved_name.endswith(OF_A_JOINT):
            after_grace(look, publisher)

    def look(publisher):
        # What does not come is told instead, by a program that drives by what it sees.
        waits = any(each.type in SEEN and not each.has_connections()
                    for each in list(topics.get_topic_manager().subs.values()))
        if not (waits or publisher.closed or publisher.has_connections() or says_it_itself()):
            tell_of_unheard(publisher.resolved_name, publisher.type)

    kind.__init__ = __init__


def tell_of_unheard(name, kind):
    """Log who is missing, if the master knows nobody who subscribes to a topic of this type."""
    listened, types = dict(asked("getSystemState")[1]), dict(asked("getTopicTypes"))
    alike = [each for each in listened if kind == types.get(each) == TWIST
             and is_turtles(each) == is_turtles(name)]
    if name in listened:
        return
    if alike and is_turtles(name):
        tell_once(UNHEARD, name, f"rosservice call /spawn 2 2 0 {name.split('/')[1]}")
    elif alike:
        meant = difflib.get_close_matches(name, alike, 1, 0.0)[0]
        tell_once(OTHER_LISTENED, name, meant, name, meant)
    else:
        of_the_car = name.startswith("/racecar/") and name.endswith(OF_A_JOINT)
        tell_once(UNHEARD, name, TURTLESIM if is_turtles(name) else
                  OF_THE_CAR if of_the_car else course(name))


def is_turtles(topic):
    return topic.startswith("/turtle")
