"""The main job: start course and follower without a screen, watch, score, report, clean up."""
