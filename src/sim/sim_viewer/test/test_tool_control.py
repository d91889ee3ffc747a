"""What a page that may only look can ask of the tools."""

from sim_viewer import registry

LOOKING = {"bag_info", "parameter", "parameters", "plot_expand", "plot_fields", "rviz_change",
           "rviz_config", "rviz_drawn", "rviz_types", "service", "services"}
CHANGING = {"call_service", "delete_parameter", "pause", "play", "record", "reset", "rviz_feedback",
            "rviz_menu", "rviz_publish", "rviz_tool", "set_parameter", "step", "stop_play",
            "stop_record"}


def test_only_looking_needs_no_control():
    registry.load_all()
    tools = {name: operation for name, operation in registry._operations.items()
             if operation.function.__module__.startswith(("sim_viewer.rviz.", "sim_viewer.tools."))}
    assert {name for name, operation in tools.items() if not operation.control} == LOOKING
    assert {name for name, operation in tools.items() if operation.control} == CHANGING
