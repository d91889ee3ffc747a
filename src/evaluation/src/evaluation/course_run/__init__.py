"""The course run: starts course and follower headless, observes, scores, reports, cleans up."""
