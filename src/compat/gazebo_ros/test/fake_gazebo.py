"""Gazebo's services as spawn_model sees them: each call is kept, the answers can be set."""

import queue

import rospy
from gazebo_msgs.msg import ModelStates
from gazebo_msgs.srv import (
    DeleteModel,
    DeleteModelResponse,
    SetModelConfiguration,
    SetModelConfigurationResponse,
    SpawnModel,
    SpawnModelResponse,
)
from std_srvs.srv import Empty, EmptyResponse

SERVICES = {
    "spawn_urdf_model": (SpawnModel, SpawnModelResponse),
    "spawn_sdf_model": (SpawnModel, SpawnModelResponse),
    "delete_model": (DeleteModel, DeleteModelResponse),
    "set_model_configuration": (SetModelConfiguration, SetModelConfigurationResponse),
    "unpause_physics": (Empty, EmptyResponse),
}


class FakeGazebo:
    """Offers the services below a namespace."""

    def __init__(self, namespace):
        self.calls = queue.Queue()  # (service, request)
        self.failing = set()  # services that answer success=False
        self.broken = set()  # services that raise
        self.states = rospy.Publisher(f"{namespace}/model_states", ModelStates, queue_size=1)
        for name, (kind, response) in SERVICES.items():
            rospy.Service(f"{namespace}/{name}", kind, self._handler(name, response))

    def reset(self):
        self.failing.clear()
        self.broken.clear()
        self.calls = queue.Queue()

    def names(self):
        """The services called since the last reset, in order."""
        return [name for name, _ in list(self.calls.queue)]

    def _handler(self, name, response):
        def handle(request):
            self.calls.put((name, request))
            if name in self.broken:
                raise rospy.ServiceException("broken on purpose")
            if name == "unpause_physics":
                return response()
            return response(success=name not in self.failing, status_message=f"{name} answered")

        return handle
