"""The changes to rospy that our programs make, each with its reason."""

from collections.abc import Callable

import rospy.topics
from rospy import core, rostime
from rospy.impl.masterslave import ROSHandler
from rospy.impl.registration import RegManager
from rospy.impl.tcpros_service import ServiceImpl

from bullet_sim_ros.message_buffer import MessageBuffer
from bullet_sim_ros.prompt_connection import PromptConnection

REFUSED = "refused: this node obeys the course alone"


def send_promptly() -> None:
    """Make all publishers of this process, which need a queue, send at once (PromptConnection).

    Before the first is made. rospy passes each message to a thread, which costs more than all else
    of publishing.
    """
    rospy.topics.QueuedConnection = PromptConnection
    rospy.topics.BytesIO = MessageBuffer


def keep_every_publisher() -> None:
    """Make subscribers connect to all publishers, in whatever order they learn of them.

    The master answers a subscription with the publishers of that moment, and reports later ones by
    a call. rospy takes the list that it has read last for the newest: if it reads the answer after
    the call, it never connects to the call's publisher. So one wheel of a car stood still whose
    controllers had started at the same moment as the node that drives it.
    """
    RegManager.publisher_update = _add_update


def _add_update(manager: RegManager, topic: str, uris: list[str]) -> None:
    """Replaces rospy's: merges the waiting lists. Publishers that have ended refuse connections."""
    with manager.cond:
        waiting = [uri for name, known in manager.updates if name == topic for uri in known]
        manager.updates.append((topic, list(dict.fromkeys([*waiting, *uris]))))
        manager.cond.notify_all()


def set_time(now: rospy.Time) -> None:
    """Set the time of rospy.Time.now, which stamps log messages, in the node that makes /clock.

    That node does not subscribe to /clock; so none of its threads may sleep by this time.
    """
    rostime._rostime_current = now


def report_shutdown() -> None:
    """Make rospy.is_shutdown true, when rospy itself waits for a master that does not answer."""
    core._shutdown_flag = True


def ask_before_obeying(allows: Callable[[str, str, str], bool]) -> None:
    """Ask `allows(kind, name, uri)` before this process's node does what others tell it to; to be
    called before init_node.

    rospy obeys whoever finds its port, whatever the master knows. Kinds: "publisher" (to connect
    to topic `name` at the XML-RPC address `uri`), "service" (to answer a request), "parameter" (to
    take a new value), "shutdown". Only connections and calls are asked about, never a message.
    """
    connect, answer = ROSHandler._connect_topic, ServiceImpl._handle_request
    take, end = ROSHandler.paramUpdate, ROSHandler.shutdown

    def connect_topic(handler, topic, uri):
        return connect(handler, topic, uri) if allows("publisher", topic, uri) else (
            0, REFUSED, 0)

    def handle_request(service, transport, request):
        if allows("service", service.resolved_name, ""):
            answer(service, transport, request)
        else:
            service._write_service_error(transport, REFUSED)

    def param_update(handler, *call):
        name = str(call[1]) if len(call) > 1 else ""
        return take(handler, *call) if allows("parameter", name, "") else (0, REFUSED, 0)

    def shutdown(handler, *call):
        return end(handler, *call) if allows("shutdown", "", "") else (0, REFUSED, 0)

    ROSHandler._connect_topic, ServiceImpl._handle_request = connect_topic, handle_request
    ROSHandler.paramUpdate, ROSHandler.shutdown = param_update, shutdown
