"""move_base without a map in narrow worlds, and with a person in its way."""
