"""Lets a node's XML-RPC server end with the node.

rospy closes the server's socket and leaves its loop running: until the process is gone, half a
second later, that loop asks for the closed socket as fast as it can. Ten `spawn_model` that end
while ten robots start would take most of two cores (measured: 0.5 s of a core each).
"""

import errno

from rosgraph import xmlrpc


class EndingServer(xmlrpc.ThreadingXMLRPCServer):
    """Its loop ends when its socket has been closed."""

    def service_actions(self) -> None:
        """Called by the loop each time round; the error is the one that rosgraph expects."""
        super().service_actions()
        if self.fileno() < 0:
            raise OSError(errno.EBADF, "the socket has been closed")


def end_quietly() -> None:
    """For this process's node; before rospy.init_node."""
    xmlrpc.ThreadingXMLRPCServer = EndingServer
