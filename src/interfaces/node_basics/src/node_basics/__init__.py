"""What nodes of all folders do in one way."""
