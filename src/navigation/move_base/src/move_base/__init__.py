"""Navigation to goals, with the interface of upstream's move_base."""
