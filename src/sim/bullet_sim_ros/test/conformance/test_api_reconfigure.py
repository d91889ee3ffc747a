"""dynamic_reconfigure of /gazebo."""

import pytest
import rospy
from dynamic_reconfigure.msg import Config, DoubleParameter, IntParameter
from geometry_msgs.msg import Vector3

GROUND_1000 = """<sdf version="1.6"><world name="default"><physics type="ode">
  <real_time_update_rate>1000</real_time_update_rate></physics></world></sdf>"""


def test_what_can_be_reconfigured_is_told(make_bench):
    # conforms: /gazebo reconfigure/parameter_descriptions
    # conforms: /gazebo reconfigure/parameter_updates, /gazebo reconfigure
    bench = make_bench(GROUND_1000)
    latched = [bench.graph.topics[f"/gazebo/{name}"] for name in
               ("parameter_descriptions", "parameter_updates")]
    assert all(topic.publishers[0].options["latch"] for topic in latched)
    description = latched[0].messages[0]
    named = {p.name: p.type for p in description.groups[0].parameters}
    assert len(named) == 15 and named["max_contacts"] == "int" and named["cfm"] == "double"
    assert named["auto_disable_bodies"] == "bool"
    highest = {p.name: p.value for p in (*description.max.doubles, *description.max.ints)}
    assert (highest["time_step"], highest["gravity_z"], highest["max_contacts"]) == (
        10.0, 100.0, 10_000_000)
    lowest = {p.name: p.value for p in description.min.doubles}
    assert (lowest["gravity_x"], lowest["sor_pgs_rms_error_tol"]) == (-100.0, -1.0)
    assert latched[1].messages
    # as the running world has them, not as a file says
    assert bench.graph.parameters["/gazebo/max_update_rate"] == 1000.0
    assert bench.graph.parameters["/gazebo/gravity_z"] == -9.8


VALUES = {
    "time_step": ("time_step", 0.002), "max_update_rate": ("max_update_rate", 500.0),
    "gravity_x": ("gravity.x", 1.0), "gravity_y": ("gravity.y", 2.0),
    "gravity_z": ("gravity.z", -3.0), "sor_pgs_w": ("ode_config.sor_pgs_w", 1.1),
    "cfm": ("ode_config.cfm", 0.5), "erp": ("ode_config.erp", 0.4),
    "contact_surface_layer": ("ode_config.contact_surface_layer", 0.01),
    "contact_max_correcting_vel": ("ode_config.contact_max_correcting_vel", 7.0),
    "sor_pgs_precon_iters": ("ode_config.sor_pgs_precon_iters", 3),
    "sor_pgs_iters": ("ode_config.sor_pgs_iters", 77),
    "max_contacts": ("ode_config.max_contacts", 12),
}


def reconfigure(bench, **values):
    config = Config()
    for name, value in values.items():
        kind, place = ((IntParameter, config.ints) if isinstance(value, int)
                       else (DoubleParameter, config.doubles))
        place.append(kind(name, value))
    return bench.call("/gazebo/set_parameters", config=config)


def physics(bench, path):
    found = bench.call("/gazebo/get_physics_properties")
    for part in path.split("."):
        found = getattr(found, part)
    return found


def test_each_number_can_be_reconfigured(make_bench):
    # conforms: /gazebo reconfigure/set_parameters, /gazebo reconfigure/time_step
    # conforms: /gazebo reconfigure/max_update_rate, /gazebo reconfigure/gravity_x
    # conforms: /gazebo reconfigure/gravity_y, /gazebo reconfigure/gravity_z
    # conforms: /gazebo reconfigure/sor_pgs_iters
    bench = make_bench(GROUND_1000)
    for name, (path, value) in VALUES.items():
        reconfigure(bench, **{name: value})
        assert physics(bench, path) == value
        assert bench.graph.parameters[f"/gazebo/{name}"] == value


def test_reconfiguring_one_number_leaves_the_others_as_they_are(make_bench):
    # conforms: /gazebo reconfigure/set_parameters
    bench = make_bench(GROUND_1000)
    bench.call("/gazebo/set_physics_properties", time_step=0.002, max_update_rate=250.0,
               gravity=Vector3(0, 0, -1.6))
    reconfigure(bench, gravity_x=1.0)
    assert physics(bench, "time_step") == 0.002 and physics(bench, "gravity.z") == -1.6
    assert physics(bench, "gravity.x") == 1.0


def test_a_step_that_is_not_possible_is_one_line(make_bench):
    # conforms: /gazebo reconfigure/time_step
    bench = make_bench(GROUND_1000)
    with pytest.raises(rospy.ServiceException, match="a time step of 0 s is not possible"):
        reconfigure(bench, time_step=0.0)
    assert physics(bench, "time_step") == 0.001
    reconfigure(bench, gravity_x=1.0)
    assert physics(bench, "gravity.x") == 1.0
