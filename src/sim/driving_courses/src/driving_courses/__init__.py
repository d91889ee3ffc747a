"""The driving courses as Gymnasium environments, on the simulator's core alone.

`import driving_courses` names them to Gymnasium. Without Gymnasium the rest is of use still: the
node that drives by a trained policy needs none.
"""

import importlib.util

ENVIRONMENTS = {"driving_courses/LineFollow-v0": "line_follow"}

if importlib.util.find_spec("gymnasium"):
    import gymnasium

    for name, course in ENVIRONMENTS.items():
        if name not in gymnasium.registry:
            gymnasium.register(name, "driving_courses.environment:CourseEnv",
                               kwargs={"course": course})
