"""The tracking lesson as course_run's parts know a course: launch file, robot, topics."""

from __future__ import annotations

from run_session.course import Course

PACKAGE, LAUNCH = "ai_robot_tracking", "start_tracking.launch"
PAGE, PID = TRACKERS = ("visual_tracker.py", "visual_tracker_pid.py")

COURSE = Course(
    launch=(PACKAGE, LAUNCH), follower_package=PACKAGE,
    followers="scripts/visual_tracker*.py", follower=PID, drives_by="cmd_vel",
    robot="my_robot", robot_argument="", track="", off_course=0.0, out="out/track",
    camera="/camera/rgb/image_raw", camera_info="/camera/rgb/camera_info", commands="/cmd_vel",
    odometry="/ground_truth", controllers="/", lockstep=("/cmd_vel",), sensors=(), film_band=0.0,
)  # fmt: skip
