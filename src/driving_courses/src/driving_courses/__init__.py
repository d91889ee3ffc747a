"""The driving courses as Gymnasium environments, on the simulator's core alone.

`import driving_courses` names them to Gymnasium. Without Gymnasium the rest is of use still: the
node that drives by a trained policy needs none.
"""

import importlib.util

ENVIRONMENTS = {  # name -> what CourseEnv is made with, unless gymnasium.make says otherwise
    "driving_courses/LineFollow-v0": {"course": "line_follow"},
    "driving_courses/Race-v0": {"course": "race", "action": "ackermann"},
    "driving_courses/Lane-v0": {"course": "lane"},
    "driving_courses/Track-v0": {"course": "track"},
}

if importlib.util.find_spec("gymnasium"):
    import gymnasium

    for name, options in ENVIRONMENTS.items():
        if name not in gymnasium.registry:
            gymnasium.register(name, "driving_courses.environment:CourseEnv", kwargs=options)
