"""Whether several machines can talk to each other: what check_network looks at."""
