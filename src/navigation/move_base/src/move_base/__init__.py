"""Navigation to goals, behind the names of upstream's move_base."""
