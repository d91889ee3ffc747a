"""move_base in narrow worlds that it does not know, and with a person in its way."""
