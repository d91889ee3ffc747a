"""A controller's PID: gains from parameters or dynamic_reconfigure, and its state on a topic."""

from collections.abc import Callable
from dataclasses import asdict

from control_msgs.msg import PidState
from rospy import Duration

from bullet_sim.control.pid import Pid, PidGains
from bullet_sim_ros import convert
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.inputs import Input
from bullet_sim_ros.reconfigure_server import Owner, Value, offer_values

RANGES = {"p": (-1e5, 1e5, "Proportional gain"), "i": (-1e5, 1e5, "Integral gain"),
          "d": (-1e3, 1e3, "Derivative gain"), "i_clamp_max": (0.0, 1e5, "Greatest integral term"),
          "i_clamp_min": (-1e5, 0.0, "Least integral term"),
          "antiwindup": (False, True, "Clamp the integral of the error, not only its term")}


def offer_gains(owner: Owner, namespace: str, gains: PidGains,
                change: Callable[[PidGains], None]) -> None:
    """Offer dynamic_reconfigure; calls `change(gains)` at once, and in a ROS thread on changes."""
    values = {name: Value(now, *RANGES[name]) for name, now in asdict(gains).items()}
    offer_values(owner, namespace, values, lambda new: change(PidGains(**new)))


def open_pid(context: ControllerContext, group: str = "pid") -> Pid:
    """A PID with the gains of a group of parameters, which dynamic_reconfigure can change."""
    pid = Pid(PidGains.from_parameters(context.parameters, group))

    def change(gains: PidGains) -> None:
        def set_gains() -> None:
            pid.gains = gains
        context.mailbox.post(set_gains, Input(context.namespace, None))

    offer_gains(context, context.parameters.where(group), pid.gains, change)
    return pid


class PidTopic:
    """The topic `<group>/state`: the PID's terms in each update."""

    def __init__(self, context: ControllerContext, pid: Pid, group: str = "pid"):
        self._pid = pid
        self._publisher = context.advertise(f"{group}/state", PidState, queue_size=1)

    def publish(self, time: float, period: float) -> None:
        """Publish if there are subscribers; time and period in s."""
        if not self._publisher.get_num_connections():
            return
        pid, gains = self._pid, self._pid.gains
        msg = PidState(timestep=Duration.from_sec(period), error=pid.error,
                       error_dot=pid.error_rate, p_error=pid.error, i_error=pid.error_integral,
                       d_error=pid.error_rate, p_term=gains.p, i_term=gains.i, d_term=gains.d,
                       i_max=gains.i_clamp_max, i_min=gains.i_clamp_min, output=pid.output)
        convert.stamped(msg, time)
        self._publisher.publish(msg)
